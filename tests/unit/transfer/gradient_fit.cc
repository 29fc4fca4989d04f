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
// - Points on a plane (line) do not determine a gradient in space (on the plane): there are no coefficients.
// - Coefficients are the same on other axes, to 1e-8.
// - <A x_dot, y> = <x_dot, A^T y> of the coefficients in points and direction, A from dual numbers, with few and with
//   many points, to 1e-8: the matrix of few is hard to solve with.

#include <retroforge/core/dual.h>
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
  const GradientFit<double> fit(points, n);
  if (!fit.is_determined())
    return 1e300;
  const auto coefficients = fit.coefficients(direction);
  double     sum          = 0.;
  for (std::size_t b = 0; b < points.size(); ++b)
    sum += coefficients[b] * field(points[b]);
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

/// |<A x_dot, y> - <x_dot, A^T y>| of the coefficients, relative to the sizes of the three parts that make it up.
double defect_of_reverse(const unsigned int n, const unsigned int m, Random &random)
{
  const auto          points    = some_points(m, n, 1., random);
  const Vec3          direction = random.vector(), direction_dot = random.vector();
  std::vector<Vec3>   points_dot, points_bar(m);
  std::vector<double> c_bar;
  NodalVectors<Dual>  dual_points(m);
  Vector3<Dual>       dual_direction;
  const auto          dual = [](const Vec3 &x, const Vec3 &x_dot) {
    Vector3<Dual> both;
    for (unsigned int i = 0; i < 3; ++i)
    {
      both[i]                 = x[i];
      both[i].fastAccessDx(0) = x_dot[i];
    }
    return both;
  };
  for (std::size_t b = 0; b < m; ++b)
  {
    points_dot.push_back(random.vector());
    c_bar.push_back(random.vector()[0]);
    dual_points[b] = dual(points[b], points_dot[b]);
  }
  Vec3 direction_bar;
  GradientFit<double>(points, n).reverse(direction, c_bar, points_bar, direction_bar);
  const auto c       = GradientFit<Dual>(dual_points, n).coefficients(dual(direction, direction_dot));
  double     forward = 0., reverse = 0., size = 0.;
  for (std::size_t b = 0; b < m; ++b)
  {
    forward += c[b].dx(0) * c_bar[b];
    size += std::abs(c[b].dx(0) * c_bar[b]);
    for (unsigned int i = 0; i < n; ++i)
      reverse += points_bar[b][i] * points_dot[b][i];
  }
  for (unsigned int i = 0; i < n; ++i)
    reverse += direction_bar[i] * direction_dot[i];
  return std::abs(forward - reverse) / size;
}

/// How far the coefficients change when points and direction are turned about the third axis, or an axis across it in space.
double dependence_on_axes(const unsigned int n, const unsigned int m, Random &random)
{
  auto       points    = some_points(m, n, 1., random);
  Vec3       direction = random.vector();
  const auto before    = GradientFit<double>(points, n).coefficients(direction);
  const auto turn      = [](Vec3 &x, const unsigned int i, const unsigned int j) {
    const double a = x[i], b = x[j];
    x[i] = 0.6 * a - 0.8 * b;
    x[j] = 0.8 * a + 0.6 * b;
  };
  points.push_back(direction);
  for (Vec3 &x : points)
  {
    turn(x, 0, 1);
    if (n == 3)
      turn(x, 1, 2);
  }
  direction = points.back();
  points.pop_back();
  const auto after   = GradientFit<double>(points, n).coefficients(direction);
  double     largest = 0., difference = 0.;
  for (std::size_t b = 0; b < m; ++b)
  {
    largest    = std::max(largest, std::abs(before[b]));
    difference = std::max(difference, std::abs(before[b] - after[b]));
  }
  return difference / largest;
}

void check_reverse(const unsigned int n)
{
  Random             random;
  const unsigned int n_unknowns = n + n * (n + 1) / 2 + n * (n + 1) * (n + 2) / 6;
  double             worst      = 0.;
  for (unsigned int i = 0; i < 50; ++i)
    for (const unsigned int m : {n + 1, n_unknowns, 2 * n_unknowns})
      worst = std::max(worst, defect_of_reverse(n, m, random));
  double turned = 0.;
  for (unsigned int i = 0; n > 1 && i < 50; ++i)
    turned = std::max(turned, dependence_on_axes(n, n_unknowns, random));
  std::cout << n << " dimensions: dot product to 1e-8: " << yes(worst < 1e-8)
            << ", the same on other axes to 1e-8: " << yes(turned < 1e-8) << "\n";
}

int main()
{
  for (unsigned int n = 1; n <= 3; ++n)
    check(n);
  const auto by_hand =
    GradientFit<double>({Vec3({-1, 0, 0}), Vec3({2, 0, 0})}, 1).coefficients(Vec3({1, 0, 0}));
  std::cout << "three points: "
            << yes(std::abs(by_hand[0] + 2. / 3.) < 2e-2 && std::abs(by_hand[1] - 1. / 6.) < 2e-2) << "\n";
  Random random;
  for (const unsigned int n : {2, 3})
    std::cout << "flat in " << n << " dimensions: "
              << (GradientFit<double>(some_points(20, n, 0., random), n).is_determined() ? "SOMETHING"
                                                                                         : "nothing")
              << "\n";
  std::cout << "no points: " << (GradientFit<double>({}, 3).is_determined() ? "SOMETHING" : "nothing")
            << "\n";
  for (unsigned int n = 1; n <= 3; ++n)
    check_reverse(n);
}
