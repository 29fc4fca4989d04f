// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/types.h>

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace retroforge
{
  /// Contents of a Gmsh file: a mesh of tetrahedra and its surface, nodes by the file's tags.
  struct MshFile
  {
    using Tags = std::vector<std::size_t>;

    struct Surface
    {
      std::string name;      ///< may be empty
      Tags        triangles; ///< three nodes for each
    };

    Tags                   tags;       ///< tags of the nodes
    NodalVectors<double>   X;          ///< and their positions
    Tags                   tetrahedra; ///< four nodes for each, by ascending number of their volume
    std::map<int, Surface> surfaces;   ///< physical surfaces by their number

    std::vector<std::string> remarks; ///< a sentence on each thing left out or merged
  };

  /// Reads a Gmsh file of version 2 or 4.1, ASCII or binary with this machine's order of bytes, or of version
  /// 4.0, ASCII. Of elements of higher order the corners are read, tetrahedra that are there twice once, and
  /// all volumes as one: the remarks say so. Gmsh itself is not asked: on a damaged file it crashes, or asks
  /// for all memory there is.
  /// @throws Error  for what is missing, no number, or announced and not there; nodes that are twice there or
  /// nowhere; coordinates that are not finite; volume elements that are no tetrahedra; files of another
  /// format
  MshFile read_msh_file(const std::string &file_name);
} // namespace retroforge
