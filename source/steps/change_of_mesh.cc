// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/steps/change_of_mesh.h>
#include <retroforge/transfer/cell_transfer.h>

namespace retroforge
{
  template <typename Number>
  void MemberTransfer<Number>::operator()(const NodalVectors<Number> &positions,
                                          NodalVectors<Number>       &to) const
  {
    to = remesh.positions.positions<Number>({old_mesh, remesh.mesh, dies, states}, positions);
  }

  template <typename Number>
  void MemberTransfer<Number>::operator()(const NodeField<Number> &q, NodeField<Number> &to) const
  {
    to = q;
    if (!q.empty())
      to = remesh.transfer.apply_bounded<Number>(q);
  }

  template <typename Number>
  void MemberTransfer<Number>::operator()(const NodeVectorField<3, Number> &v,
                                          NodeVectorField<3, Number>       &to) const
  {
    to = v;
    if (!v.empty())
      to = remesh.transfer.apply<Vector3<Number>>(v);
  }

  template <typename Number>
  void MemberTransfer<Number>::operator()(const CellField<Number> &q, CellField<Number> &to) const
  {
    to = q;
    if (!q.empty())
      to = transfer_cells<Number>(old_mesh, X, remesh.transfer, remesh.mesh, q);
  }

  template <typename Number>
  void MemberTransfer<Number>::operator()(const BoundedCellField<Number> &q,
                                          BoundedCellField<Number>       &to) const
  {
    to = q;
    if (!q.empty())
      to = transfer_cells<Number>(old_mesh, X, remesh.transfer, remesh.mesh, q, CellRange::bounded);
  }

  template struct MemberTransfer<double>;
  template struct MemberTransfer<Dual>;

  void ReverseMemberTransfer::operator()(const NodalVectors<double> &positions,
                                         const NodalVectors<double> &q_bar,
                                         NodalVectors<double>       &to) const
  {
    to.resize(positions.size());
    remesh.positions.reverse_positions({old_mesh, remesh.mesh, dies, states}, positions, q_bar, to, dies_bar);
  }

  void ReverseMemberTransfer::operator()(const NodeField<double> &q,
                                         const NodeField<double> &q_bar,
                                         NodeField<double>       &to) const
  {
    to = q_bar;
    if (!q_bar.empty())
      to = remesh.transfer.reverse_apply_bounded(q, q_bar);
  }

  void ReverseMemberTransfer::operator()(const NodeVectorField<3, double> &,
                                         const NodeVectorField<3, double> &v_bar,
                                         NodeVectorField<3, double>       &to) const
  {
    to = remesh.transfer.apply_transpose<Vec3>(v_bar);
  }

  void ReverseMemberTransfer::operator()(const CellField<double> &q,
                                         const CellField<double> &q_bar,
                                         CellField<double>       &to) const
  {
    to.assign(q_bar.empty() ? 0 : old_mesh.n_cells(), 0.);
    if (!is_zero(q_bar))
      reverse_transfer_cells(old_mesh, X, remesh.transfer, remesh.mesh, q, q_bar, to, X_bar);
  }

  void ReverseMemberTransfer::operator()(const BoundedCellField<double> &q,
                                         const BoundedCellField<double> &q_bar,
                                         BoundedCellField<double>       &to) const
  {
    to.assign(q_bar.empty() ? 0 : old_mesh.n_cells(), 0.);
    if (!is_zero(q_bar))
      reverse_transfer_cells(
        old_mesh, X, remesh.transfer, remesh.mesh, q, q_bar, to, X_bar, CellRange::bounded);
  }
} // namespace retroforge
