// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/transfer/transfer.h>

namespace retroforge
{
  /// For each cell of the new mesh the cell of the old one with the same four nodes, or invalid_index. Nodes
  /// are the same where J has a row of the identity, so that nothing but J need be recorded.
  template <typename Number>
  std::vector<CellIndex>
  kept_cells(const TetMesh &old_mesh, const BasicTransfer<Number> &J, const TetMesh &new_mesh);

  /// Whether values at nodes stay within the range of those that a row of J takes.
  enum class CellRange
  {
    free,
    bounded
  };

  /// Takes a field of one value per cell, such as the accumulated strain, to a new mesh: kept cells keep
  /// their values to the bit; the others get theirs through the nodes,
  ///   node_to_cell( J cell_to_node(q_T) ),
  /// so that only what was remeshed is smoothed. Constants pass unchanged. Linear in q_T but where it is bounded: no
  /// value then leaves the range of those around; and of X it depends on the volumes by which cell_to_node() weighs.
  /// @param X    positions on the old mesh
  /// @param q_T  one value per old cell
  template <typename Number>
  std::vector<Number> transfer_cells(const TetMesh               &old_mesh,
                                     const NodalVectors<Number>  &X,
                                     const BasicTransfer<Number> &J,
                                     const TetMesh               &new_mesh,
                                     const std::vector<Number>   &q_T,
                                     CellRange                    range = CellRange::free);

  /// Adds the pull-back of q_bar, one value per new cell, through transfer_cells to q_T_bar, X_bar and weight_bar.
  /// @param weight_bar  derivatives in the weights of J
  void reverse_transfer_cells(const TetMesh              &old_mesh,
                              const NodalVectors<double> &X,
                              const TransferOperator     &J,
                              const TetMesh              &new_mesh,
                              const std::vector<double>  &q_T,
                              std::vector<double>         q_bar,
                              std::vector<double>        &q_T_bar,
                              NodalVectors<double>       &X_bar,
                              std::vector<double>        &weight_bar,
                              CellRange                   range = CellRange::free);
} // namespace retroforge
