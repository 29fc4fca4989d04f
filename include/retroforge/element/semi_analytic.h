// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/element/mini_element.h>
#include <retroforge/element/quadrature_cell.h>
#include <retroforge/element/taylor_hood.h>

namespace retroforge
{
  /// The method of derivatives of a cell in the positions of its nodes: closed form, or differences inside
  /// the cell in its twelve coordinates, with a step relative to the cell's size.  @cite Laroussi2003, Eq.
  /// (76)-(79)
  struct ShapeDerivatives
  {
    enum class Method
    {
      exact,
      forward, ///< the thesis' choice
      central
    };
    Method method       = Method::exact;
    double perturbation = 1e-6;
  };

  /// Derivative of lambda·cell_residual in X by differences, of the method that `how` says (not exact).
  template <typename Values>
  Four<Vec3> difference_cell_residual(const Four<Vec3>          &X,
                                      const Values              &w,
                                      const Values              &lambda,
                                      const MaterialLaw<double> &law,
                                      const ShapeDerivatives    &how);

  /// Derivative of weight * cell_dissipation in X, likewise.
  template <typename Values>
  Four<Vec3> difference_cell_dissipation(const Four<Vec3>          &X,
                                         const Values              &w,
                                         const MaterialLaw<double> &law,
                                         double                     weight,
                                         const ShapeDerivatives    &how);

  /// @name By quadrature
  /// @{
  CellVectors<3, double> difference_cell_residual(const QuadratureGeometry<3, double> &geometry,
                                                  const QuadratureValues<3, double>   &w,
                                                  const QuadratureValues<3, double>   &lambda,
                                                  const MaterialLaw<double>           &law,
                                                  const ShapeDerivatives              &how);
  CellVectors<3, double> difference_cell_dissipation(const QuadratureGeometry<3, double> &geometry,
                                                     const QuadratureValues<3, double>   &w,
                                                     const MaterialLaw<double>           &law,
                                                     double                               weight,
                                                     const ShapeDerivatives              &how);
  /// @}
} // namespace retroforge
