// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/dual.h>
#include <retroforge/transfer/cell_to_node.h>
#include <retroforge/transfer/cell_transfer.h>

#include <algorithm>
#include <utility>

namespace retroforge
{
  namespace
  {
    using Corners = std::array<NodeIndex, 4>;

    // The old node of each new one, where J has a row of the identity.
    template <typename Number>
    std::vector<NodeIndex> kept_nodes(const BasicTransfer<Number> &J)
    {
      std::vector<NodeIndex> old_node(J.n_new(), invalid_index);
      for (NodeIndex k = 0; k < J.n_new(); ++k)
        if (const unsigned int entry = J.begin[k];
            J.begin[k + 1] == entry + 1 && value_of(J.weight[entry]) == 1.)
          old_node[k] = J.node[entry];
      return old_node;
    }

    Corners sorted(Corners nodes)
    {
      std::sort(nodes.begin(), nodes.end());
      return nodes;
    }
  } // namespace

  template <typename Number>
  std::vector<CellIndex>
  kept_cells(const TetMesh &old_mesh, const BasicTransfer<Number> &J, const TetMesh &new_mesh)
  {
    AssertDimension(J.n_old, old_mesh.n_nodes());
    AssertDimension(J.n_new(), new_mesh.n_nodes());
    std::vector<std::pair<Corners, CellIndex>> old_cells;
    old_cells.reserve(old_mesh.n_cells());
    for (CellIndex c = 0; c < old_mesh.n_cells(); ++c)
      old_cells.emplace_back(sorted(old_mesh.cells[c]), c);
    std::sort(old_cells.begin(), old_cells.end());

    const auto             old_node = kept_nodes(J);
    std::vector<CellIndex> old_cell(new_mesh.n_cells(), invalid_index);
    for (CellIndex c = 0; c < new_mesh.n_cells(); ++c)
    {
      Corners nodes = new_mesh.cells[c];
      for (NodeIndex &node : nodes)
        node = old_node[node];
      nodes = sorted(nodes);
      const auto found =
        std::lower_bound(old_cells.begin(), old_cells.end(), std::make_pair(nodes, CellIndex(0)));
      if (found != old_cells.end() && found->first == nodes)
        old_cell[c] = found->second;
    }
    return old_cell;
  }

  namespace
  {
    /// Kept cells count by so much of their volume at a node, so that they do where it has no others.
    constexpr double weight_of_kept = 1e-9;

    /// Cells of one mesh that a change replaces, or that it makes.
    template <typename Number>
    struct ChangedCells
    {
      std::vector<bool>   changed;
      std::vector<Number> volumes; ///< of all cells

      /// Sum of the volumes, and of the values by them.
      std::pair<Number, Number> sums(const std::vector<Number> &q) const
      {
        Number volume(0.), sum(0.);
        for (CellIndex c = 0; c < volumes.size(); ++c)
          if (changed[c])
          {
            volume += volumes[c];
            sum += volumes[c] * q[c];
          }
        return {volume, sum};
      }

      std::vector<Number> weights() const
      {
        std::vector<Number> weights = volumes;
        for (CellIndex c = 0; c < volumes.size(); ++c)
          if (!changed[c])
            weights[c] *= weight_of_kept;
        return weights;
      }
    };

    /// S is applied to q, and as often again to what C S has taken.
    constexpr unsigned int n_lifts = 3;

    /// L q at the nodes, and how it came about.
    template <typename Number>
    struct Lifted
    {
      std::vector<std::vector<Number>> rests;  ///< R^i q
      std::vector<Number>              values; ///< L q
    };

    template <typename Number>
    Lifted<Number> lift(const TetMesh &mesh, const std::vector<Number> &weights, const std::vector<Number> &q)
    {
      Lifted<Number> lifted{{q}, std::vector<Number>(mesh.n_nodes(), Number(0.))};
      while (true)
      {
        std::vector<Number> rest   = lifted.rests.back();
        const auto          smooth = cell_to_node(mesh, weights, rest);
        for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
          lifted.values[k] += smooth[k];
        if (lifted.rests.size() == n_lifts)
          return lifted;
        const auto back = node_to_cell(mesh, smooth);
        for (CellIndex c = 0; c < q.size(); ++c)
          rest[c] -= back[c];
        lifted.rests.push_back(std::move(rest));
      }
    }

    void reverse_lift(const TetMesh             &mesh,
                      const std::vector<double> &weights,
                      const Lifted<double>      &lifted,
                      const std::vector<double> &values_bar,
                      std::vector<double>       &q_bar,
                      std::vector<double>       &weights_bar)
    {
      std::vector<double> rest_bar(mesh.n_cells(), 0.);
      for (unsigned int i = n_lifts; i-- > 0;)
      {
        std::vector<double> taken_bar(mesh.n_nodes(), 0.), smooth_bar = values_bar;
        reverse_node_to_cell(mesh, rest_bar, taken_bar);
        for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
          smooth_bar[k] -= taken_bar[k];
        reverse_cell_to_node(mesh, weights, lifted.rests[i], smooth_bar, rest_bar, weights_bar);
      }
      for (CellIndex c = 0; c < mesh.n_cells(); ++c)
        q_bar[c] += rest_bar[c];
    }

    /// What transfer_cells goes by.
    template <typename Number>
    struct CellPassage
    {
      std::vector<CellIndex> old_cell;
      ChangedCells<Number>   replaced, made;
      std::vector<Number>    weights;
      Lifted<Number>         lifted;
      std::vector<Number>    q; ///< C (J L q)+
      Number                 lambda;

      CellPassage(const MeshChange<Number> &change, const std::vector<Number> &q_T)
          : old_cell(kept_cells(change.old_mesh, change.J, change.new_mesh))
          , replaced{std::vector<bool>(q_T.size(), true), cell_volumes(change.old_mesh, change.X)}
          , made{{}, cell_volumes(change.new_mesh, change.X_new)}
          , lambda(1.)
      {
        AssertDimension(q_T.size(), change.old_mesh.n_cells());
        for (const CellIndex c : old_cell)
        {
          made.changed.push_back(c == invalid_index);
          if (c != invalid_index)
            replaced.changed[c] = false;
        }
        weights      = replaced.weights();
        lifted       = lift(change.old_mesh, weights, q_T);
        auto at_node = change.J.apply(lifted.values);
        for (Number &value : at_node)
          if (value_of(value) < 0.)
            value = Number(0.);
        q                                = node_to_cell(change.new_mesh, at_node);
        const auto [volume, sum]         = replaced.sums(q_T);
        const auto [new_volume, new_sum] = made.sums(q);
        if (value_of(sum) > 0. && value_of(new_sum) > 0.)
          lambda = sum / volume * new_volume / new_sum;
      }
    };
  } // namespace

  template <typename Number>
  std::vector<Number> transfer_cells(const MeshChange<Number> &change, const std::vector<Number> &q_T)
  {
    const CellPassage<Number> passage(change, q_T);
    std::vector<Number>       q = passage.q;
    for (CellIndex c = 0; c < q.size(); ++c)
      if (passage.made.changed[c])
        q[c] *= passage.lambda;
      else
        q[c] = q_T[passage.old_cell[c]];
    return q;
  }

  void reverse_transfer_cells(const MeshChange<double>  &change,
                              const std::vector<double> &q_T,
                              const std::vector<double> &q_bar,
                              std::vector<double>       &q_T_bar,
                              NodalVectors<double>      &X_bar,
                              std::vector<double>       &weight_bar,
                              NodalVectors<double>      &X_new_bar)
  {
    AssertDimension(q_bar.size(), change.new_mesh.n_cells());
    const CellPassage<double> passage(change, q_T);
    std::vector<double> made_bar(q_bar.size(), 0.), volumes_bar(q_T.size(), 0.), new_volumes_bar = made_bar;
    double              lambda_bar = 0.;
    for (CellIndex c = 0; c < q_bar.size(); ++c)
      if (passage.made.changed[c])
      {
        made_bar[c] = passage.lambda * q_bar[c];
        lambda_bar += passage.q[c] * q_bar[c];
      }
      else
        q_T_bar[passage.old_cell[c]] += q_bar[c];

    const auto [volume, sum]         = passage.replaced.sums(q_T);
    const auto [new_volume, new_sum] = passage.made.sums(passage.q);
    if (sum > 0. && new_sum > 0.)
    {
      const double log_bar = lambda_bar * passage.lambda; // in the logarithm of lambda
      for (CellIndex c = 0; c < q_T.size(); ++c)
        if (passage.replaced.changed[c])
        {
          q_T_bar[c] += log_bar * passage.replaced.volumes[c] / sum;
          volumes_bar[c] += log_bar * (q_T[c] / sum - 1. / volume);
        }
      for (CellIndex c = 0; c < q_bar.size(); ++c)
        if (passage.made.changed[c])
        {
          made_bar[c] -= log_bar * passage.made.volumes[c] / new_sum;
          new_volumes_bar[c] = log_bar * (1. / new_volume - passage.q[c] / new_sum);
        }
    }

    std::vector<double> at_node(change.new_mesh.n_nodes(), 0.), weights_bar(q_T.size(), 0.);
    reverse_node_to_cell(change.new_mesh, made_bar, at_node);
    const auto free = change.J.apply(passage.lifted.values);
    for (NodeIndex k = 0; k < at_node.size(); ++k)
      if (free[k] < 0.)
        at_node[k] = 0.;
    const auto lifted_bar = change.J.apply_transpose(at_node);
    change.J.add_weight_bar(passage.lifted.values, at_node, weight_bar);
    reverse_lift(change.old_mesh, passage.weights, passage.lifted, lifted_bar, q_T_bar, weights_bar);
    for (CellIndex c = 0; c < q_T.size(); ++c)
      volumes_bar[c] += (passage.replaced.changed[c] ? 1. : weight_of_kept) * weights_bar[c];
    reverse_cell_volumes(change.old_mesh, change.X, volumes_bar, X_bar);
    reverse_cell_volumes(change.new_mesh, change.X_new, new_volumes_bar, X_new_bar);
  }

#define RETROFORGE_INSTANTIATE(Number)                                \
  template std::vector<CellIndex> kept_cells(                         \
    const TetMesh &, const BasicTransfer<Number> &, const TetMesh &); \
  template std::vector<Number> transfer_cells(const MeshChange<Number> &, const std::vector<Number> &);
  RETROFORGE_INSTANTIATE(double)
  RETROFORGE_INSTANTIATE(Dual)
#undef RETROFORGE_INSTANTIATE
} // namespace retroforge
