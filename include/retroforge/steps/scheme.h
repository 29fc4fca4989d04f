// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/types.h>

#include <numeric>
#include <string>

namespace retroforge
{
  /// An explicit Runge-Kutta scheme by its Butcher table. An increment of time dt goes from X to
  ///   X' = X + dt sum_s b_s w_s,   w_s the motion of the nodes in equilibrium at  Y_s = X + dt sum_(r<s)
  ///   a_sr w_r,
  /// and what is integrated over it (energy, strain, objectives) has its integrand at the Y_s, weighted by
  /// b_s. Dies and contact are those at X.
  struct Scheme
  {
    std::string                      name;
    std::string                      description; ///< what follows its name in the list of schemes
    std::vector<std::vector<double>> a;           ///< row s has s entries
    std::vector<double>              b;           ///< of sum 1

    unsigned int n_stages() const { return b.size(); }

    /// Part of the increment's time at which stage s is.
    double node(const unsigned int s) const { return std::accumulate(a[s].begin(), a[s].end(), 0.); }

    /// The schemes there are; the first one is the default.
    static const std::vector<Scheme> &all();
    /// @throws Error
    static const Scheme &by_name(const std::string &name);
  };

  /// X + dt sum_s weights[s] w_s, w_s the motion of the nodes, the sum over as many stages as there are
  /// weights.
  template <typename Number, typename Stage>
  NodalVectors<Number> advanced(const NodalVectors<Number> &X,
                                const Number               &dt,
                                const std::vector<double>  &weights,
                                const std::vector<Stage>   &stages)
  {
    NodalVectors<Number> moved = X;
    for (std::size_t s = 0; s < weights.size(); ++s)
      if (weights[s] != 0.)
      {
        const Number time = weights[s] * dt;
        AssertIndexRange(s, stages.size());
        AssertDimension(stages[s].motion().size(), X.size());
        for (std::size_t k = 0; k < X.size(); ++k)
          moved[k] += stages[s].motion()[k] * time;
      }
    return moved;
  }
} // namespace retroforge
