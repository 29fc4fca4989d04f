// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/contact/interface_law.h>
#include <retroforge/solver/equilibrium.h>

/// @file
/// The power that is spent in an increment, and the force that follows from it, right where gaps close.
///
/// A point that a die would reach after a part theta of the increment comes towards it at the speed u at which
/// it arrives at the increment's end, instead of at its own, u_f = u/theta. It is pressed all the while, and
/// the die's force N does the work N u that no force does in truth. So the power that the dies give,
///   sum_d R_d·v_d = D + C,   C = sum N u,   D: deformation and friction,
/// is larger than what is spent, D. What is spent in truth, on the average over the increment, lies between:
///   - Where single points arrive at a body that flows, the potential Phi = D/(1 + m) of the power law is
///     Phi_f + dPhi (1 - theta)^2, and N = 2 dPhi (1 - theta)/u_f. The truth, theta D(u_f) + (1 - theta) D(0),
///     is D + (1 + m)/2 C.
///   - Where a die arrives at all points at once, the body flows as if the die came slower:
///     D = c (v - u)^(1+m), C = c (v - u)^m u. The truth, c (v - u) v^m, is D^(1-m) (D + C)^m.
/// Both are linear in u, so that they hold for a gap that closes in several increments, too. Of each die, what
/// closes at the speed at which it comes to the nearest points that it presses is of the second case, a their
/// approach speeds,
///   u_c = sum N psi a / sum N phi,   psi = 1/(1 + (a/u_r)^4),   phi = psi, but 1 where edges are sunk in,
///   u_r = 0.01 of the dies' closing speed,
/// which is 0 where it stands on some; of what closes beside that, w = u - u_c, the share of the second case is
///   kappa = (((sum N w)^2 + r^2) / (sum N sum N w^2 + r^2))^4,  r = 0.025 D.
/// The ratio is 1 where all pressed points close at one speed, and about the share of the arriving points in the
/// force where the others rest. Its power counts more of what arrives as arriving at a body that flows
/// (measured, doc/theory/increment_and_adjoint.md). (What a gap costs that opens everywhere at once is not the sum of what
/// it costs point by point: there is no derivative at rest that is right for both. This one is that of dies and
/// billets that move as a whole, also where other points arrive in that increment: without u_c these took half
/// of the derivative by an offset of the die with them.)
///
/// With  w C  for what is added to D, all forces are multiplied by  (D + w C) / (D + C):  the power of the dies
/// is then what is spent, and the forces are in equilibrium as before.
namespace retroforge
{
  /// Energy [mJ] or power [mJ/s] by what it is spent on.
  template <typename Number>
  struct EnergyParts
  {
    Number deformation = Number(0.), friction = Number(0.);
    Number closing = Number(0.); ///< w C: what the sums over the stages lack where gaps close

    Number total() const { return deformation + friction + closing; }
  };

  /// Returns the speed of closing below which points rest, u_r [mm/s].
  template <typename Number>
  Number rest_speed(const std::vector<DieState<Number>> &dies);

  /// Adds the derivatives of  speed_bar * rest_speed(dies).
  void reverse_rest_speed(const std::vector<DieState<double>> &dies,
                          double                               speed_bar,
                          std::vector<DieState<double>>       &dies_bar);

  /// What a stage contributes to the power of its increment. Terms are sums over the stages, weighted as the
  /// time scheme does, and over ranks; their number is n_power_terms().
  /// @return this rank's part
  template <typename Number>
  std::vector<Number> power_terms(const EquilibriumView<Number> &view);

  constexpr std::size_t n_closing_moments = std::tuple_size<ClosingMoments<double>>::value;

  /// Returns how many terms there are.
  inline std::size_t n_power_terms(const std::size_t n_dies)
  {
    return 3 + n_closing_moments * n_dies;
  }

  /// Adds the derivatives of  weights·power_terms.
  void reverse_power_terms(const EquilibriumView<double> &view,
                           const std::vector<double>     &weights,
                           EquilibriumBar                &bar);

  /// Returns what is spent in an increment with these terms [mJ/s].
  template <typename Number>
  EnergyParts<Number> spent_power(const std::vector<Number> &terms);

  /// Returns C, the power of the dies that is spent on nothing [mJ/s].
  template <typename Number>
  Number closing_power(const std::vector<Number> &terms);

  /// Returns  (D + w C) / (D + C),  by which forces of dies are multiplied; 1 where the dies have no power.
  template <typename Number>
  Number force_factor(const std::vector<Number> &terms);
} // namespace retroforge
