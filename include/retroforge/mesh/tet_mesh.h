// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/types.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace retroforge
{
  /// Plane (line, in two dimensions) through `point`; `normal` has length one and points out of the
  /// workpiece.
  template <int dim>
  struct Hyperplane
  {
    dealii::Tensor<1, dim> point;
    dealii::Tensor<1, dim> normal;
  };

  /// A named part of the workpiece's boundary. A patch with a symmetry plane is not surface
  /// in the sense of contact: it carries  v·n = 0  and no shear.
  template <int dim>
  struct BoundaryPatch
  {
    std::string                    name;
    std::optional<Hyperplane<dim>> symmetry;
  };

  /// Simplex of the boundary; its nodes turn counter-clockwise seen from outside.
  template <int dim>
  struct SimplexFace
  {
    std::array<NodeIndex, dim> nodes;
    unsigned int               patch;
  };

  /// The nodes of the file that a mesh was read from, in the file's order, those of no cell too.
  template <int dim>
  struct NodesOfFile
  {
    std::vector<std::size_t>            tags;  ///< their numbers in the file
    std::vector<NodeIndex>              nodes; ///< and in the mesh; invalid_index: of no cell
    std::vector<dealii::Tensor<1, dim>> X;     ///< positions at which the mesh was made [mm]
  };

  /// The simplex mesh of a workpiece as Gmsh, the remesher, the record and the transfer exchange it:
  /// connectivity, patches, and the positions of the nodes when it was made. The same on every rank.
  /// Positions during a run live outside the mesh; spaces on it are those of Discretization.
  ///
  /// Cells are positively oriented: tetrahedra have  (X1-X0)x(X2-X0)·(X3-X0) > 0.
  template <int dim>
  struct SimplexMesh
  {
    std::vector<dealii::Tensor<1, dim>>         X;
    std::vector<std::array<NodeIndex, dim + 1>> cells;
    std::vector<SimplexFace<dim>>               faces;
    std::vector<BoundaryPatch<dim>>             patches;
    /// A sentence on each thing in its file that was mended or left out; on the one rank that made the mesh.
    std::vector<std::string> remarks = {};
    NodesOfFile<dim>         of_file; ///< empty, unless it is the mesh of a file as it stands there

    unsigned int n_nodes() const { return X.size(); }
    unsigned int n_cells() const { return cells.size(); }

    bool is_surface(const SimplexFace<dim> &face) const { return !patches[face.patch].symmetry; }
  };

  using Plane        = Hyperplane<3>;
  using Patch        = BoundaryPatch<3>;
  using BoundaryFace = SimplexFace<3>;
  using FileNodes    = NodesOfFile<3>;
  using TetMesh      = SimplexMesh<3>;
} // namespace retroforge
