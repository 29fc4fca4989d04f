// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The learned Hessian: one at first; what it has learned explains the last step and is symmetric; of a quadratic
// function it becomes the Hessian, one that bends downwards too; what is missing across the step changes it by no more
// than it must; steps that say nothing beyond the noise change nothing.

#include <retroforge/optimization/secant_hessian.h>
#include <retroforge/optimization/small_vectors.h>

#include <iostream>
#include <random>

using namespace retroforge;

namespace
{
  using Vector = std::vector<double>;

  const char *answer(const bool yes)
  {
    return yes ? "yes" : "NO";
  }

  std::vector<Vector> columns(const SecantHessian &hessian, const unsigned int n)
  {
    std::vector<Vector> columns;
    for (unsigned int j = 0; j < n; ++j)
    {
      Vector unit(n, 0.);
      unit[j] = 1.;
      columns.push_back(hessian.times(unit));
    }
    return columns;
  }

  double distance(const std::vector<Vector> &a, const std::vector<Vector> &b)
  {
    double sum = 0.;
    for (std::size_t j = 0; j < a.size(); ++j)
      sum += std::pow(length(difference(a[j], b[j])), 2);
    return std::sqrt(sum);
  }

  Vector random_vector(std::mt19937 &generator)
  {
    Vector v(3);
    for (double &entry : v)
      entry = 2. * (generator() / 4294967296.) - 1.;
    return v;
  }
} // namespace

int main()
{
  // Its eigenvalues are of both signs.
  const std::vector<Vector> exact = {{2., 0.5, -1.}, {0.5, -1., 0.3}, {-1., 0.3, 0.7}};
  const auto                bends = [&](const Vector &step) {
    Vector change(3, 0.);
    for (unsigned int j = 0; j < 3; ++j)
      add(step[j], exact[j], change);
    return change;
  };
  std::mt19937  generator(1);
  SecantHessian hessian;
  std::cout << "one at first: " << answer(hessian.times({1., 2., 3.}) == Vector{1., 2., 3.}) << "\n";

  bool explains = true, is_symmetric = true, is_bounded = true;
  for (unsigned int k = 0; k < 60; ++k)
  {
    const Vector step = random_vector(generator);
    hessian.learn(step, bends(step), 0.);
    const std::vector<Vector> now = columns(hessian, 3);
    explains                      = explains && length(difference(hessian.times(step), bends(step))) < 1e-12;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        is_symmetric = is_symmetric && std::abs(now[i][j] - now[j][i]) < 1e-13;
    // Nearly across the step, what is missing is added as the least matrix that can do it.
    Vector across = random_vector(generator);
    add(-dot(across, step) / dot(step, step), step, across);
    add(0.1 * length(across) / length(step), step, across);
    Vector        other_change = hessian.times(step);
    SecantHessian other        = hessian;
    add(1., across, other_change);
    other.learn(step, other_change, 0.);
    explains           = explains && length(difference(other.times(step), other_change)) < 1e-12;
    const double reach = distance(columns(other, 3), columns(hessian, 3));
    is_bounded         = is_bounded && reach <= 1.5 * length(across) / length(step);
  }
  std::cout << "explains each step: " << answer(explains) << ", symmetric: " << answer(is_symmetric)
            << ", by no more than it must where that is across the step: " << answer(is_bounded)
            << ", a quadratic function's Hessian to 1e-3: "
            << answer(distance(columns(hessian, 3), exact) < 1e-3) << "\n";

  // Of twelve variables, stiffer and stiffer: steps are explained, and nothing bends downwards.
  SecantHessian large;
  bool          explains_too = true, is_positive = true;
  for (unsigned int k = 0; k < 12; ++k)
  {
    Vector step(12, 0.), change(12);
    for (unsigned int j = 0; j < 12; ++j)
    {
      step[j]   = 2. * (generator() / 4294967296.) - 1.;
      change[j] = (1. + j) * step[j];
    }
    large.learn(step, change, 0.);
    explains_too = explains_too && length(difference(large.times(step), change)) < 1e-11;
    for (unsigned int j = 0; j < 12; ++j)
      is_positive = is_positive && columns(large, 12)[j][j] > 0.;
  }
  std::cout << "of many variables: explains each step: " << answer(explains_too)
            << ", positive: " << answer(is_positive) << "\n";

  const std::vector<Vector> before = columns(hessian, 3);
  hessian.learn({1e-3, 0., 0.}, {1., 5., 0.}, 0.01);
  std::cout << "within the noise nothing is learned: " << answer(columns(hessian, 3) == before) << "\n";
}
