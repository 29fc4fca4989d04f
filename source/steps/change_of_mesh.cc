// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/steps/change_of_mesh.h>
#include <retroforge/transfer/cell_transfer.h>

namespace retroforge
{
  namespace
  {
    /// The entries of a row of J with the least and the largest value, between which the new value stays: weights
    /// of J may be negative, and a temperature out of the range of those around would be none.
    template <typename Number>
    std::pair<NodeIndex, NodeIndex>
    extremes(const TransferOperator &J, const unsigned int k, const std::vector<Number> &q)
    {
      NodeIndex least = J.node[J.begin[k]], largest = least;
      for (unsigned int i = J.begin[k]; i < J.begin[k + 1]; ++i)
      {
        if (value_of(q[J.node[i]]) < value_of(q[least]))
          least = J.node[i];
        if (value_of(q[J.node[i]]) > value_of(q[largest]))
          largest = J.node[i];
      }
      return {least, largest};
    }
  } // namespace

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
    if (q.empty())
      return;
    to = remesh.transfer.apply<Number>(q);
    for (unsigned int k = 0; k < to.size(); ++k)
    {
      const auto [least, largest] = extremes(remesh.transfer, k, q);
      if (value_of(to[k]) < value_of(q[least]))
        to[k] = q[least];
      else if (value_of(to[k]) > value_of(q[largest]))
        to[k] = q[largest];
    }
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
    if (q_bar.empty())
      return;
    const TransferOperator   &J         = remesh.transfer;
    const std::vector<double> unbounded = J.apply<double>(q);
    std::vector<double>       mapped    = q_bar;
    std::vector<double>       bounded(old_mesh.n_nodes(), 0.);
    for (unsigned int k = 0; k < mapped.size(); ++k)
    {
      const auto [least, largest] = extremes(J, k, q);
      if (unbounded[k] < q[least])
        bounded[least] += std::exchange(mapped[k], 0.);
      else if (unbounded[k] > q[largest])
        bounded[largest] += std::exchange(mapped[k], 0.);
    }
    to = J.apply_transpose<double>(mapped);
    for (std::size_t i = 0; i < to.size(); ++i)
      to[i] += bounded[i];
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
} // namespace retroforge
