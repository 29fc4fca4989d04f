// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/material/heat_law.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace retroforge
{
  /// Metal of a depth and a die of infinite depth in one dimension, by finite differences on a grid that grows from 2 um.
  class FineLayers
  {
  public:
    /// @param depth  of the metal, insulated at its end [mm]
    FineLayers(const HeatLaw<double> &law,
               const double           T_metal,
               const double           T_die,
               const double           depth = 400.)
        : k_(law.conductivity)
        , metal_(law.capacity)
        , die_(law.die_effusivity * law.die_effusivity / law.conductivity)
        , part_(law.friction_part)
        , x_(growing(400.))
        , n_(x_.size())
        , T_(n_, T_die)
    {
      std::reverse(x_.begin(), x_.end()); // the die's surface last
      for (const double x : growing(depth))
      {
        x_.push_back(x);
        T_.push_back(T_metal);
      }
    }

    /// A die that has touched nothing comes in place of the other.
    void change_die(const double T) { std::fill_n(T_.begin(), n_, T); }

    /// @param h         of the film between them; 0: apart
    /// @param warms_by  the metal, evenly over the time [K]
    /// @param friction  its heat on either side of the film, as the law shares it out [mW/mm²]
    /// @return heat that passes [mJ/mm²]
    double pass(const double h, const double time, const double warms_by = 0., const double friction = 0.)
    {
      constexpr unsigned int steps = 400;
      double                 heat  = 0.;
      for (unsigned int s = 0; s < steps; ++s)
      {
        const double from = std::pow(double(s) / steps, 3), to = std::pow((s + 1.) / steps, 3);
        step(h, time * (to - from), warms_by * (to - from), friction);
        const double first = 0.5 * (x_[n_ - 1] + x_[n_]) / k_; // to the middles of the cells at the film
        if (h > 0.)
          heat += time * (to - from) * (T_[n_] - T_[n_ - 1]) / (first + 1. / h);
      }
      into_metal_ = part_ * friction;
      into_die_   = (1. - part_) * friction;
      flux_       = h > 0. ? (T_[n_] - T_[n_ - 1]) / (0.5 * (x_[n_ - 1] + x_[n_]) / k_ + 1. / h) : 0.;
      return heat;
    }

    double metals_surface() const { return T_[n_] - (flux_ - into_metal_) * 0.5 * x_[n_] / k_; }
    double dies_surface() const { return T_[n_ - 1] + (flux_ + into_die_) * 0.5 * x_[n_ - 1] / k_; }

  private:
    static std::vector<double> growing(const double depth)
    {
      std::vector<double> x;
      double              sum = 0.;
      for (double dx = 0.002; sum < depth; dx *= 1.02)
      {
        x.push_back(std::min(dx, depth - sum));
        sum += x.back();
      }
      return x;
    }

    void step(const double h, const double dt, const double warms_by, const double friction)
    {
      const std::size_t   n = x_.size();
      std::vector<double> g(n - 1), D(n), rhs(n);
      for (std::size_t i = 0; i + 1 < n; ++i)
      {
        const double drop = 0.5 * (x_[i] + x_[i + 1]) / k_;
        g[i]              = i + 1 != n_ ? 1. / drop : h > 0. ? 1. / (drop + 1. / h) : 0.;
      }
      for (std::size_t i = 0; i < n; ++i)
      {
        const double C = (i < n_ ? die_ : metal_) * x_[i] / dt;
        D[i]           = C + (i > 0 ? g[i - 1] : 0.) + (i + 1 < n ? g[i] : 0.);
        rhs[i]         = C * (T_[i] + (i < n_ ? 0. : warms_by));
      }
      rhs[n_ - 1] += (1. - part_) * friction;
      rhs[n_] += part_ * friction;
      for (std::size_t i = 1; i < n; ++i)
      {
        const double m = g[i - 1] / D[i - 1];
        D[i] -= m * g[i - 1];
        rhs[i] += m * rhs[i - 1];
      }
      for (std::size_t i = n; i-- > 0;)
        T_[i] = (rhs[i] + (i + 1 < n ? g[i] * T_[i + 1] : 0.)) / D[i];
    }

    double              k_, metal_, die_, part_, flux_ = 0., into_metal_ = 0., into_die_ = 0.;
    std::vector<double> x_;
    std::size_t         n_; ///< cells of the die
    std::vector<double> T_;
  };
} // namespace retroforge
