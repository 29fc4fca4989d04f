// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/mpi.h>

#include <retroforge/mesh/partition.h>

#include <algorithm>

namespace retroforge
{
  Partition::Partition(const TetMesh &mesh, MPI_Comm comm) : comm(comm)
  {
    const unsigned int n_ranks  = dealii::Utilities::MPI::n_mpi_processes(comm);
    const unsigned int rank     = dealii::Utilities::MPI::this_mpi_process(comm);
    const auto         smallest = [&](const CellIndex c) {
      return *std::min_element(mesh.cells[c].begin(), mesh.cells[c].end());
    };
    CellIndex cell = 0;
    for (unsigned int r = 0; r <= n_ranks; ++r)
    {
      node_ranges_.push_back(static_cast<std::uint64_t>(mesh.n_nodes()) * r / n_ranks);
      while (cell < mesh.n_cells() && smallest(cell) < node_ranges_.back())
        ++cell;
      cell_ranges_.push_back(cell);
    }
    node_begin = node_ranges_[rank];
    node_end   = node_ranges_[rank + 1];
    cell_begin = cell_ranges_[rank];
    cell_end   = cell_ranges_[rank + 1];
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
      if (std::any_of(mesh.cells[c].begin(), mesh.cells[c].end(), [&](const NodeIndex k) { return owns(k); }))
        visited_cells.push_back(c);
  }

  void Partition::gather_ranges(double                          *values,
                                const unsigned int               width,
                                const std::vector<unsigned int> &begin) const
  {
    const unsigned int n_ranks = begin.size() - 1;
    if (n_ranks == 1)
      return;
    std::vector<int> counts(n_ranks), offsets(n_ranks);
    for (unsigned int r = 0; r < n_ranks; ++r)
    {
      counts[r]  = width * (begin[r + 1] - begin[r]);
      offsets[r] = width * begin[r];
    }
    MPI_Allgatherv(
      MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, values, counts.data(), offsets.data(), MPI_DOUBLE, comm);
  }

  void Partition::gather_nodes(double *values, const unsigned int width) const
  {
    gather_ranges(values, width, node_ranges_);
  }

  void Partition::gather_cells(double *values, const unsigned int width) const
  {
    gather_ranges(values, width, cell_ranges_);
  }

  double Partition::sum(const double x) const
  {
    return dealii::Utilities::MPI::sum(x, comm);
  }
} // namespace retroforge
