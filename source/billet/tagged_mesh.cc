// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/billet/tagged_mesh.h>
#include <retroforge/mesh/mesh_quality.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  namespace
  {
    // Numbers from 0 for the tags, in ascending order.
    std::unordered_map<std::size_t, NodeIndex> number_tags(Tags tags)
    {
      std::sort(tags.begin(), tags.end());
      tags.erase(std::unique(tags.begin(), tags.end()), tags.end());
      std::unordered_map<std::size_t, NodeIndex> number;
      number.reserve(tags.size());
      for (const std::size_t tag : tags)
        number.emplace(tag, number.size());
      return number;
    }

    // Turns the cells that are inverted. Whether they then overlap, check_mesh() finds.
    // @return how many they were
    unsigned int turn_inverted(TetMesh &mesh)
    {
      unsigned int n = 0;
      for (auto &cell : mesh.cells)
        if (tet_volume(corners(cell, mesh.X)) < 0)
        {
          std::swap(cell[2], cell[3]);
          ++n;
        }
      return n;
    }
  } // namespace

  TetMesh
  cells_and_nodes(const Tags &cells, const Tags &tags, const NodalVectors<double> &X, TagToNode &number)
  {
    TetMesh mesh;
    number = number_tags(cells);
    mesh.cells.resize(cells.size() / 4);
    for (std::size_t i = 0; i < cells.size(); ++i)
      mesh.cells[i / 4][i % 4] = number.at(cells[i]);
    mesh.X.assign(number.size(),
                  Vec3({std::nan(""), 0, 0})); // a node that is not given is caught by check_mesh()
    for (std::size_t i = 0; i < tags.size(); ++i)
      if (const auto node = number.find(tags[i]); node != number.end())
        mesh.X[node->second] = X[i];
    if (const unsigned int n = turn_inverted(mesh); n > 0 && n < mesh.n_cells())
      mesh.remarks.push_back(std::to_string(n) + " of its " + std::to_string(mesh.n_cells()) +
                             " tetrahedra, numbered the other way round, were turned");
    return mesh;
  }
} // namespace retroforge
