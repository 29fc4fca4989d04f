// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/tet_mesh.h>

#include <cstddef>
#include <unordered_map>
#include <vector>

namespace retroforge
{
  /// The numbers that Gmsh and its files give nodes, with gaps and in any order.
  using Tags      = std::vector<std::size_t>;
  using TagToNode = std::unordered_map<std::size_t, NodeIndex>;

  /// Makes a mesh of cells and their nodes alone: Gmsh also keeps points of the geometry. Nodes are numbered
  /// in the order of their tags, and cells that are inverted are turned.
  /// @param cells   tags of nodes, four for each cell
  /// @param tags    of all nodes, at the positions X
  /// @param number  gets the node of each tag
  TetMesh
  cells_and_nodes(const Tags &cells, const Tags &tags, const NodalVectors<double> &X, TagToNode &number);
} // namespace retroforge
