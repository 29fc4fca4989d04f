// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/mpi.h>

#include <retroforge/discretization/velocity_ownership.h>

#include <algorithm>

namespace retroforge
{
  VelocityOwnership::VelocityOwnership(const Spaces &spaces, const Partition &partition)
      : partition_(partition)
      , of_mesh_{partition.node_begin, partition.node_end, spaces.n_pressure_nodes()}
      , edge_ranges_(partition.node_ranges().size(), 0)
  {
    const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(partition.comm);
    if (const MeshEdges *edges = spaces.edges())
      for (unsigned int r = 0; r < edge_ranges_.size(); ++r)
        edge_ranges_[r] = std::lower_bound(edges->nodes.begin(),
                                           edges->nodes.end(),
                                           std::array<NodeIndex, 2>{{partition.node_ranges()[r], 0}}) -
                          edges->nodes.begin();
    of_edges_ = {edge_ranges_[rank], edge_ranges_[rank + 1], edge_ranges_.back()};
    range_    = {of_mesh_.begin + of_edges_.begin, of_mesh_.end + of_edges_.end, of_mesh_.n + of_edges_.n};
  }

  unsigned int VelocityOwnership::number(const NodeIndex node) const
  {
    const bool         of_mesh = node < of_mesh_.n;
    const unsigned int own     = of_mesh ? node : node - of_mesh_.n;
    const auto        &ranges  = of_mesh ? partition_.node_ranges() : edge_ranges_;
    const unsigned int rank    = std::upper_bound(ranges.begin(), ranges.end(), own) - ranges.begin() - 1;
    return own + (of_mesh ? edge_ranges_[rank] : partition_.node_ranges()[rank + 1]);
  }

  void VelocityOwnership::gather(double *values, const unsigned int width) const
  {
    partition_.gather_nodes(values, width);
    if (of_edges_.n > 0)
      partition_.gather_ranges(values + width * of_mesh_.n, width, edge_ranges_);
  }
} // namespace retroforge
