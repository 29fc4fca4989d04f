// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/billet/billet.h>

#include <functional>
#include <string>
#include <vector>

namespace retroforge
{
  /// One number that changes the billet's shape by moving all nodes along a fixed field: `direction` is
  /// dX_0/dmu.
  struct ShapeParameter
  {
    std::string          name; ///< without `billet/`
    std::string          unit;
    double               nominal;
    double               scale; ///< a length that steps are relative to
    NodalVectors<double> direction;
  };

  /// The ways one kind of billet can change its shape,  X_0 = X + sum_j (mu_j - nominal_j) dX_0/dmu_j.
  /// Linear in mu, so that contours stay of their kind: the nodes on a portion move to the same portion of
  /// the new contour.
  struct BilletShapes
  {
    std::vector<ShapeParameter> parameters;
    /// Returns the rule that the values of all parameters break, in words; empty when none.
    std::function<std::string(const std::vector<double> &)> complaint;
    /// Returns the billet whose measures are the given values; null where a shape has no measures.
    std::function<BilletParameters(const std::vector<double> &)> measured;
  };

  /// @param X  positions of the nodes in the billet's own axes, from the centre of its base
  /// Box: stretch, x and y -> (1 + 2 mu/a) (113), with the size a along x;  height, z -> z mu/height.
  BilletShapes box_shapes(const BilletParameters &billet, const NodalVectors<double> &X);

  /// Cylinder: radius, x and y -> mu/radius (116)-(117);  height, z -> z mu/height.
  BilletShapes cylinder_shapes(const BilletParameters &billet, const NodalVectors<double> &X);

  /// Ring: mu1 to mu4 of RingProfile. Blocks between lines through the control points move as bilinear
  /// functions of r and z.  @cite Laroussi2003, Eqs. (127), (149)
  BilletShapes ring_shapes(const BilletParameters &billet, const NodalVectors<double> &X);

  /// Profile: `control point i r` and `control point i z`, i from 1. With B_i the spline's basis and t, s the
  /// coordinates of SplineProfile, dX_0 = s B_i(t) dP_i + (1-s) da(t). A point on the inner line stays on it.
  BilletShapes profile_shapes(const BilletParameters &billet, const NodalVectors<double> &X);
} // namespace retroforge
