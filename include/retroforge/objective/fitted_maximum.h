// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/objective/smooth_maximum.h>

#include <vector>

namespace retroforge
{
  /// Forces of increments along a path of the press.
  template <typename Number>
  struct ForcePath
  {
    std::vector<Number> force;  ///< [N]
    std::vector<Number> length; ///< by which increments count: their part of a window, > 0
    std::vector<Number> place;  ///< of their middles [mm]
    /// Where these were in the recorded run [mm]: which increments are fitted together, about where and with which
    /// weights is a decision.
    std::vector<double> recorded;
    double              reach; ///< increments nearer than this are fitted together [mm]; 0: none are

    std::size_t size() const { return force.size(); }
  };

  /// The largest force of a path that a gradient can follow.
  ///
  /// What a design does to the force of one increment depends on the points that arrive in it, and on the mesh
  /// it has: it scatters from increment to increment. So the force F̃_i at increment i is that of a fit to
  /// those around it. A workpiece of volume V and height h has the area V/h, which the force follows: 1/F is
  /// close to linear in the stroke, to the end, where F itself is steep. With D = (x_j - x_i)/reach, x_i as recorded, and D_r
  /// that of recorded places,
  ///   1/F̃_i = a,   a, b:   min sum_j l_j (1 - D_r²) F_j^2 (1 - F_j (a + b D))²   over |D_r| < 1.
  /// The largest of them is taken by
  ///   M(x) = ( sum_i l_i x_i^(12p) / sum_i l_i x_i^(11p) )^(1/p),
  ///   M(x) = 1/k log( sum_i l_i exp(12k x_i) / sum_i l_i exp(11k x_i) ):
  /// a p-norm and a log-sum-exp over that part of the path where x is large, so that a long path is no reason
  /// to be lower: M is never above the largest x, below it by a factor (11/12)^(1/p) where x rises exponentially,
  /// and not at all where it is constant.
  ///
  /// A step up near the end is extrapolated, too. What is above 1.05 M(F) is damped, with a continuous
  /// derivative, and never above 1.15 M(F).
  class FittedMaximum
  {
  public:
    explicit FittedMaximum(const SmoothMaximum &maximum);

    /// @return M(F̃) [N]; 0 for an empty path
    template <typename Number>
    Number value(const ForcePath<Number> &path) const;

    /// Returns its derivatives in forces, lengths and places.
    ForcePath<double> reverse(const ForcePath<double> &path) const;

  private:
    template <typename Number>
    Number largest(const std::vector<Number> &x, const std::vector<Number> &length) const;
    /// Adds to x_bar, length_bar what follows from M.
    void reverse_largest(const std::vector<double> &x,
                         const std::vector<double> &length,
                         double                     bar,
                         std::vector<double>       &x_bar,
                         std::vector<double>       &length_bar) const;

    SmoothMaximum maximum_, upper_, lower_;
  };
} // namespace retroforge
