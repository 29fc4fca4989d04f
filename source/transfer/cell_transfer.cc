// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/dual.h>
#include <retroforge/transfer/cell_to_node.h>
#include <retroforge/transfer/cell_transfer.h>

#include <algorithm>

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

  template <typename Number>
  std::vector<Number> transfer_cells(const TetMesh               &old_mesh,
                                     const NodalVectors<Number>  &X,
                                     const BasicTransfer<Number> &J,
                                     const TetMesh               &new_mesh,
                                     const std::vector<Number>   &q_T,
                                     const CellRange              range)
  {
    const auto          at_node = cell_to_node(old_mesh, X, q_T);
    std::vector<Number> q =
      node_to_cell(new_mesh, range == CellRange::bounded ? J.apply_bounded(at_node) : J.apply(at_node));
    const auto old_cell = kept_cells(old_mesh, J, new_mesh);
    for (CellIndex c = 0; c < new_mesh.n_cells(); ++c)
      if (old_cell[c] != invalid_index)
        q[c] = q_T[old_cell[c]];
    return q;
  }

  void reverse_transfer_cells(const TetMesh              &old_mesh,
                              const NodalVectors<double> &X,
                              const TransferOperator     &J,
                              const TetMesh              &new_mesh,
                              const std::vector<double>  &q_T,
                              std::vector<double>         q_bar,
                              std::vector<double>        &q_T_bar,
                              NodalVectors<double>       &X_bar,
                              std::vector<double>        &weight_bar,
                              const CellRange             range)
  {
    AssertDimension(q_bar.size(), new_mesh.n_cells());
    const auto old_cell = kept_cells(old_mesh, J, new_mesh);
    for (CellIndex c = 0; c < new_mesh.n_cells(); ++c)
      if (old_cell[c] != invalid_index)
      {
        q_T_bar[old_cell[c]] += q_bar[c];
        q_bar[c] = 0.;
      }
    std::vector<double> at_node(new_mesh.n_nodes(), 0.);
    reverse_node_to_cell(new_mesh, q_bar, at_node);
    const auto lifted = cell_to_node(old_mesh, X, q_T);
    const auto old_bar =
      range == CellRange::bounded ? J.reverse_apply_bounded(lifted, at_node) : J.apply_transpose(at_node);
    J.add_weight_bar(lifted, at_node, weight_bar);
    reverse_cell_to_node(old_mesh, X, q_T, old_bar, q_T_bar, X_bar);
  }

#define RETROFORGE_INSTANTIATE(Number)                                       \
  template std::vector<CellIndex> kept_cells(                                \
    const TetMesh &, const BasicTransfer<Number> &, const TetMesh &);        \
  template std::vector<Number> transfer_cells(const TetMesh &,               \
                                              const NodalVectors<Number> &,  \
                                              const BasicTransfer<Number> &, \
                                              const TetMesh &,               \
                                              const std::vector<Number> &,   \
                                              CellRange);
  RETROFORGE_INSTANTIATE(double)
  RETROFORGE_INSTANTIATE(Dual)
#undef RETROFORGE_INSTANTIATE
} // namespace retroforge
