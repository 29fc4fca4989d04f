// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/verification/check.h>

namespace retroforge
{
  /// Prints what a check is about to do.
  /// @param n_directions  to be checked, by n_runs forgings each
  /// @param n_done        directions that an earlier check has done
  /// @param seconds       of one forging; 0 when unknown
  void print_check_begin(unsigned int n_directions, unsigned int n_done, unsigned int n_runs, double seconds);

  /// Says which slope the adjoint is, and which one differences that decide anew have, where derivatives follow the trend
  /// across remeshings (Adjoint/remeshings).
  void print_follows_trend();

  /// Prints the verdict on the direction checked last, and the time left as those so far took it.
  /// @param rows    of all objectives along the directions so far
  /// @param before  of the directions done, those that an earlier check has done
  void print_check_progress(const std::vector<CheckRow> &rows,
                            unsigned int                 before,
                            unsigned int                 done,
                            unsigned int                 all,
                            double                       seconds);
} // namespace retroforge
