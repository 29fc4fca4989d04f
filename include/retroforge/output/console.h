// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/adjoint/objective_sensitivity.h>
#include <retroforge/design/design.h>
#include <retroforge/mesh/whole_part.h>
#include <retroforge/output/history.h>
#include <retroforge/output/summary.h>

/// @file
/// What a user reads while a run goes on.
namespace retroforge
{
  /// A warning, or nothing: ranks that wait for each other keep their cores busy, and with other programs
  /// there all of them wait.
  /// @param load   programs that want to run without this one
  std::string note_on_load(unsigned int n_ranks, double load, unsigned int n_cores);

  /// Prints which part the numbers belong to, where that is not the whole.
  void print_part(const WholePart &whole);
  /// Prints the part, and the head of the table of increments.
  void print_head(const WholePart &whole);

  /// @param seconds_left  until the forging is done; NaN when unknown
  void print_increment(const HistoryRow &row, double seconds_left);

  /// The parameters by what one per cent of each does: what a forger would turn first.
  void
  print_gradient(const ObjectiveSensitivity &objective, const Design &design, const std::vector<double> &mu);

  /// The objectives, and the warnings.
  void print_results(const Summary &summary, const std::string &directory);
} // namespace retroforge
