// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/case/case.h>

namespace retroforge
{
  /// Prints, before a mesh of millions of tetrahedra is made, which takes minutes, how many there will be.
  void print_meshing(const Parameters &parameters);

  /// Returns what a user may not expect of a case, a sentence each.
  std::vector<std::string> notes_on(const Case &forging_case);

  /// Prints notes as a user reads them.
  void print_notes(const std::vector<std::string> &notes);

  /// Prints what is doubtful about a scene, or out of all proportion, a sentence each.
  void print_warnings(const std::vector<std::string> &warnings);
} // namespace retroforge
