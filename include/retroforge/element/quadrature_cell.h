// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/element/point_rates.h>
#include <retroforge/element/reference_element.h>
#include <retroforge/element/tangent_pack.h>

#include <deal.II/base/table.h>
#include <deal.II/lac/full_matrix.h>

/// @file
/// Cells by quadrature, for any pair of elements, any geometry and two or three dimensions:
///   Pi_T(V, P) = sum_q W_q [ K/(m+1) chi_q^((m+1)/2) - p_q tr eps_q ],   W_q = w_q det J_q (2 pi r_q),
/// with J = dx/dxi and eps = sym(dv/dxi J^-1), and around the axis of an axisymmetric flow v_r/r. Its
/// gradient in (V, P) is the residual. The kernels have the names of the closed forms of
/// element/mini_element.h and element/taylor_hood.h and agree with them on straight tetrahedra, but for
/// rounding; all derivatives come from dual numbers at the points, and of the law only its factor and its
/// potential are asked.
namespace retroforge
{
  template <int dim, typename Number>
  using CellVectors = std::vector<dealii::Tensor<1, dim, Number>>;

  /// A cell: the positions of its geometry's nodes [mm] on a reference element, which must live as long.
  template <int dim, typename Number>
  struct QuadratureGeometry
  {
    const ReferenceElement<dim> *element;
    CellVectors<dim, Number>     X;
  };

  /// Positions on an element are all that the kernels need.
  template <int dim, typename Number>
  const QuadratureGeometry<dim, Number> &cell_geometry(const QuadratureGeometry<dim, Number> &geometry)
  {
    return geometry;
  }

  /// Unknowns of one cell, or anything dual to them (residual, adjoint).
  template <int dim, typename Number>
  struct QuadratureValues
  {
    CellVectors<dim, Number> V; ///< coefficients of velocity functions, a bubble last [mm/s]
    std::vector<Number>      P; ///< coefficients of pressure functions [MPa]

    QuadratureValues() = default;
    /// Zeros.
    explicit QuadratureValues(const ReferenceElement<dim> &element)
        : V(element.n_velocities()), P(element.n_pressures(), Number(0.))
    {
    }
  };

  /// Derivatives of a scalar of the cell in everything that is not an unknown.
  template <int dim>
  struct QuadratureSensitivity
  {
    CellVectors<dim, double> X;
    MaterialLaw<double>      law;
  };

  /// [mm^3], of plane cells per mm of thickness.
  template <int dim, typename Number>
  Number cell_volume(const QuadratureGeometry<dim, Number> &geometry);

  /// Value of Pi_T [mJ/s].
  template <int dim, typename Number>
  Number cell_functional(const QuadratureGeometry<dim, Number> &geometry,
                         const QuadratureValues<dim, Number>   &w,
                         const MaterialLaw<Number>             &law);

  /// Gradient of Pi_T in (V, P).
  template <int dim, typename Number>
  QuadratureValues<dim, Number> cell_residual(const QuadratureGeometry<dim, Number> &geometry,
                                              const QuadratureValues<dim, Number>   &w,
                                              const MaterialLaw<Number>             &law);

  /// Dissipated power  int_T s:eps  [mJ/s].
  template <int dim, typename Number>
  Number cell_dissipation(const QuadratureGeometry<dim, Number> &geometry,
                          const QuadratureValues<dim, Number>   &w,
                          const MaterialLaw<Number>             &law);

  /// Mean over the volume of the equivalent strain rate e = sqrt(2/3 eps:eps) [1/s]. Not smooth where an
  /// eps_q vanishes: the derivative of that e_q is then zero.
  template <int dim, typename Number>
  Number cell_strain_rate(const QuadratureGeometry<dim, Number> &geometry,
                          const QuadratureValues<dim, Number>   &w);

  /// Derivatives of lambda·cell_residual in X and the law.
  template <int dim>
  QuadratureSensitivity<dim> reverse_cell_residual(const QuadratureGeometry<dim, double> &geometry,
                                                   const QuadratureValues<dim, double>   &w,
                                                   const QuadratureValues<dim, double>   &lambda,
                                                   const MaterialLaw<double>             &law);

  /// And adds those in the unknowns, which are the transposed tangent times lambda, to w_bar.
  template <int dim>
  QuadratureSensitivity<dim> reverse_cell_residual(const QuadratureGeometry<dim, double> &geometry,
                                                   const QuadratureValues<dim, double>   &w,
                                                   const QuadratureValues<dim, double>   &lambda,
                                                   const MaterialLaw<double>             &law,
                                                   QuadratureValues<dim, double>         &w_bar);

  /// Adds weight times the derivatives of cell_dissipation in the unknowns to w_bar and returns those in X
  /// and the law.
  template <int dim>
  QuadratureSensitivity<dim> reverse_cell_dissipation(const QuadratureGeometry<dim, double> &geometry,
                                                      const QuadratureValues<dim, double>   &w,
                                                      const MaterialLaw<double>             &law,
                                                      double                                 weight,
                                                      QuadratureValues<dim, double>         &w_bar);

  /// Adds the derivatives of weight * cell_strain_rate in the unknowns and in the positions of the nodes to
  /// w_bar and X_bar.
  template <int dim>
  void reverse_cell_strain_rate(const QuadratureGeometry<dim, double> &geometry,
                                const QuadratureValues<dim, double>   &w,
                                double                                 weight,
                                QuadratureValues<dim, double>         &w_bar,
                                CellVectors<dim, double>              &X_bar);

  /// Mean over the volume of the stress s, without the trace that is left where the discrete flow is not
  /// quite incompressible [MPa].
  template <int dim, typename Number>
  Symmetric<Number> cell_deviatoric_stress(const QuadratureGeometry<dim, Number> &geometry,
                                           const QuadratureValues<dim, Number>   &w,
                                           const MaterialLaw<Number>             &law);

  /// Adds the derivatives of  s_bar : cell_deviatoric_stress  in the unknowns to w_bar and returns those in X
  /// and the law.
  template <int dim>
  QuadratureSensitivity<dim> reverse_cell_deviatoric_stress(const QuadratureGeometry<dim, double> &geometry,
                                                            const QuadratureValues<dim, double>   &w,
                                                            const MaterialLaw<double>             &law,
                                                            Symmetric<double>                      s_bar,
                                                            QuadratureValues<dim, double>         &w_bar);

  /// Strain rates eps [1/s] at the vertices, without the bubble: on the axis that around it is that across
  /// it.
  template <int dim>
  std::array<Symmetric<double>, dim + 1> corner_strain_rates(const QuadratureGeometry<dim, double> &geometry,
                                                             const QuadratureValues<dim, double>   &w);

  /// Second derivatives of Pi_T,  [A B; B^T C].
  template <int dim>
  struct QuadratureTangent
  {
    dealii::Table<2, dealii::Tensor<2, dim>> A; ///< of velocity functions
    dealii::Table<2, dealii::Tensor<1, dim>> B; ///< velocity of the first, pressure of the second
    dealii::FullMatrix<double>               C; ///< of pressures; zero before a bubble is eliminated
    double viscosity; ///< mean stress factor / 2 [MPa s], for the Schur complement's scale
    double volume;    ///< [mm^3]
  };

  /// All functions, the bubble among them.
  template <int dim>
  QuadratureTangent<dim> cell_tangent(const QuadratureGeometry<dim, double> &geometry,
                                      const QuadratureValues<dim, double>   &w,
                                      const MaterialLaw<double>             &law,
                                      Linearisation                          linearisation);

  /// Data of the elimination of a cell's bubble, which the solution of systems needs again: BubbleElimination
  /// for any pair.
  template <int dim>
  struct EliminatedBubble
  {
    std::vector<dealii::Tensor<2, dim>> Vb; ///< velocity-bubble
    std::vector<dealii::Tensor<1, dim>> Pb; ///< pressure-bubble
    dealii::Tensor<2, dim>              M;  ///< inverse of bubble-bubble
  };

  /// Takes the bubble out of a tangent:  A -= Vb M Vb^T,  B -= Vb M Pb^T,  C -= Pb M Pb^T.
  template <int dim>
  EliminatedBubble<dim> eliminate_bubble(QuadratureTangent<dim> &tangent);

  /// The bubble that makes the bubble's residual vanish at given V and P, by Newton to rounding. Starts from
  /// that of w.
  template <int dim>
  dealii::Tensor<1, dim> solve_bubble(const QuadratureGeometry<dim, double> &geometry,
                                      const QuadratureValues<dim, double>   &w,
                                      const MaterialLaw<double>             &law);
} // namespace retroforge
