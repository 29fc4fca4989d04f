// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparsity_tools.h>

#include <retroforge/mesh/renumber.h>

#include <algorithm>
#include <tuple>
#include <vector>

namespace retroforge
{
  namespace
  {
    // New number of each node.
    std::vector<NodeIndex> reverse_cuthill_mckee(const TetMesh &mesh)
    {
      dealii::DynamicSparsityPattern graph(mesh.n_nodes());
      for (const auto &cell : mesh.cells)
        for (const NodeIndex node : cell)
          graph.add_entries(node, cell.begin(), cell.end());
      std::vector<dealii::DynamicSparsityPattern::size_type> order(mesh.n_nodes());
      dealii::SparsityTools::reorder_Cuthill_McKee(graph, order);
      std::vector<NodeIndex> number(mesh.n_nodes());
      for (NodeIndex node = 0; node < mesh.n_nodes(); ++node)
        number[node] = mesh.n_nodes() - 1 - order[node];
      return number;
    }

    // Even permutation that brings the smallest node to the front, and for cells the second smallest next.
    void turn(std::array<NodeIndex, 3> &face)
    {
      std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    }

    void turn(std::array<NodeIndex, 4> &cell)
    {
      const auto first = std::min_element(cell.begin(), cell.end()) - cell.begin();
      if (first != 0)
      {
        std::swap(cell[0], cell[first]);
        std::swap(cell[first == 1 ? 2 : 1], cell[3 - (first == 3 ? 1 : 0)]);
      }
      std::rotate(cell.begin() + 1, std::min_element(cell.begin() + 1, cell.end()), cell.end());
    }
  } // namespace

  void renumber(TetMesh &mesh)
  {
    const auto           number = reverse_cuthill_mckee(mesh);
    NodalVectors<double> X(mesh.n_nodes());
    for (NodeIndex node = 0; node < mesh.n_nodes(); ++node)
      X[number[node]] = mesh.X[node];
    mesh.X = std::move(X);

    for (auto &cell : mesh.cells)
    {
      for (NodeIndex &node : cell)
        node = number[node];
      turn(cell);
    }
    for (auto &face : mesh.faces)
    {
      for (NodeIndex &node : face.nodes)
        node = number[node];
      turn(face.nodes);
    }
    std::sort(mesh.cells.begin(), mesh.cells.end());
    std::sort(mesh.faces.begin(), mesh.faces.end(), [](const BoundaryFace &a, const BoundaryFace &b) {
      return std::tie(a.nodes, a.patch) < std::tie(b.nodes, b.patch);
    });
  }

  unsigned int bandwidth(const TetMesh &mesh)
  {
    unsigned int width = 0;
    for (const auto &cell : mesh.cells)
    {
      const auto [least, greatest] = std::minmax_element(cell.begin(), cell.end());
      width                        = std::max(width, *greatest - *least);
    }
    return width;
  }
} // namespace retroforge
