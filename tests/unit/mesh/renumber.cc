// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Numbering for locality. Proved: from shuffled nodes it restores a small bandwidth, and it changes names
// only (volume, quality, areas of patches, validity); cells come sorted by their smallest node, which stands
// first in each; the order of cells and faces in the input does not matter.

#include <deal.II/base/mpi.h>

#include "mesh_test_tools.h"
#include <retroforge/mesh/renumber.h>

#include <algorithm>
#include <numeric>
#include <random>

using namespace retroforge;

// Largest difference of two node numbers in one cell.
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

// Fisher-Yates by hand: std::shuffle differs between libraries.
std::vector<NodeIndex> shuffled(const unsigned int n)
{
  std::vector<NodeIndex> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::mt19937 random(1);
  for (unsigned int i = n; i > 1; --i)
    std::swap(order[i - 1], order[random() % i]);
  return order;
}

TetMesh shuffle_nodes(const TetMesh &mesh)
{
  const auto number = shuffled(mesh.n_nodes());
  TetMesh    result = mesh;
  for (NodeIndex node = 0; node < mesh.n_nodes(); ++node)
    result.X[number[node]] = mesh.X[node];
  for (auto &cell : result.cells)
    for (auto &node : cell)
      node = number[node];
  for (auto &face : result.faces)
    for (auto &node : face.nodes)
      node = number[node];
  return result;
}

bool same_faces(const TetMesh &a, const TetMesh &b)
{
  return std::equal(
    a.faces.begin(), a.faces.end(), b.faces.begin(), b.faces.end(), [](const auto &f, const auto &g) {
      return f.nodes == g.nodes && f.patch == g.patch;
    });
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const TetMesh                            mesh  = billet({{"size", "20, 20, 100"}, {"element size", "5"}});
  const TetMesh                            mixed = shuffle_nodes(mesh);
  TetMesh                                  restored = mixed;
  renumber(restored);
  std::cout << "shuffled: bandwidth > 80 % of the nodes: " << yes(bandwidth(mixed) > 0.8 * mesh.n_nodes())
            << "\n"
            << "renumbered: bandwidth < 20 % of the nodes: "
            << yes(bandwidth(restored) < 0.2 * mesh.n_nodes()) << "\n"
            << "same volume: "
            << yes(std::abs(volume(restored.cells, restored.X) / volume(mesh.cells, mesh.X) - 1) < 1e-13)
            << "\n"
            << "same quality: "
            << yes(std::abs(minimum_quality(restored.cells, restored.X) -
                            minimum_quality(mesh.cells, mesh.X)) < 1e-13)
            << "\n";
  for (unsigned int p = 0; p < mesh.patches.size(); ++p)
    std::cout << mesh.patches[p].name << ": area " << patch_area(restored, p) << "\n";
  print_error("check", [&]() { check_mesh(restored, "restored"); });

  bool smallest_first = true;
  for (const auto &cell : restored.cells)
    smallest_first = smallest_first && *std::min_element(cell.begin(), cell.end()) == cell[0];
  std::cout << "smallest node first: " << yes(smallest_first) << "\n"
            << "cells sorted: " << yes(std::is_sorted(restored.cells.begin(), restored.cells.end())) << "\n";

  TetMesh reordered = mixed;
  std::reverse(reordered.cells.begin(), reordered.cells.end());
  std::reverse(reordered.faces.begin(), reordered.faces.end());
  renumber(reordered);
  std::cout << "order of the input does not matter: "
            << yes(reordered.X == restored.X && reordered.cells == restored.cells &&
                   same_faces(reordered, restored))
            << "\n";
}
