// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/discretization/spaces.h>

namespace retroforge
{
  namespace
  {
    std::vector<unsigned int> places_of(const std::vector<CellIndex> &kept, const unsigned int n_cells)
    {
      std::vector<unsigned int> place(n_cells, invalid_index);
      for (unsigned int i = 0; i < kept.size(); ++i)
        place[kept[i]] = i;
      return place;
    }
  } // namespace

  Spaces::Spaces(const TetMesh                &mesh,
                 const Topology               &topology,
                 const ElementPair             pair,
                 const std::vector<CellIndex> *visited)
      : pair_(pair)
      , n_nodes_(mesh.n_nodes())
      , n_cells_(mesh.n_cells())
      , nodes_per_cell_(pair == ElementPair::mini ? 4 : 10)
      , edges_(pair == ElementPair::mini ? nullptr : std::make_shared<const MeshEdges>(mesh))
      , fixed_at_nodes_(topology.fixed_directions)
  {
    if (pair == ElementPair::mini)
    {
      n_bubbles_ = visited ? visited->size() : n_cells_;
      if (n_bubbles_ < n_cells_)
        bubble_ = places_of(*visited, n_cells_);
    }
    if (edges_)
      fixed_at_edges_ = fixed_directions_of_edges(mesh, *edges_);
    cell_nodes_.reserve(nodes_per_cell_ * n_cells_);
    for (CellIndex c = 0; c < n_cells_; ++c)
    {
      cell_nodes_.insert(cell_nodes_.end(), mesh.cells[c].begin(), mesh.cells[c].end());
      if (edges_)
        for (const EdgeIndex e : edges_->of_cells[c])
          cell_nodes_.push_back(n_nodes_ + e);
    }
  }
} // namespace retroforge
