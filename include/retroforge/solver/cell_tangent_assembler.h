// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/element/mini_element.h>
#include <retroforge/linear_algebra/node_matrix.h>
#include <retroforge/solver/equilibrium.h>

#include <deal.II/base/aligned_vector.h>

namespace retroforge
{
  /// Assembles the tangents of the cells, bubbles condensed, into one block for each pair of nodes that share
  /// a cell. A pair has all its entries side by side, in the axes of space: a cell adds whole blocks, and
  /// frames and scales are applied once to a pair, where the blocks are written to matrices.
  class CellTangentAssembler
  {
  public:
    /// [A B; D C] of a row and a column node: the first three rows belong to the row node's momentum, the
    /// last to its continuity; the first three columns to the column node's velocity, the last to its
    /// pressure. Zero where a node has no pressure.
    struct Block
    {
      Pack rows[4];
    };

    /// @param met  for each velocity node, the nodes that share a cell with it; pairs are counted row by row
    CellTangentAssembler(const Scene &scene, const NodePattern &met);

    /// Sums the tangents of the visited cells at W.
    void assemble(const Equilibrium<double> &stage, const Field<double> &W, Linearisation linearisation);

    /// Returns the first block of a local row; those of its other pairs follow.
    const Block *row(const unsigned int local) const { return &blocks_[begin_[local]]; }
    /// Returns pressure mass over viscosity less C, for the pairs of a local row [mm^3 / (MPa s)].
    const double *schur_row(const unsigned int local) const { return &schur_[begin_[local]]; }
    /// Returns viscosity over edge length, as a geometric mean over the body [MPa s / mm].
    double viscosity_over_edge() const { return viscosity_over_edge_; }
    /// Returns the eliminated bubbles of the visited cells; empty without bubbles.
    const std::vector<BubbleElimination<double>> &eliminations() const { return eliminations_; }

  private:
    template <typename Tangents, typename Pair>
    void add_cells(const Pair                &pair,
                   const Equilibrium<double> &stage,
                   const Field<double>       &W,
                   Linearisation              linearisation);

    const Scene                 &scene_;
    std::vector<unsigned int>    begin_; ///< number of the first pair of each local row, and the end
    dealii::AlignedVector<Block> blocks_;
    std::vector<double>          schur_;
    std::vector<BubbleElimination<double>> eliminations_;
    /// For each pack of n_lanes visited cells, for each row and column node: the number of the pair of each
    /// lane. Rows of other ranks, and lanes without a cell, have one number after the last.
    std::vector<unsigned int> pairs_;
    double                    viscosity_over_edge_ = 1.;
  };
} // namespace retroforge
