// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/element/mini_element.h>
#include <retroforge/linear_algebra/node_matrix.h>
#include <retroforge/solver/stage.h>

#include <deal.II/base/aligned_vector.h>

namespace retroforge
{
  /// What cells add to the Newton matrix of a stage, bubbles condensed, by pairs of nodes that meet in a
  /// cell. A pair has all its entries side by side, in the axes of space: a cell adds whole blocks, and
  /// frames and scales are applied once to a pair, where the sums are written to matrices.
  class TangentSums
  {
  public:
    /// [A B; D C] of a row and a column node: the first three rows belong to the row node's momentum, the
    /// last to its continuity; the first three columns to the column node's velocity, the last to its
    /// pressure. Zero where a node has no pressure.
    struct Block
    {
      Pack rows[4];
    };

    /// @param met  nodes that meet, of all velocities; pairs are counted row by row.
    TangentSums(const Scene &scene, const NodePattern &met);

    void assemble(const Stage<double> &stage, const Field<double> &W, Linearisation linearisation);

    /// The first pair of a local row; its pairs follow each other.
    const Block *row(const unsigned int local) const { return &blocks_[begin_[local]]; }
    /// The pressure mass over the viscosity less C, of the pairs of a local row.
    const double *schur_row(const unsigned int local) const { return &schur_[begin_[local]]; }
    /// Viscosity over edge length, as a mean over the body [MPa s / mm].
    double viscosity_over_edge() const { return viscosity_over_edge_; }
    /// Of the visited cells; empty without bubbles.
    const std::vector<BubbleElimination<double>> &eliminations() const { return eliminations_; }

  private:
    template <typename Tangents, typename Pair>
    void add_cells(const Pair          &pair,
                   const Stage<double> &stage,
                   const Field<double> &W,
                   Linearisation        linearisation);

    const Scene                           &scene_;
    std::vector<unsigned int>              begin_; ///< first pair of each local row, and the end
    dealii::AlignedVector<Block>           blocks_;
    std::vector<double>                    schur_;
    std::vector<BubbleElimination<double>> eliminations_;
    /// Of n_lanes visited cells after each other: for each row and column node, the pair of each lane. Rows
    /// of other ranks, and lanes without a cell, go to one pair after the last.
    std::vector<unsigned int> pairs_;
    double                    viscosity_over_edge_ = 1.;
  };
} // namespace retroforge
