// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/case/case.h>

namespace retroforge
{
  /// Prints what runs: version, size, and the notes on it.
  void print_begin(const Case &forging_case);

  /// Prints how much metal the chords of round sides lack, where that is much.
  /// @param shape  volume of the billet that the mesh stands for; NaN when unknown [mm^3]
  void print_chords(const Case &forging_case, double shape);

  /// Prints where a run goes on from, and with what.
  /// @param is_left  whether some of the stroke is
  void print_resumed(unsigned int n_increments, bool is_left, const std::vector<ChangedSetting> &changes);

  /// Returns what a user is told who stops the run.
  std::string resume_hint(const Case &forging_case);

  /// Returns what can be done when the run failed after some increments.
  /// @param stroke   up to which it came [mm]
  /// @param remakes  whether meshes are remade
  std::string resume_hint_after_failure(const Case &forging_case, double stroke, bool remakes);
} // namespace retroforge
