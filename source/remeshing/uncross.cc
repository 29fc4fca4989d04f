// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/mesh/self_crossing.h>
#include <retroforge/remeshing/thin_metal.h>
#include <retroforge/remeshing/uncross.h>

#include <algorithm>
#include <set>

namespace retroforge
{
  namespace
  {
    using Edge = std::array<NodeIndex, 2>;

    /// Cells behind the crossing faces off the planes of symmetry, the smallest first.
    std::vector<CellIndex> candidates(const PeeledMesh &peeled, const std::vector<SelfCrossing> &crossings)
    {
      const TetMesh         &mesh = peeled.mesh();
      std::set<Edge>         edges;
      std::set<unsigned int> faces;
      for (const SelfCrossing &crossing : crossings)
      {
        edges.insert(crossing.edge);
        faces.insert(crossing.face);
      }
      std::set<std::pair<double, CellIndex>> found;
      for (unsigned int f = 0; f < mesh.faces.size(); ++f)
      {
        const auto &nodes   = mesh.faces[f].nodes;
        bool        crosses = faces.count(f) > 0;
        for (unsigned int i = 0; i < 3; ++i)
        {
          const auto [a, b] = std::minmax(nodes[i], nodes[(i + 1) % 3]);
          crosses           = crosses || edges.count({{a, b}}) > 0;
        }
        if (crosses && mesh.is_surface(mesh.faces[f]))
          found.insert({peeled.volume(peeled.cell_behind(nodes)), peeled.cell_behind(nodes)});
      }
      std::vector<CellIndex> cells;
      for (const auto &[volume, cell] : found)
        cells.push_back(cell);
      return cells;
    }
  } // namespace

  std::optional<RepairedMesh>
  uncross(const TetMesh &mesh, const NodalVectors<double> &X, const std::function<double(const Vec3 &)> &size)
  {
    if (self_crossings(mesh, X).empty())
      return {};
    PeeledMesh peeled(mesh, X);
    for (;;)
    {
      const auto crossings = self_crossings(peeled.mesh(), X);
      if (crossings.empty())
        return peeled.result();
      const Vec3  &x       = X[crossings[0].edge[0]];
      const double h       = size(x);
      auto         in_turn = candidates(peeled, crossings);
      const auto   thin    = thin_cells_near(peeled, x, reach_of_thin * h);
      in_turn.insert(in_turn.end(), thin.begin(), thin.end());
      if (!peeled.remove_first(in_turn, h * h * h))
        return {};
    }
  }
} // namespace retroforge
