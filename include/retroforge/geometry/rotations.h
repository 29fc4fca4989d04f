// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/types.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/tensor.h>

#include <string>
#include <vector>

namespace retroforge
{
  /// About an axis through the origin, of any length, counter-clockwise seen against it.
  dealii::Tensor<2, 3> rotation(const Vec3 &axis, double degrees);

  /// The rotation of a body about the origin: once, by `rotation axis` and `rotation angle`, or several
  /// times, by `rotations`, one after the other about axes that stay where they are.
  struct Rotations
  {
    Vec3                             axis  = Vec3({0., 0., 1.});
    double                           angle = 0.; ///< [degrees]
    std::vector<std::vector<double>> list;       ///< axis and angle of each [degrees]

    /// Declares `rotations`, in the present section.  @param of  whose, for the documentation
    void add_list(dealii::ParameterHandler &prm, const std::string &of);

    /// @throws Error  for what is no rotation, an axis without direction, both ways at once
    void check(const std::string &section) const;

    bool are_none() const { return angle == 0. && list.empty(); }

    /// R_n ... R_2 R_1.
    dealii::Tensor<2, 3> matrix() const;
  };
} // namespace retroforge
