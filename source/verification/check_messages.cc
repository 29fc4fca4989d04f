// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/verification/check_messages.h>

#include <cmath>
#include <cstdio>

namespace retroforge
{
  void print_check_begin(const unsigned int n_directions,
                         const unsigned int n_done,
                         const unsigned int n_runs,
                         const double       seconds)
  {
    const unsigned int n_left = n_directions - n_done;
    std::printf("\n  check of %u directions by %u forgings and a tangent each: ", n_directions, n_runs);
    if (n_done > 0)
      std::printf("%u done before, ", n_done);
    std::printf("%u forgings", n_left * n_runs);
    if (seconds > 0.) // a tangent solves a system per stage for each of its directions, and reassembles
      std::printf(", about %.0f s", std::ceil(n_left * (n_runs + 2) * seconds));
    std::printf("\n");
    std::fflush(stdout);
  }

  void print_follows_trend()
  {
    std::printf("  remeshings follow the design (Adjoint/remeshings): the adjoint is that of the trend, and "
                "differences that "
                "decide anew\n  have the slope between two jumps instead; `hold` checks that\n");
  }

  void print_check_progress(const std::vector<CheckRow> &rows,
                            const unsigned int           before,
                            const unsigned int           done,
                            const unsigned int           all,
                            const double                 seconds)
  {
    // Rows stand by objective, and within it by direction.
    unsigned int failed = 0;
    for (std::size_t row = done - 1; row < rows.size(); row += done)
      failed += !rows[row].passed;
    std::printf("  %u/%u %s: %s, %.0f s, about %.0f s left\n",
                done,
                all,
                rows[done - 1].parameter.c_str(),
                failed == 0 ? "passed" : (std::to_string(failed) + " FAILED").c_str(),
                seconds,
                std::ceil(seconds / (done - before) * (all - done)));
    std::fflush(stdout);
  }
} // namespace retroforge
