// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/element/cell_geometry.h>
#include <retroforge/element/point_rates.h>
#include <retroforge/element/tangent_pack.h>

/// @file
/// The tetrahedron with P1 + hat bubble velocity and P1 pressure, integrated in closed form.
///
/// The bubble is 4 l_a on the sub-tetrahedron T_a spanned by the barycentre and the face opposite node a, l_a
/// the barycentric coordinates, so all gradients are constant there:
///   eps_a = sym( sum_c V_c (x) g_c + 4 beta (x) g_a ),  |T_a| = |T|/4,  and
///   Pi_T(V, beta, P) = |T|/4 sum_a K/(m+1) chi_a^((m+1)/2) - |T| pbar tr(L) + |T|/4 beta·grad p,
///   chi_a = 2 eps_a:eps_a + 3 e0^2,  L = sum_c V_c (x) g_c
/// is the element's part of the saddle functional, whose gradient is the residual.  @cite Laroussi2003, Eq.
/// (36)-(39)
namespace retroforge
{
  /// Unknowns of one cell, or anything dual to them (residual, adjoint).
  template <typename Number>
  struct CellValues
  {
    Four<Vector3<Number>> V;    ///< nodal velocities [mm/s]
    Vector3<Number>       beta; ///< bubble velocity [mm/s]
    Four<Number>          P;    ///< nodal pressures [MPa]
  };

  /// Value of Pi_T [mJ/s].
  template <typename Number>
  Number cell_functional(const CellGeometry<Number> &geometry,
                         const CellValues<Number>   &w,
                         const MaterialLaw<Number>  &law);

  /// Gradient of Pi_T in (V, beta, P).
  template <typename Number>
  CellValues<Number> cell_residual(const CellGeometry<Number> &geometry,
                                   const CellValues<Number>   &w,
                                   const MaterialLaw<Number>  &law);

  /// Dissipated power  int_T s:eps  [mJ/s].
  template <typename Number>
  Number cell_dissipation(const CellGeometry<Number> &geometry,
                          const CellValues<Number>   &w,
                          const MaterialLaw<Number>  &law);

  /// Equivalent strain rates e = sqrt(2/3 eps:eps) [1/s] on the four sub-tetrahedra.
  Four<double> cell_strain_rates(const CellGeometry<double> &geometry, const CellValues<double> &w);

  /// ebar_T = 1/4 sum_a e_a [1/s]. Not smooth where an eps_a vanishes: the derivative of that e_a, where one
  /// is asked for, is then zero.
  template <typename Number>
  Number cell_strain_rate(const CellGeometry<Number> &geometry, const CellValues<Number> &w);

  /// Adds the derivatives of weight * cell_strain_rate in the unknowns and in the positions of the nodes to
  /// w_bar and X_bar.
  void reverse_cell_strain_rate(const CellGeometry<double> &geometry,
                                const CellValues<double>   &w,
                                double                      weight,
                                CellValues<double>         &w_bar,
                                Four<Vec3>                 &X_bar);

  /// Deviatoric stress of the cell [MPa]: the mean over the four sub-tetrahedra, of equal volume, of the law's
  /// s_a = 2 K chi_a^((m-1)/2) eps_a, without the trace that is left where the discrete flow is not quite
  /// incompressible.
  template <typename Number>
  Symmetric<Number> cell_deviatoric_stress(const CellGeometry<Number> &geometry,
                                           const CellValues<Number>   &w,
                                           const MaterialLaw<Number>  &law);

  /// Adds the derivatives of  s_bar : cell_deviatoric_stress  in the unknowns to w_bar and returns those in X
  /// and the law.
  CellSensitivity reverse_cell_deviatoric_stress(const CellGeometry<double> &geometry,
                                                 const CellValues<double>   &w,
                                                 const MaterialLaw<double>  &law,
                                                 const Symmetric<double>    &s_bar,
                                                 CellValues<double>         &w_bar);

  /// Derivative of lambda·cell_residual in X and the law at fixed unknowns: one closed-form sweep, no matrix.
  CellSensitivity reverse_cell_residual(const CellGeometry<double> &geometry,
                                        const CellValues<double>   &w,
                                        const CellValues<double>   &lambda,
                                        const MaterialLaw<double>  &law);

  /// Adds weight times the derivatives of cell_dissipation in the unknowns to w_bar and returns those in X
  /// and the law.
  CellSensitivity reverse_cell_dissipation(const CellGeometry<double> &geometry,
                                           const CellValues<double>   &w,
                                           const MaterialLaw<double>  &law,
                                           double                      weight,
                                           CellValues<double>         &w_bar);

  /// Data of the elimination of a cell's bubble, which the solution of systems needs again.
  template <typename Number>
  struct BubbleElimination
  {
    Number Vb[4][3][3]; ///< velocity-bubble
    Number Pb[4][3];    ///< pressure-bubble
    Number M[3][3];     ///< inverse of bubble-bubble

    /// Bubble part of a solution of the uncondensed system with right-hand side rhs.beta.
    Vec3 recover_bubble(const Vec3 &rhs_beta, const Four<Vec3> &V, const Four<double> &P) const;

    /// Right-hand side of the condensed system: rhs.V -= Vb M rhs.beta, rhs.P -= Pb M rhs.beta.
    void condense(CellValues<double> &rhs) const;
  };

  /// Second derivatives of Pi_T with the bubble eliminated: the symmetric 16 x 16 matrix [A B; B^T C] of one
  /// cell.
  template <typename Number>
  struct TangentBlocks : BubbleElimination<Number>
  {
    Number A[4][4][3][3]; ///< velocity-velocity
    Number B[4][4][3];    ///< velocity of the first node, pressure of the second
    Number C[4][4];       ///< pressure-pressure, negative semi-definite
    Number viscosity;     ///< mean stress factor / 2 [MPa s], for the Schur complement's scale
    Number volume;        ///< [mm^3]
  };

  using CellTangent = TangentBlocks<double>;
  using TangentPack = TangentBlocks<Pack>;

  void compute_cell_tangent(const CellGeometry<double> &geometry,
                            const CellValues<double>   &w,
                            const MaterialLaw<double>  &law,
                            CellTangent                &tangent);

  /// As compute_cell_tangent, for n_lanes cells.
  /// @param elimination  where each lane's part that must be kept goes
  void compute_cell_tangents(const std::array<CellGeometry<double>, n_lanes>        &geometry,
                             const std::array<CellValues<double>, n_lanes>          &w,
                             const LaneLaws                                         &laws,
                             Linearisation                                           linearisation,
                             TangentPack                                            &tangent,
                             const std::array<BubbleElimination<double> *, n_lanes> &elimination);

  /// The bubble that makes the bubble's residual vanish at given V and P: a convex problem in three unknowns,
  /// solved by Newton to rounding. Starts from w.beta.
  Vec3 solve_bubble(const CellGeometry<double> &geometry,
                    const CellValues<double>   &w,
                    const MaterialLaw<double>  &law);

  /// Solves for the bubbles of n_lanes cells: the bits of each are those of solve_bubble().
  std::array<Vec3, n_lanes> solve_bubbles(const std::array<CellGeometry<double>, n_lanes> &geometry,
                                          const std::array<CellValues<double>, n_lanes>   &w,
                                          const LaneLaws                                  &laws);
} // namespace retroforge
