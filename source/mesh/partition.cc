// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/mpi.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparsity_pattern.h>
#include <deal.II/lac/sparsity_tools.h>

#include <retroforge/mesh/partition.h>

#include <algorithm>
#include <cstdint>

namespace retroforge
{
  namespace
  {
    std::vector<unsigned int> cut_by_metis(const Topology &topology, const unsigned int n_parts)
    {
      const unsigned int             n = topology.neighbours.size();
      dealii::DynamicSparsityPattern graph(n);
      for (NodeIndex k = 0; k < n; ++k)
        graph.add_entries(k, topology.neighbours[k].begin(), topology.neighbours[k].end(), true);
      dealii::SparsityPattern compressed;
      compressed.copy_from(graph);
      std::vector<unsigned int> part(n);
      dealii::SparsityTools::partition(compressed, n_parts, part);
      return part;
    }

    /// Rank of each node. All ranks cut alike.
    std::vector<unsigned int> owners_of_nodes(const Topology &topology, const unsigned int n_ranks)
    {
      const unsigned int n = topology.neighbours.size();
      if (n_ranks == 1)
        return std::vector<unsigned int>(n, 0);
      std::vector<unsigned int> owner = cut_by_metis(topology, n_ranks), n_owned(n_ranks, 0);
      for (const unsigned int rank : owner)
        ++n_owned[rank];
      // Of very few nodes METIS gives some ranks none.
      if (std::find(n_owned.begin(), n_owned.end(), 0u) != n_owned.end())
        for (NodeIndex k = 0; k < n; ++k)
          owner[k] = static_cast<std::uint64_t>(k) * n_ranks / n;
      return owner;
    }

    std::vector<unsigned int> owners_of_cells(const TetMesh &mesh, const std::vector<unsigned int> &owner)
    {
      std::vector<unsigned int> of_cells;
      of_cells.reserve(mesh.n_cells());
      for (const auto &cell : mesh.cells)
        of_cells.push_back(owner[*std::min_element(cell.begin(), cell.end())]);
      return of_cells;
    }
  } // namespace

  Partition::Partition(const TetMesh &mesh, const Topology &topology, MPI_Comm comm)
      : comm(comm)
      , owner_(owners_of_nodes(topology, dealii::Utilities::MPI::n_mpi_processes(comm)))
      , nodes_(owner_, comm)
      , cells_(owners_of_cells(mesh, owner_), comm)
  {
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
      if (std::any_of(mesh.cells[c].begin(), mesh.cells[c].end(), [&](const NodeIndex k) { return owns(k); }))
        visited_cells.push_back(c);
  }

  double Partition::sum(const double x) const
  {
    return dealii::Utilities::MPI::sum(x, comm);
  }
} // namespace retroforge
