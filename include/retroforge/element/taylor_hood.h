// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/element/cell_geometry.h>
#include <retroforge/element/point_rates.h>
#include <retroforge/element/tangent_pack.h>

/// @file
/// The tetrahedron of Taylor and Hood: P2 velocity and P1 pressure on straight edges.
///
/// Velocity nodes are the corners and the middles of the edges. With V_cc = V_c of corner c and V_cd of the
/// middle between c and d, the velocity gradient is that of a linear field whose nodal velocities vary,
///   L(x) = sum_c U_c(x) (x) g_c,     U_c = 4 sum_d l_d V_cd - V_c.
/// It is sampled at four points of equal weights, at point a of which l_a = (5 + 3 sqrt5)/20 and the other l
/// are (5 - sqrt5)/20, which integrate polynomials of degree two exactly: the constraint of
/// incompressibility, and the potential where m = 1.  With a quarter of the volume each,
///   Pi_T(V, P) = |T|/4 sum_a [ K/(m+1) chi_a^((m+1)/2) - p_a tr L_a ]
/// is the element's part of the saddle functional, convex in V since the weights are positive; its gradient
/// is the residual.  @cite Taylor1973, quadrature: @cite Hammer1956
namespace retroforge
{
  /// The corners, then the middles of the edges as tet_edge_corners.
  template <typename T>
  using VelocityNodes = std::array<T, 10>;

  /// Unknowns of one cell, or anything dual to them (residual, adjoint).
  template <typename Number>
  struct TaylorHoodValues
  {
    VelocityNodes<Vector3<Number>> V; ///< nodal velocities [mm/s]
    Four<Number>                   P; ///< nodal pressures [MPa]
  };

  /// Value of Pi_T [mJ/s].
  template <typename Number>
  Number cell_functional(const CellGeometry<Number>     &geometry,
                         const TaylorHoodValues<Number> &w,
                         const MaterialLaw<Number>      &law);

  /// Gradient of Pi_T in (V, P).
  template <typename Number>
  TaylorHoodValues<Number> cell_residual(const CellGeometry<Number>     &geometry,
                                         const TaylorHoodValues<Number> &w,
                                         const MaterialLaw<Number>      &law);

  /// Dissipated power  int_T s:eps  [mJ/s], s:eps at the four points.
  template <typename Number>
  Number cell_dissipation(const CellGeometry<Number>     &geometry,
                          const TaylorHoodValues<Number> &w,
                          const MaterialLaw<Number>      &law);

  /// Equivalent strain rates e = sqrt(2/3 eps:eps) [1/s] at the four points.
  Four<double> cell_strain_rates(const CellGeometry<double> &geometry, const TaylorHoodValues<double> &w);

  /// 1/4 sum_a e_a [1/s]. Not smooth where an eps_a vanishes: the derivative of that e_a, where one is asked
  /// for, is then zero.
  template <typename Number>
  Number cell_strain_rate(const CellGeometry<Number> &geometry, const TaylorHoodValues<Number> &w);

  /// Adds the derivatives of weight * cell_strain_rate in the unknowns and in the positions of the corners to
  /// w_bar and X_bar.
  void reverse_cell_strain_rate(const CellGeometry<double>     &geometry,
                                const TaylorHoodValues<double> &w,
                                double                          weight,
                                TaylorHoodValues<double>       &w_bar,
                                Four<Vec3>                     &X_bar);

  /// Mean over the four points of the stress s, without the trace that is left where the discrete flow is not
  /// quite incompressible [MPa].
  template <typename Number>
  Symmetric<Number> cell_deviatoric_stress(const CellGeometry<Number>     &geometry,
                                           const TaylorHoodValues<Number> &w,
                                           const MaterialLaw<Number>      &law);

  /// Adds the derivatives of  s_bar : cell_deviatoric_stress  in the unknowns to w_bar and returns those in X
  /// and the law.
  CellSensitivity reverse_cell_deviatoric_stress(const CellGeometry<double>     &geometry,
                                                 const TaylorHoodValues<double> &w,
                                                 const MaterialLaw<double>      &law,
                                                 const Symmetric<double>        &s_bar,
                                                 TaylorHoodValues<double>       &w_bar);

  /// Derivative of lambda·cell_residual in X and the law at fixed unknowns: one closed-form sweep, no matrix.
  CellSensitivity reverse_cell_residual(const CellGeometry<double>     &geometry,
                                        const TaylorHoodValues<double> &w,
                                        const TaylorHoodValues<double> &lambda,
                                        const MaterialLaw<double>      &law);

  /// Adds weight times the derivatives of cell_dissipation in the unknowns to w_bar and returns those in X
  /// and the law.
  CellSensitivity reverse_cell_dissipation(const CellGeometry<double>     &geometry,
                                           const TaylorHoodValues<double> &w,
                                           const MaterialLaw<double>      &law,
                                           double                          weight,
                                           TaylorHoodValues<double>       &w_bar);

  /// Second derivatives of Pi_T, the symmetric 34 x 34 matrix [A B; B^T 0] of one cell.
  template <typename Number>
  struct TaylorHoodBlocks
  {
    Number A[10][10][3][3]; ///< velocity-velocity
    Number B[10][4][3];     ///< velocity of the first node, pressure of the second
    Number viscosity;       ///< mean stress factor / 2 [MPa s], for the Schur complement's scale
    Number volume;          ///< [mm^3]
  };

  using TaylorHoodTangent = TaylorHoodBlocks<double>;
  using TaylorHoodPack    = TaylorHoodBlocks<Pack>;

  void compute_cell_tangent(const CellGeometry<double>     &geometry,
                            const TaylorHoodValues<double> &w,
                            const MaterialLaw<double>      &law,
                            Linearisation                   linearisation,
                            TaylorHoodTangent              &tangent);

  /// As compute_cell_tangent, for n_lanes cells.
  void compute_cell_tangents(const std::array<CellGeometry<double>, n_lanes>     &geometry,
                             const std::array<TaylorHoodValues<double>, n_lanes> &w,
                             const LaneLaws                                      &laws,
                             Linearisation                                        linearisation,
                             TaylorHoodPack                                      &tangent);
} // namespace retroforge
