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

  /// Where a change of mesh leads from and to.
  template <typename Number>
  struct MeshChange
  {
    const TetMesh               &old_mesh;
    const NodalVectors<Number>  &X;
    const BasicTransfer<Number> &J;
    const TetMesh               &new_mesh;
    const NodalVectors<Number>  &X_new;
  };

  /// Takes a field of one value per cell that is not negative, such as the accumulated strain, to a new mesh. Kept cells
  /// keep their values to the bit. The others get theirs from the cells that they replace, by way of the nodes,
  ///   q' = lambda C (J L q)+,   L q = S (q + R q + R R q),   R q = q - C S q,
  /// S the lumped projection of these cells to their nodes, C the mean of the nodes of a cell. C S smooths, and L gives most of
  /// what it took back; beside a steep flank that could be negative, and is 0 then. lambda makes the mean over the new cells
  /// that over those replaced: else each change takes from a peak what lies beside it does not get. Constants pass unchanged.
  /// Without S over the replaced cells alone, L and lambda a hub of 22 changes of mesh lost 5 % of its mean strain and half
  /// of its variance.
  /// @param q_T  one value per old cell
  template <typename Number>
  std::vector<Number> transfer_cells(const MeshChange<Number> &change, const std::vector<Number> &q_T);

  /// Adds the pull-back of q_bar, one value per new cell, through transfer_cells to the derivatives in all that it is a
  /// function of.
  /// @param weight_bar  derivatives in the weights of J
  void reverse_transfer_cells(const MeshChange<double>  &change,
                              const std::vector<double> &q_T,
                              const std::vector<double> &q_bar,
                              std::vector<double>       &q_T_bar,
                              NodalVectors<double>      &X_bar,
                              std::vector<double>       &weight_bar,
                              NodalVectors<double>      &X_new_bar);
} // namespace retroforge
