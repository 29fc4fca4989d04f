// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/tet_mesh.h>

#include <vector>

namespace retroforge
{
  /// Returns |T| of each cell.
  template <typename Number>
  std::vector<Number> cell_volumes(const TetMesh &mesh, const NodalVectors<Number> &X);

  /// Adds to X_bar the pull-back of volumes_bar, one per cell, through cell_volumes.
  void reverse_cell_volumes(const TetMesh              &mesh,
                            const NodalVectors<double> &X,
                            const std::vector<double>  &volumes_bar,
                            NodalVectors<double>       &X_bar);

  /// Lifts a cell field to the nodes by the lumped L2 projection
  ///   q_k = sum_T |T| q_T / sum_T |T|    over the cells at node k.  @cite Laroussi2003, Eq. (58)
  /// It keeps the integral: with the lumped mass  m_k = sum_T |T|/4,  sum_k m_k q_k = sum_T |T| q_T.  Values
  /// stay within the range of the cells'. What it costs is smoothing over the cells at a node, so a history
  /// is lifted when the mesh changes and not in every increment.
  /// @param volumes  |T| of each cell, or other positive weights; each node needs a cell
  /// @param q_T      one value per cell
  template <typename Number>
  std::vector<Number>
  cell_to_node(const TetMesh &mesh, const std::vector<Number> &volumes, const std::vector<Number> &q_T);

  /// Adds the pull-back of q_k_bar through cell_to_node to q_T_bar and volumes_bar:
  ///   q_T_bar += |T| sum_k q_k_bar / M_k,   |T|_bar += sum_k q_k_bar (q_T - q_k) / M_k,   M_k = sum_T |T|.
  void reverse_cell_to_node(const TetMesh             &mesh,
                            const std::vector<double> &volumes,
                            const std::vector<double> &q_T,
                            const std::vector<double> &q_k_bar,
                            std::vector<double>       &q_T_bar,
                            std::vector<double>       &volumes_bar);

  /// Cell values from nodal ones: the mean of the four nodes, which is the mean over the cell of the linear
  /// field, so that the integral of that field is kept:  sum_T |T| q_T = sum_k m_k q_k.
  template <typename Number>
  std::vector<Number> node_to_cell(const TetMesh &mesh, const std::vector<Number> &q_k);

  /// Adds the transpose of node_to_cell, applied to q_T_bar, to q_k_bar.
  void
  reverse_node_to_cell(const TetMesh &mesh, const std::vector<double> &q_T_bar, std::vector<double> &q_k_bar);
} // namespace retroforge
