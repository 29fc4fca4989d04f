// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/fe/fe_poly.h>

namespace retroforge
{
  /// The scalar space of one velocity component of the mini element, on the reference triangle or
  /// tetrahedron: P1 and the hat bubble b = (dim+1) min lambda_a, which is 1 at the barycentre and linear on
  /// each of the dim+1 simplices that the barycentre spans with the faces. The shape functions are lambda_0 …
  /// lambda_dim, then b; degrees of freedom are the values at the vertices, and what the value at the
  /// barycentre exceeds their mean by.
  ///
  /// Gradients of b jump at the faces between these simplices: integrate with hat_quadrature(), or a rule
  /// iterated over them, and never ask for gradients at the barycentre, on its edges or at the vertices,
  /// where the one returned is that of the first simplex that holds the point.
  template <int dim>
  class FE_SimplexHat : public dealii::FE_Poly<dim>
  {
  public:
    FE_SimplexHat();

    std::unique_ptr<dealii::FiniteElement<dim>> clone() const override;

    std::string get_name() const override;

    /// The vertices' functions sum to one; the bubble is no part of the constant.
    std::pair<dealii::Table<2, bool>, std::vector<unsigned int>> get_constant_modes() const override;

    /// Interpolation: values at the vertices and the barycentre.
    void convert_generalized_support_point_values_to_dof_values(
      const std::vector<dealii::Vector<double>> &support_point_values,
      std::vector<double>                       &nodal_values) const override;
  };

  /// One point in each of the dim+1 simplices, exact for the mini element's residual and tangent: all
  /// gradients are constant there, and a pressure is linear.
  template <int dim>
  dealii::Quadrature<dim> hat_quadrature();

  /// A rule on each of the dim+1 simplices, for what is not constant on them.
  template <int dim>
  dealii::Quadrature<dim> iterated_on_hat(const dealii::Quadrature<dim> &rule);
} // namespace retroforge
