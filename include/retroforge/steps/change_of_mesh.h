// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/record/increment_record.h>
#include <retroforge/steps/following_mesh.h>
#include <retroforge/steps/kept_heat.h>
#include <retroforge/steps/workpiece_state.h>
#include <retroforge/transfer/cell_transfer.h>
#include <retroforge/transfer/moving_transfer.h>

/// @file
/// The step that takes the workpiece from one mesh to the next. What happens to a member of the state follows
/// from its kind: positions by the tape of what remeshing did to them (PositionTape), one number or vector per
/// node q' = J q, numbers within the range of the values that a row of J takes, one number per cell transfer_cells(). The weights of J follow positions (MovingTransfer). Where the new mesh follows the shape
/// (FollowingMesh), nodes and what they carry are then moved. Temperatures are at last corrected so that heat is kept
/// (steps/kept_heat.h).
namespace retroforge
{
  /// Returns the positions on the new mesh: of a state, its first member.
  template <typename Number>
  NodalVectors<Number> moved_positions(const TetMesh                       &old_mesh,
                                       const RemeshRecord                  &remesh,
                                       const NodalVectors<Number>          &X,
                                       const std::vector<Die>              &dies,
                                       const std::vector<DieState<Number>> &states)
  {
    return remesh.positions.positions<Number>({old_mesh, remesh.mesh, dies, states}, X);
  }

  /// Returns J with the weights that it has at these positions; where they are those that it was made at, J itself.
  template <typename Number>
  BasicTransfer<Number> moved_transfer(const TetMesh              &old_mesh,
                                       const RemeshRecord         &remesh,
                                       const NodalVectors<Number> &X_old,
                                       const NodalVectors<Number> &X_new);

  /// Takes a member of the state to the new mesh, each kind by its overload; on dual numbers its tangent.
  template <typename Number>
  struct MemberTransfer
  {
    const TetMesh               &old_mesh, &new_mesh;
    const NodalVectors<Number>  &X_old, &X_new;
    const BasicTransfer<Number> &J; ///< at these positions

    void operator()(const NodalVectors<Number> &positions, NodalVectors<Number> &to) const;
    void operator()(const NodeField<Number> &q, NodeField<Number> &to) const;
    void operator()(const NodeSkins<Number> &skins, NodeSkins<Number> &to) const;
    void operator()(const NodeVectorField<3, Number> &v, NodeVectorField<3, Number> &to) const;
    void operator()(const CellField<Number> &q, CellField<Number> &to) const;
  };

  /// Moves a member of the state with the nodes of a mesh that follows the shape, but for the positions themselves.
  template <typename Number>
  struct MemberMotion
  {
    const FollowingMesh        &mesh;
    const NodalVectors<Number> &w; ///< motion of the nodes [mm]

    void operator()(NodalVectors<Number> &) const {}
    void operator()(NodeField<Number> &q) const { mesh.move_nodes(w, q); }
    void operator()(NodeSkins<Number> &skins) const;
    void operator()(NodeVectorField<3, Number> &v) const { mesh.move_nodes(w, v); }
    void operator()(CellField<Number> &q) const { mesh.move_cells(w, q); }
  };

  /// The reverse of it: derivatives in w, where that is 0. Those in the member stay what they are.
  struct ReverseMemberMotion
  {
    const FollowingMesh  &mesh;
    NodalVectors<double> &w_bar;

    void operator()(const NodalVectors<double> &, const NodalVectors<double> &) const {}
    void operator()(const NodeField<double> &q, const NodeField<double> &q_bar) const
    {
      mesh.reverse_nodes(q, q_bar, w_bar);
    }
    void operator()(const NodeSkins<double> &skins, const NodeSkins<double> &skins_bar) const;
    void operator()(const NodeVectorField<3, double> &v, const NodeVectorField<3, double> &v_bar) const
    {
      mesh.reverse_nodes(v, v_bar, w_bar);
    }
    void operator()(const CellField<double> &q, const CellField<double> &q_bar) const
    {
      mesh.reverse_cells(q, q_bar, w_bar);
    }
  };

  /// The reverse of MemberTransfer: from a member of the costate on the new mesh to that on the old one. Positions come
  /// before cells, which add to them by way of the volumes that they were weighed with, and are complete after
  /// reverse_positions().
  class ReverseMemberTransfer
  {
  public:
    /// Keeps references to its arguments.
    /// @param X          on the old mesh
    /// @param moving     of this change of mesh
    /// @param X_old_bar  the costate's positions on the old mesh
    ReverseMemberTransfer(const TetMesh              &old_mesh,
                          const RemeshRecord         &remesh,
                          const NodalVectors<double> &X,
                          MovingTransfer             &moving,
                          NodalVectors<double>       &X_old_bar);

    /// @param q      the member on the old mesh
    /// @param q_bar  its costate on the new mesh
    void
    operator()(const NodalVectors<double> &q, const NodalVectors<double> &q_bar, NodalVectors<double> &to);
    void operator()(const NodeField<double> &q, const NodeField<double> &q_bar, NodeField<double> &to);
    void
    operator()(const NodeSkins<double> &skins, const NodeSkins<double> &skins_bar, NodeSkins<double> &to);
    void operator()(const NodeVectorField<3, double> &v,
                    const NodeVectorField<3, double> &v_bar,
                    NodeVectorField<3, double>       &to);
    void operator()(const CellField<double> &q, const CellField<double> &q_bar, CellField<double> &to);

    /// After all members: what they took from positions, by the weights and by the new positions themselves.
    /// @param dies_bar  gets the derivatives in the dies added
    void reverse_positions(const std::vector<Die>              &dies,
                           const std::vector<DieState<double>> &states,
                           std::vector<DieState<double>>       &dies_bar);

  private:
    const TetMesh              &old_mesh_;
    const RemeshRecord         &remesh_;
    const NodalVectors<double> &X_;
    MovingTransfer             &moving_;
    NodalVectors<double>       &X_old_bar_;
    NodalVectors<double>        X_new_bar_;
    std::vector<double>         weight_bar_;
  };

  /// Returns the state on the new mesh; on dual numbers its tangent.
  /// @param following  the new mesh, where it follows the shape; null: it goes where the operations take it
  template <typename Number>
  WorkpieceState<3, Number> change_mesh(const TetMesh                       &old_mesh,
                                        const RemeshRecord                  &remesh,
                                        const WorkpieceState<3, Number>     &before,
                                        const std::vector<Die>              &dies,
                                        const std::vector<DieState<Number>> &states,
                                        const FollowingMesh                 *following = nullptr)
  {
    AssertDimension(remesh.transfer.n_old, old_mesh.n_nodes());
    AssertDimension(remesh.transfer.n_new(), remesh.mesh.n_nodes());
    AssertDimension(before.X.size(), old_mesh.n_nodes());
    const auto                X_new = moved_positions(old_mesh, remesh, before.X, dies, states);
    const auto                J     = moved_transfer(old_mesh, remesh, before.X, X_new);
    WorkpieceState<3, Number> after;
    internal::for_each_member(
      MemberTransfer<Number>{old_mesh, remesh.mesh, before.X, X_new, J}, before, after);
    if (following != nullptr)
    {
      after.X                = following->positions(X_new);
      NodalVectors<Number> w = after.X;
      for (std::size_t k = 0; k < w.size(); ++k)
        w[k] -= X_new[k];
      internal::for_each_member(MemberMotion<Number>{*following, w}, after);
    }
    if (!before.temperature.empty())
      after.temperature = keep_heat<Number>({old_mesh, before.X, before.temperature},
                                            {remesh.mesh, after.X, after.temperature});
    return after;
  }

  /// Returns the costate on the old mesh of one on the new mesh: the reverse of change_mesh().
  /// @param before    the state on the old mesh, where it was remeshed
  /// @param moving    of this change of mesh
  /// @param dies_bar  gets the derivatives in the dies added
  /// @param following  as there
  WorkpieceState<3, double> reverse_change_mesh(const TetMesh                       &old_mesh,
                                                const RemeshRecord                  &remesh,
                                                const WorkpieceState<3, double>     &before,
                                                const std::vector<Die>              &dies,
                                                const std::vector<DieState<double>> &states,
                                                const WorkpieceState<3, double>     &costate,
                                                MovingTransfer                      &moving,
                                                std::vector<DieState<double>>       &dies_bar,
                                                const FollowingMesh                 *following = nullptr);
} // namespace retroforge
