// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
// Proves: a fit returns the polynomial its points lie on, far from zero too; deviations that are orthogonal
// to all cubics come out as noise and roughness of their own size; points without values are left out. By
// hand: over the nine points t = -1, -3/4, ..., 1 the fourth differences (1, -4, 6, -4, 1) of points next to
// one another are orthogonal to cubics. With an amplitude of 1e-3 at five of nine points, the squares sum to
// 70e-6: noise rms = sqrt(70/9) 1e-3 = 2.789e-3 and noise max = 6e-3 over the mean of the values.
#include <retroforge/case/scan_parameters.h>
#include <retroforge/scan/line_statistics.h>

#include <cmath>
#include <cstdio>

using namespace retroforge;

namespace
{
  const double x_0 = 1000., half = 10.;

  double scaled(const double x)
  {
    return (x - x_0) / half;
  }
  double cubic(const double x)
  {
    const double t = scaled(x);
    return 4. + 2. * t - 3. * t * t + t * t * t;
  }
  double cubic_slope(const double x)
  {
    const double t = scaled(x);
    return (2. - 6. * t + 3. * t * t) / half;
  }

  ScannedLine line(const unsigned int n)
  {
    ScannedLine line;
    for (unsigned int i = 0; i < n; ++i)
    {
      line.x.push_back(x_0 + half * (2. * i / (n - 1.) - 1.));
      line.y.push_back(cubic(line.x[i]));
      line.slopes.push_back(cubic_slope(line.x[i]));
    }
    return line;
  }

  double above_rounding(const double x)
  {
    return std::abs(x) < 1e-12 ? 0. : x;
  }

  void print(const char *title, const ScannedLine &line, const unsigned int degree = 3)
  {
    const LineStatistics s(line, line.fit(degree));
    std::printf(
      "%s: values %u slopes %u\n  mean %.6f noise %.4e %.4e\n  slope %.6f of the fit %.6f bias %.4e "
      "roughness %.4e %.4e\n",
      title,
      s.n_values,
      s.n_slopes,
      s.mean_value,
      above_rounding(s.noise_rms),
      above_rounding(s.noise_max),
      s.mean_slope,
      s.mean_fit_slope,
      above_rounding(s.bias),
      above_rounding(s.roughness_rms),
      above_rounding(s.roughness_max));
  }
} // namespace

int main()
{
  const ScannedLine smooth = line(9);
  double            value = 0., slope = 0.;
  for (const unsigned int degree : {3u, 6u})
  {
    const PolynomialFit fit = *smooth.fit(degree);
    for (const double x : {990., 997.3, 1000., 1012.}) // the last one outside
    {
      value = std::max(value, std::abs(fit.value(x) / cubic(x) - 1.));
      slope = std::max(slope, std::abs(fit.slope(x) - cubic_slope(x)));
    }
  }
  std::printf("fit of a cubic: values below 1e-12 %d, slopes below 1e-12 %d\n", value < 1e-12, slope < 1e-12);

  ScannedLine  noisy      = smooth;
  const double fourth[]   = {1., -4., 6., -4., 1.};
  double       mean_slope = 0.;
  for (unsigned int i = 0; i < 5; ++i)
    noisy.y[2 + i] += 1e-3 * fourth[i];
  for (const double s : smooth.slopes)
    mean_slope += s / 9.;
  print("noise in the values", noisy);
  std::printf("  by hand: noise %.4e %.4e\n", std::sqrt(70. / 9.) * 1e-3 / 2.75, 6e-3 / 2.75);

  ScannedLine rough = smooth;
  for (unsigned int i = 0; i < 9; ++i)
    rough.slopes[i] *= 1.01;
  print("slopes too large by 1 %", rough);
  rough = smooth;
  for (unsigned int i = 0; i < 8; ++i)
    rough.slopes[i] += 0.1 * mean_slope * (i % 2 == 0 ? 1. : -1.);
  print("slopes off by 10 % of the mean, no bias", rough);
  std::printf("  by hand: roughness %.4e %.4e\n", 0.1 * std::sqrt(8. / 9.), 0.1);

  ScannedLine gaps = smooth;
  gaps.y[1] = gaps.y[4] = gaps.slopes[7] = NAN;
  print("two points and one slope missing", gaps);
  for (unsigned int i = 0; i < 5; ++i)
    gaps.y[i] = NAN;
  print("too few points", gaps);
  for (double &s : noisy.slopes)
    s = NAN;
  print("no slopes", noisy);

  ScannedLine flat = smooth;
  for (unsigned int i = 0; i < 9; ++i)
  {
    flat.y[i]      = 1000. * (1. + 1e-16 * (i % 3));
    flat.slopes[i] = 1e-9 * (i % 2);
  }
  print("a parameter without effect", flat);

  ScanParameters scan;
  scan.points = 5;
  scan.range  = 0.1;
  for (const double x : scan.values(-20., 3.))
    std::printf("%g ", x);
  for (const double x : scan.values(0., 3.))
    std::printf("%g ", x);
  std::printf("\n");
  scan.points = 17;
  std::printf("the middle is the nominal value: %d\n", scan.values(0.1 + 0.2, 1.)[8] == 0.1 + 0.2);
}
