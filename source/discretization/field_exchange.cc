// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/discretization/field_exchange.h>

namespace retroforge
{
  Ownership velocity_ownership(const Spaces &spaces, const Partition &partition)
  {
    std::vector<unsigned int> owner = partition.owner_of_nodes();
    if (const MeshEdges *edges = spaces.edges())
      for (const auto &nodes : edges->nodes)
        owner.push_back(owner[nodes[0]]);
    return {owner, partition.comm};
  }

  namespace
  {
    std::vector<NodeIndex> velocities_read(const TetMesh   &mesh,
                                           const Topology  &topology,
                                           const Spaces    &spaces,
                                           const Partition &partition)
    {
      const unsigned int     n_of_cell = spaces.n_nodes_per_cell();
      std::vector<NodeIndex> read;
      for (const CellIndex c : partition.visited_cells)
        read.insert(read.end(), spaces.velocity_nodes(c), spaces.velocity_nodes(c) + n_of_cell);
      for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
        if (topology.is_on_surface(k))
          read.push_back(k);
      if (const MeshEdges *edges = spaces.edges())
        for (const auto &[a, b] : topology.surface_edges)
          read.push_back(mesh.n_nodes() + edges->find(a, b));
      return read;
    }

    std::vector<NodeIndex> pressures_read(const TetMesh &mesh, const Partition &partition)
    {
      std::vector<NodeIndex> read;
      for (const CellIndex c : partition.visited_cells)
        read.insert(read.end(), mesh.cells[c].begin(), mesh.cells[c].end());
      return read;
    }
  } // namespace

  FieldExchange::FieldExchange(const TetMesh   &mesh,
                               const Topology  &topology,
                               const Spaces    &spaces,
                               const Partition &partition,
                               const Ownership &velocities)
      : velocities_(velocities)
      , pressures_(partition.nodes())
      , velocity_ghosts_(velocities, velocities_read(mesh, topology, spaces, partition), 3)
      , pressure_ghosts_(pressures_, pressures_read(mesh, partition), 1)
  {
    if (spaces.pair() == ElementPair::mini)
      bubble_ghosts_.emplace(
        partition.cells(), partition.visited_cells, 3, [&](const CellIndex c) { return spaces.bubble(c); });
  }
} // namespace retroforge
