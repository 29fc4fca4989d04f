// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/fe/fe_poly.h>

namespace retroforge
{
  /// The scalar space of one velocity component of the mini element, on the reference tetrahedron: P1 and the
  /// hat bubble b = 4 min lambda_a, which is 1 at the barycentre and linear on each of the four tetrahedra
  /// that the barycentre spans with the faces. The shape functions are lambda_0 … lambda_3, then b; degrees
  /// of freedom are the values at the vertices, and what the value at the barycentre exceeds their mean by.
  ///
  /// Gradients of b jump at the faces between these tetrahedra: integrate with hat_quadrature(), or a rule
  /// iterated over them, and never ask for gradients at the barycentre, on its edges or at the vertices,
  /// where the one returned is that of the first tetrahedron that holds the point.
  class FE_SimplexHat : public dealii::FE_Poly<3>
  {
  public:
    FE_SimplexHat();

    std::unique_ptr<dealii::FiniteElement<3>> clone() const override;

    std::string get_name() const override;

    /// The vertices' functions sum to one; the bubble is no part of the constant.
    std::pair<dealii::Table<2, bool>, std::vector<unsigned int>> get_constant_modes() const override;

    /// Interpolation: values at the vertices and the barycentre.
    void convert_generalized_support_point_values_to_dof_values(
      const std::vector<dealii::Vector<double>> &support_point_values,
      std::vector<double>                       &nodal_values) const override;
  };

  /// One point in each of the four tetrahedra, exact for the mini element's residual and tangent: all
  /// gradients are constant there, and a pressure is linear.
  dealii::Quadrature<3> hat_quadrature();
} // namespace retroforge
