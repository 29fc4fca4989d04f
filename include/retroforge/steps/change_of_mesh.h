// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/record/increment_record.h>
#include <retroforge/steps/kept_heat.h>
#include <retroforge/steps/workpiece_state.h>

/// @file
/// The step that takes the workpiece from one mesh to the next. What happens to a member of the state follows
/// from its kind: positions by the tape of what remeshing did to them (PositionTape), one number or vector per
/// node q' = J q, one number per cell transfer_cells(); fields of nodes and bounded ones of cells within the range of the
/// values that a row of J takes. Temperatures are then corrected so that heat is kept
/// (steps/kept_heat.h).
namespace retroforge
{
  /// Takes a member of the state to the new mesh, each kind by its overload; on dual numbers its tangent.
  template <typename Number>
  struct MemberTransfer
  {
    const TetMesh                       &old_mesh;
    const RemeshRecord                  &remesh;
    const NodalVectors<Number>          &X; ///< on the old mesh
    const std::vector<Die>              &dies;
    const std::vector<DieState<Number>> &states;

    void operator()(const NodalVectors<Number> &positions, NodalVectors<Number> &to) const;
    void operator()(const NodeField<Number> &q, NodeField<Number> &to) const;
    void operator()(const NodeVectorField<3, Number> &v, NodeVectorField<3, Number> &to) const;
    void operator()(const CellField<Number> &q, CellField<Number> &to) const;
    void operator()(const BoundedCellField<Number> &q, BoundedCellField<Number> &to) const;
  };

  /// The reverse of it: from a member of the costate on the new mesh to that on the old one. Positions come
  /// before cells, which add to them by way of the volumes that they were weighed with.
  struct ReverseMemberTransfer
  {
    const TetMesh                       &old_mesh;
    const RemeshRecord                  &remesh;
    const NodalVectors<double>          &X; ///< on the old mesh
    const std::vector<Die>              &dies;
    const std::vector<DieState<double>> &states;
    NodalVectors<double>                &X_bar;    ///< on the old mesh
    std::vector<DieState<double>>       &dies_bar; ///< added to

    /// @param q      the member on the old mesh
    /// @param q_bar  its costate on the new mesh
    void operator()(const NodalVectors<double> &q,
                    const NodalVectors<double> &q_bar,
                    NodalVectors<double>       &to) const;
    void operator()(const NodeField<double> &q, const NodeField<double> &q_bar, NodeField<double> &to) const;
    void operator()(const NodeVectorField<3, double> &v,
                    const NodeVectorField<3, double> &v_bar,
                    NodeVectorField<3, double>       &to) const;
    void operator()(const CellField<double> &q, const CellField<double> &q_bar, CellField<double> &to) const;
    void operator()(const BoundedCellField<double> &q,
                    const BoundedCellField<double> &q_bar,
                    BoundedCellField<double>       &to) const;
  };

  /// Returns the state on the new mesh; on dual numbers its tangent.
  template <typename Number>
  WorkpieceState<3, Number> change_mesh(const TetMesh                       &old_mesh,
                                        const RemeshRecord                  &remesh,
                                        const WorkpieceState<3, Number>     &before,
                                        const std::vector<Die>              &dies,
                                        const std::vector<DieState<Number>> &states)
  {
    AssertDimension(remesh.transfer.n_old, old_mesh.n_nodes());
    AssertDimension(remesh.transfer.n_new(), remesh.mesh.n_nodes());
    AssertDimension(before.X.size(), old_mesh.n_nodes());
    WorkpieceState<3, Number> after;
    internal::for_each_member(
      MemberTransfer<Number>{old_mesh, remesh, before.X, dies, states}, before, after);
    if (!before.temperature.empty())
      after.temperature = keep_heat<Number>({old_mesh, before.X, before.temperature},
                                            {remesh.mesh, after.X, after.temperature});
    return after;
  }

  /// Returns the costate on the old mesh of one on the new mesh: the reverse of change_mesh().
  /// @param before    the state on the old mesh
  /// @param dies_bar  gets the derivatives in the dies added
  inline WorkpieceState<3, double> reverse_change_mesh(const TetMesh                       &old_mesh,
                                                       const RemeshRecord                  &remesh,
                                                       const WorkpieceState<3, double>     &before,
                                                       const std::vector<Die>              &dies,
                                                       const std::vector<DieState<double>> &states,
                                                       const WorkpieceState<3, double>     &costate,
                                                       std::vector<DieState<double>>       &dies_bar)
  {
    AssertDimension(before.X.size(), old_mesh.n_nodes());
    AssertDimension(costate.X.size(), remesh.mesh.n_nodes());
    WorkpieceState<3, double> there, of_transfer = costate; // before heat is kept
    NodalVectors<double>      X_bar(before.X.size());
    NodeField<double>         T_bar(before.temperature.size(), 0.);
    if (!is_zero(costate.temperature))
    {
      const MemberTransfer<double> transfer{old_mesh, remesh, before.X, dies, states};
      NodalVectors<double>         X;
      NodeField<double>            T;
      transfer(before.X, X);
      transfer(before.temperature, T);
      of_transfer.temperature = reverse_keep_heat({old_mesh, before.X, before.temperature},
                                                  {remesh.mesh, X, T},
                                                  costate.temperature,
                                                  X_bar,
                                                  T_bar,
                                                  of_transfer.X);
    }
    internal::for_each_member(
      ReverseMemberTransfer{old_mesh, remesh, before.X, dies, states, there.X, dies_bar},
      before,
      of_transfer,
      there);
    for (std::size_t k = 0; k < X_bar.size(); ++k)
      there.X[k] += X_bar[k];
    for (std::size_t k = 0; k < std::min(T_bar.size(), there.temperature.size()); ++k)
      there.temperature[k] += T_bar[k];
    return there;
  }
} // namespace retroforge
