// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/dual.h>
#include <retroforge/transfer/moving_transfer.h>

#include <algorithm>

namespace retroforge
{
  MovingTransfer::MovingTransfer(const TetMesh              &old_mesh,
                                 const NodalVectors<double> &X_old,
                                 const TetMesh              &new_mesh,
                                 const TransferOperator     &J)
      : old_mesh_(old_mesh)
      , new_mesh_(new_mesh)
      , X_old_(X_old)
      , J_(J)
      , patches_(patches_at_nodes(new_mesh))
      , gradient_(old_mesh, X_old)
      , finder_(old_mesh, X_old, gradient_, Interpolation::half_gradient)
      , sources_(J.n_new())
  {
    AssertDimension(J.n_old, X_old.size());
    AssertDimension(J.n_new(), new_mesh.n_nodes());
  }

  // Of one entry: it is 1 wherever nodes are.
  bool MovingTransfer::is_kept(const NodeIndex k) const
  {
    return J_.begin[k + 1] == J_.begin[k] + 1;
  }

  const RowSource &MovingTransfer::source(const NodeIndex k)
  {
    if (!sources_[k])
      sources_[k] = finder_.find(new_mesh_.X[k], patches_[k]);
    return *sources_[k];
  }

  template <typename Number>
  BasicTransfer<Number> MovingTransfer::at(const NodalVectors<Number> &X_old,
                                           const NodalVectors<Number> &X_new)
  {
    AssertDimension(X_old.size(), J_.n_old);
    AssertDimension(X_new.size(), J_.n_new());
    RecoveredGradient<Number> gradient(old_mesh_, X_old);
    BasicTransfer<Number>     moved;
    moved.n_old = J_.n_old;
    for (NodeIndex k = 0; k < J_.n_new(); ++k)
      if (is_kept(k))
        append<Number>({{J_.node[J_.begin[k]], Number(1.)}}, moved);
      else
        append(row_from(source(k), projected_weights(source(k), X_new[k], X_old), X_old, gradient), moved);
    return moved;
  }

  void MovingTransfer::reverse(const std::vector<double> &weight_bar,
                               NodalVectors<double>      &X_old_bar,
                               NodalVectors<double>      &X_new_bar)
  {
    AssertDimension(weight_bar.size(), J_.weight.size());
    for (NodeIndex k = 0; k < J_.n_new(); ++k)
    {
      const unsigned int first = J_.begin[k], last = J_.begin[k + 1];
      if (is_kept(k) ||
          std::all_of(&weight_bar[first], &weight_bar[last], [](const double bar) { return bar == 0.; }))
        continue;
      const auto bar = [&](const NodeIndex node) {
        const auto begin = J_.node.begin() + first, end = J_.node.begin() + last,
                   found = std::lower_bound(begin, end, node);
        return found == end || *found != node ? 0. : weight_bar[found - J_.node.begin()];
      };
      const RowSource    &row = source(k);
      const auto          l   = projected_weights(row, new_mesh_.X[k], X_old_);
      std::vector<double> l_bar(l.size(), 0.);
      reverse_row(row, l, X_old_, gradient_, bar, l_bar, X_old_bar);
      reverse_projected_weights(row, new_mesh_.X[k], X_old_, l_bar, X_new_bar[k], X_old_bar);
    }
  }

  template TransferOperator    MovingTransfer::at(const NodalVectors<double> &, const NodalVectors<double> &);
  template BasicTransfer<Dual> MovingTransfer::at(const NodalVectors<Dual> &, const NodalVectors<Dual> &);
} // namespace retroforge
