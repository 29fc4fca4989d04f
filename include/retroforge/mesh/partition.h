// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/topology.h>

#include <mpi.h>

namespace retroforge
{
  /// Who works on what. Positions and unknowns are known to every rank; the matrix and the work are divided:
  /// each rank owns a contiguous range of nodes, and of cells (by their smallest node). A rank visits every
  /// cell that touches one of its nodes and keeps what falls on its own nodes, so that sums are formed in the
  /// same order on any number of ranks.
  class Partition
  {
  public:
    Partition(const TetMesh &mesh, MPI_Comm comm);

    bool owns(const NodeIndex node) const { return node_begin <= node && node < node_end; }

    /// Whether one of the nodes is owned.
    bool sees(const std::array<NodeIndex, 2> &nodes) const { return owns(nodes[0]) || owns(nodes[1]); }

    /// Completes arrays whose owned entries are right: `width` doubles per node, or per cell.
    void gather_nodes(double *values, unsigned int width) const;
    void gather_cells(double *values, unsigned int width) const;
    void gather(NodalVectors<double> &x) const { gather_nodes(x.data()->begin_raw(), 3); }
    void gather(std::vector<double> &x) const { gather_nodes(x.data(), 1); }

    /// The same of any array in which rank r's entries, of `width` doubles, are begin[r] … begin[r + 1] - 1.
    void gather_ranges(double *values, unsigned int width, const std::vector<unsigned int> &begin) const;

    /// First node of each rank, and the end.
    const std::vector<unsigned int> &node_ranges() const { return node_ranges_; }

    /// Sum over ranks of one number per rank.
    double sum(double x) const;

    NodeIndex              node_begin, node_end;
    CellIndex              cell_begin, cell_end;
    std::vector<CellIndex> visited_cells; ///< touching an owned node, ascending
    MPI_Comm               comm;

  private:
    std::vector<unsigned int> node_ranges_, cell_ranges_; ///< begin of each rank, and the end
  };
} // namespace retroforge
