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
    using Graph = dealii::DynamicSparsityPattern;

    struct Farthest
    {
      NodeIndex    node;  // the one with the fewest neighbours among the farthest
      unsigned int steps; // from the start
    };

    Farthest farthest_from(const NodeIndex start, const Graph &graph)
    {
      std::vector<bool> met(graph.n_rows(), false);
      met[start]                   = true;
      Farthest               far   = {start, 0};
      std::vector<NodeIndex> front = {start}, next;
      for (unsigned int steps = 0; !front.empty(); ++steps)
      {
        const auto fewest = [&](const NodeIndex a, const NodeIndex b) {
          return graph.row_length(a) < graph.row_length(b);
        };
        far = {*std::min_element(front.begin(), front.end(), fewest), steps};
        next.clear();
        for (const NodeIndex node : front)
          for (auto neighbour = graph.begin(node); neighbour != graph.end(node); ++neighbour)
            if (!met[neighbour->column()])
            {
              met[neighbour->column()] = true;
              next.push_back(neighbour->column());
            }
        front.swap(next);
      }
      return far;
    }

    // A node at an end of the workpiece: layers that start there are thinnest (George and Liu 1979).
    NodeIndex peripheral_node(const Graph &graph)
    {
      Farthest end = farthest_from(0, graph);
      while (true)
      {
        const Farthest other = farthest_from(end.node, graph);
        if (other.steps <= end.steps)
          return end.node;
        end = other;
      }
    }

    // New number of each node.
    std::vector<NodeIndex> reverse_cuthill_mckee(const TetMesh &mesh)
    {
      Graph graph(mesh.n_nodes());
      for (const auto &cell : mesh.cells)
        for (const NodeIndex node : cell)
          graph.add_entries(node, cell.begin(), cell.end());
      std::vector<Graph::size_type> order(mesh.n_nodes());
      dealii::SparsityTools::reorder_Cuthill_McKee(graph, order, {peripheral_node(graph)});
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

  std::vector<NodeIndex> renumber(TetMesh &mesh)
  {
    Assert(std::all_of(
             mesh.cells.begin(),
             mesh.cells.end(),
             [&](const auto &cell) { return *std::max_element(cell.begin(), cell.end()) < mesh.n_nodes(); }),
           dealii::ExcMessage("a cell has a node that is not there"));
    const auto           number = reverse_cuthill_mckee(mesh);
    NodalVectors<double> X(mesh.n_nodes());
    for (NodeIndex node = 0; node < mesh.n_nodes(); ++node)
      X[number[node]] = mesh.X[node];
    mesh.X = std::move(X);
    for (NodeIndex &node : mesh.of_file.nodes)
      if (node != invalid_index)
        node = number[node];

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
    return number;
  }
} // namespace retroforge
