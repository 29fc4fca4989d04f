// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <string>
#include <vector>

namespace retroforge
{
  /// Runs the program by its command line, once MPI runs. Nothing is thrown: problems are told on the
  /// error stream, once, also where several ranks meet them.
  /// @param environment  that of the program before MPI added to it; runs that it starts get it
  /// @return the exit status: 0; 1 for an error, for a check that failed, or a scan all of whose points
  /// failed; 2 for an optimisation without a design to use
  int run_program(int argc, char *argv[], const std::vector<std::string> &environment);
} // namespace retroforge
