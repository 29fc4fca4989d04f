// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include "recorded_run.h"

#include <random>

namespace retroforge
{
  /// A direction in X_0, the upper die's speed (relative) and offset, and the vertices of the dies.
  struct Direction
  {
    std::string                       name;
    NodalVectors<double>              X_dot;
    double                            speed_dot = 0., offset_dot = 0.;
    std::vector<NodalVectors<double>> vertices_dot; ///< of each die; empty: they stay
  };

  inline NodalVectors<double> random_vectors(const std::size_t n)
  {
    std::mt19937         generator(1);
    NodalVectors<double> list(n);
    for (Vec3 &x : list)
      for (unsigned int i = 0; i < 3; ++i)
        x[i] = generator() / 2147483648. - 1.;
    return list;
  }

  /// All vertices of all triangulated dies at random.
  inline Direction random_vertices(const RecordedRun &run)
  {
    Direction direction{"die vertices", NodalVectors<double>(run.scene.mesh.n_nodes()), 0., 0., {}};
    for (const Die &die : run.scene.dies)
      direction.vertices_dot.push_back(random_vectors(die.surface() ? die.surface()->vertices().size() : 0));
    return direction;
  }

  template <typename Number>
  Number number(const double value, const double dot);
  template <>
  inline double number(const double value, double)
  {
    return value;
  }
  template <>
  inline Dual number(const double value, const double dot)
  {
    Dual x(value);
    x.fastAccessDx(0) = dot;
    return x;
  }

  /// x + t x_dot; as dual numbers, with the derivative x_dot.
  template <typename Number>
  Vector3<Number> moved(const Vec3 &x, const Vec3 &x_dot, const double t)
  {
    Vector3<Number> y;
    for (unsigned int i = 0; i < 3; ++i)
      y[i] = number<Number>(x[i] + t * x_dot[i], x_dot[i]);
    return y;
  }

  template <typename Number>
  NodalVectors<Number> moved(const NodalVectors<double> &x, const NodalVectors<double> &x_dot, const double t)
  {
    NodalVectors<Number> y;
    for (std::size_t k = 0; k < x.size(); ++k)
      y.push_back(moved<Number>(x[k], x_dot[k], t));
    return y;
  }

  /// Process and positions at t along a direction; as dual numbers, with that direction.
  template <typename Number>
  std::pair<Process<Number>, NodalVectors<Number>>
  along(const RecordedRun &run, const Direction &direction, const double t)
  {
    const Process<double> &at      = run.process();
    Process<Number>        process = converted<Number>(at);
    for (unsigned int d = 0; d < at.dies.size(); ++d)
    {
      const double      upper = d == 1 ? 1. : 0.;
      DieState<Number> &state = process.dies[d];
      state.velocity =
        moved<Number>(at.dies[d].velocity, upper * direction.speed_dot * at.dies[d].velocity, t);
      state.displacement =
        moved<Number>(Vec3(), upper * direction.offset_dot * run.parameters.dies[d].facing, t);
      if (d < direction.vertices_dot.size() && !direction.vertices_dot[d].empty())
        state.vertices = moved<Number>(run.scene.dies[d].surface()->vertices(), direction.vertices_dot[d], t);
    }
    return {process, moved<Number>(run.scene.mesh.X, direction.X_dot, t)};
  }

  inline double slope(const RecordedRun &run, const AdjointResult &result, const Direction &direction)
  {
    double sum = 0.;
    for (std::size_t k = 0; k < direction.X_dot.size(); ++k)
      sum += result.X_0[k] * direction.X_dot[k];
    for (unsigned int d = 0; d < direction.vertices_dot.size(); ++d)
      for (std::size_t k = 0; k < direction.vertices_dot[d].size(); ++k)
        sum += result.process.dies[d].vertices[k] * direction.vertices_dot[d][k];
    const auto &die = result.process.dies[1];
    return sum + direction.speed_dot * (die.velocity * run.process().dies[1].velocity) +
           direction.offset_dot * (die.displacement * run.parameters.dies[1].facing);
  }

  inline double tangent_slope(RecordedRun &run, const Direction &direction)
  {
    const auto [process, X] = along<Dual>(run, direction, 0.);
    return run.derivative(process, X);
  }

  /// Central, with recorded decisions.
  inline double difference(const RecordedRun &run, const Direction &direction, const double h)
  {
    const auto energy = [&](const double t) {
      const auto [process, X] = along<double>(run, direction, t);
      return run.replayed_energy(process, X);
    };
    return (energy(h) - energy(-h)) / (2. * h);
  }

  inline double relative_error(const double a, const double b)
  {
    return std::abs(a / b - 1.);
  }

  inline const char *yes(const bool condition)
  {
    return condition ? "yes" : "NO";
  }
} // namespace retroforge
