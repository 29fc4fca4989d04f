// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/optimization/scenarios.h>

/// @file
/// What an optimisation that goes on must have in common with the one it goes on from.
namespace retroforge
{
  /// Returns what gives the same bits for the same design: program, number of ranks, parameters of all
  /// scenarios, and fingerprints of what these only name.
  Journal::Header journal_header(const Scenarios &scenarios);

  /// Reads the journal in the folder of the main case's results.
  /// @throws Error  where there is none, or one of another case or program
  Journal resumed_journal(const Scenarios &scenarios);

  /// Returns a journal of the forgings on finer meshes, with those of `file` where the finer case is still
  /// the same.
  /// @param resumes  whether the optimisation goes on from an earlier one
  Journal confirmation_journal(const Scenarios &fine, const std::string &file, bool resumes);
} // namespace retroforge
