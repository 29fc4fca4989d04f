// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
// Proves, on synthetic paces over a stroke of 10 mm: before the first increment nothing is known; at an even
// pace the time left is that of the rest, whatever the increments' lengths; when the metal becomes slower,
// from 1 to 9 s/mm at 5 mm, the estimate follows within a tenth of the stroke, 9 - 8 exp(-(s - 5)) (1 -
// exp(-5)) / (1 - exp(-s)) s/mm, where the mean of all would lag to the end; an increment that is cut into
// eight parts, each as long as a whole one, does not count for the rest of the run.
#include <retroforge/output/time_left.h>

#include <cmath>
#include <cstdio>

using namespace retroforge;

constexpr double stroke = 10.;

/// Solves increments of `step` from `done` to `end` at so many seconds per mm.
void solve(TimeLeft &left, double &done, const double end, const double step, const double pace)
{
  while (done < end - 1e-9)
  {
    left.add(step, pace * step);
    done += step;
  }
}

int main()
{
  TimeLeft even(stroke);
  double   done = 0.;
  std::printf("before: %s\n", std::isnan(even.seconds(0.)) ? "unknown" : "known");
  solve(even, done, 2., 0.5, 3.);
  solve(even, done, 4., 0.125, 3.);
  std::printf("even pace, at %g mm: %.6f s, by hand 18\n", done, even.seconds(done));

  TimeLeft slower(stroke);
  done = 0.;
  solve(slower, done, 5., 0.25, 1.);
  std::printf("fast half, at %g mm: %.6f s, by hand 5\n", done, slower.seconds(done));
  for (const double end : {6., 7., 9.5})
  {
    solve(slower, done, end, 0.25, 9.);
    const double fading = std::exp(-(end - 5.)) * (1. - std::exp(-5.)) / (1. - std::exp(-end));
    std::printf("slow half, at %g mm: %.6f s, by hand %.6f, to the end %.1f\n",
                done,
                slower.seconds(done),
                (9. - 8. * fading) * (stroke - end),
                9. * (stroke - end));
  }

  // Whole increments of 0.5 mm take 1 s, 2 s/mm; one is cut to 8 parts of 1 s each, 16 s/mm.
  TimeLeft cut(stroke);
  done = 0.;
  solve(cut, done, 4., 0.5, 2.);
  const double before = cut.seconds(done);
  solve(cut, done, 4.5, 0.0625, 16.);
  const double after = cut.seconds(done);
  std::printf("a cut increment: %.1f s before, %.1f after it", before, after);
  solve(cut, done, 6.5, 0.5, 2.);
  std::printf(", %.1f at %g mm; to the end %.1f\n", cut.seconds(done), done, 2. * (stroke - done));
  std::printf("at the end: %.1f s\n", cut.seconds(stroke));
}
