// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/steps/change_of_mesh.h>
#include <retroforge/transfer/cell_transfer.h>

namespace retroforge
{
  namespace
  {
    /// How each kind of member reaches the new mesh.
    template <typename Number>
    struct Transferred
    {
      const TetMesh              &old_mesh;
      const RemeshRecord         &remesh;
      const NodalVectors<Number> &X; ///< on the old mesh

      void operator()(const NodalVectors<Number> &positions, NodalVectors<Number> &to) const
      {
        to = remesh.transfer.positions(positions);
      }

      void operator()(const NodeField<Number> &q, NodeField<Number> &to) const
      {
        to = remesh.transfer.apply<Number>(q);
      }

      void operator()(const CellField<Number> &q, CellField<Number> &to) const
      {
        to = transfer_cells<Number>(old_mesh, X, remesh.transfer, remesh.mesh, q);
      }
    };

    /// The reverse of each of them. Cells add to the positions by whose volumes they were weighed.
    struct Reversed
    {
      const TetMesh              &old_mesh;
      const RemeshRecord         &remesh;
      const NodalVectors<double> &X;     ///< on the old mesh
      NodalVectors<double>       &X_bar; ///< there

      void operator()(const NodalVectors<double> &,
                      const NodalVectors<double> &positions_bar,
                      NodalVectors<double>       &to) const
      {
        to = remesh.transfer.apply_transpose(positions_bar);
      }

      void operator()(const NodeField<double> &, const NodeField<double> &q_bar, NodeField<double> &to) const
      {
        to = remesh.transfer.apply_transpose<double>(q_bar);
      }

      void operator()(const CellField<double> &q, const CellField<double> &q_bar, CellField<double> &to) const
      {
        to.assign(old_mesh.n_cells(), 0.);
        if (!is_zero(q_bar))
          reverse_transfer_cells(old_mesh, X, remesh.transfer, remesh.mesh, q, q_bar, to, X_bar);
      }
    };
  } // namespace

  template <typename Number>
  WorkpieceState<3, Number>
  change_mesh(const TetMesh &old_mesh, const RemeshRecord &remesh, const WorkpieceState<3, Number> &before)
  {
    AssertDimension(remesh.transfer.n_old, old_mesh.n_nodes());
    AssertDimension(remesh.transfer.n_new(), remesh.mesh.n_nodes());
    AssertDimension(before.X.size(), old_mesh.n_nodes());
    WorkpieceState<3, Number> after;
    internal::for_each_member(Transferred<Number>{old_mesh, remesh, before.X}, before, after);
    return after;
  }

  template WorkpieceState<3, double>
  change_mesh(const TetMesh &, const RemeshRecord &, const WorkpieceState<3, double> &);
  template WorkpieceState<3, Dual>
  change_mesh(const TetMesh &, const RemeshRecord &, const WorkpieceState<3, Dual> &);

  WorkpieceState<3, double> reverse_change_mesh(const TetMesh                   &old_mesh,
                                                const RemeshRecord              &remesh,
                                                const WorkpieceState<3, double> &before,
                                                const WorkpieceState<3, double> &costate)
  {
    AssertDimension(before.X.size(), old_mesh.n_nodes());
    AssertDimension(costate.X.size(), remesh.mesh.n_nodes());
    WorkpieceState<3, double> costate_before;
    internal::for_each_member(
      Reversed{old_mesh, remesh, before.X, costate_before.X}, before, costate, costate_before);
    return costate_before;
  }
} // namespace retroforge
