// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Derivatives from the cubic that fits values around a point, in 1, 2 and 3 dimensions, 200 sets of points
// each, some of them flat (a tenth thick).
// - Linear fields to 1e-12, with as few points as there are dimensions.
// - Quadratic fields, of terms up to 1, to 5e-3 and cubic ones to 0.2, with 1.5 times as many points as
//   unknowns: what is left is the damping. (The derivative of a line through the points is off by 1 and
//   more.)
// - On a line with values at -1 and 2 the three-point formula,  g = -2/3 (q_- - q_0) + 1/6 (q_+ - q_0),  but
//   for 2 %: terms of third order are damped a hundred times as much as those of second.
// - Points on a plane (line) do not determine a gradient in space (on the plane): nothing is returned.

#include <retroforge/transfer/gradient_fit.h>

#include <algorithm>

#include "../element/element_test_tools.h"
#include "../mesh/mesh_test_tools.h"

using namespace retroforge;

std::vector<Vec3>
some_points(const unsigned int m, const unsigned int n, const double thickness, Random &random)
{
  std::vector<Vec3> points;
  while (points.size() < m)
  {
    Vec3 d = random.vector();
    for (unsigned int i = n; i < 3; ++i)
      d[i] = 0.;
    d[n - 1] *= thickness;
    if (d.norm() > 0.3 * (n == 1 ? thickness : 1.))
      points.push_back(d);
  }
  return points;
}

/// Derivative along `direction` of field(d) at 0, where field(0) = 0.
template <typename Field>
double
derivative(const std::vector<Vec3> &points, const unsigned int n, const Vec3 &direction, const Field &field)
{
  const auto coefficients = fitted_derivative(points, n, direction);
  if (!coefficients)
    return 1e300;
  double sum = 0.;
  for (std::size_t b = 0; b < points.size(); ++b)
    sum += (*coefficients)[b] * field(points[b]);
  return sum;
}

void check(const unsigned int n)
{
  Random             random;
  const unsigned int n_unknowns = n + n * (n + 1) / 2 + n * (n + 1) * (n + 2) / 6;
  double             linear = 0., quadratic = 0., cubic = 0.;
  for (unsigned int i = 0; i < 200; ++i)
  {
    const Vec3   g = random.vector(), direction = random.vector();
    const double thickness = i % 4 == 3 ? 0.1 : 1.;
    const auto   line      = [&](const Vec3 &d) { return g * d; };
    double       exact     = 0.;
    for (unsigned int k = 0; k < n; ++k)
      exact += g[k] * direction[k];
    for (const unsigned int m : {n, n_unknowns, 3 * n_unknowns / 2})
    {
      const auto points = some_points(m, n, thickness, random);
      linear            = std::max(linear, std::abs(derivative(points, n, direction, line) - exact));
    }
    const Vec3 h = random.vector(), k = random.vector(), l = random.vector();
    const auto second = [&](const Vec3 &d) { return g * d + (h * d) * (k * d); };
    const auto third  = [&](const Vec3 &d) { return g * d + (h * d) * (k * d) * (l * d); };
    const auto points = some_points(3 * n_unknowns / 2, n, 1., random);
    quadratic         = std::max(quadratic, std::abs(derivative(points, n, direction, second) - exact));
    cubic             = std::max(cubic, std::abs(derivative(points, n, direction, third) - exact));
  }
  std::cout << n << " dimensions: linear to 1e-12: " << yes(linear < 1e-12)
            << ", quadratic to 5e-3: " << yes(quadratic < 5e-3) << ", cubic to 0.2: " << yes(cubic < 0.2)
            << "\n";
}

int main()
{
  for (unsigned int n = 1; n <= 3; ++n)
    check(n);
  const auto by_hand = fitted_derivative({Vec3({-1, 0, 0}), Vec3({2, 0, 0})}, 1, Vec3({1, 0, 0}));
  std::cout << "three points: "
            << yes(std::abs((*by_hand)[0] + 2. / 3.) < 2e-2 && std::abs((*by_hand)[1] - 1. / 6.) < 2e-2)
            << "\n";
  Random random;
  for (const unsigned int n : {2, 3})
    std::cout << "flat in " << n << " dimensions: "
              << (fitted_derivative(some_points(20, n, 0., random), n, Vec3({1, 1, 1})) ? "SOMETHING"
                                                                                        : "nothing")
              << "\n";
  std::cout << "no points: " << (fitted_derivative({}, 3, Vec3({1, 1, 1})) ? "SOMETHING" : "nothing") << "\n";
}
