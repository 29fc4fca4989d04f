// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/geometry/box_tree.h>
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/mesh/tet_mesh.h>

#include <vector>

namespace retroforge
{
  /// Weights w >= 0, sum 1, of the point  sum_a w_a p_a  of a simplex closest to x. Degenerate simplices are
  /// allowed. Of several closest points the first found is taken, always the same one.
  std::array<double, 2> closest_on_segment(const Vec3 &x, const std::array<Vec3, 2> &p);
  std::array<double, 3> closest_on_triangle(const Vec3 &x, const std::array<Vec3, 3> &p);
  std::array<double, 4> closest_on_tetrahedron(const Vec3 &x, const TetCorners &p);

  /// Barycentric coordinates of x, for inverted tetrahedra too; not finite when the volume is zero.
  std::array<double, 4> barycentric_coordinates(const Vec3 &x, const TetCorners &p);

  /// The location of a point in a mesh: its position is  sum_a weights_a X_a  over the corners of the cell.
  struct CellPoint
  {
    CellIndex             cell;
    std::array<double, 4> weights; ///< >= 0, sum 1
  };

  /// Finds the cells that contain points, in O(log n_cells) each. The answer is decided by the barycentric
  /// coordinates of all cells whose boxes contain the point: never by a walk or by a guess.
  ///
  /// Cells may be inverted (a wrecked mesh still covers its domain); among several cells that contain the
  /// point the one in which it lies deepest is taken. A point in none gets the closest point of the mesh.
  class CellLocator
  {
  public:
    /// Keeps references to both arguments.
    CellLocator(const TetMesh &mesh, const NodalVectors<double> &X);

    CellPoint locate(const Vec3 &x) const;

  private:
    TetCorners cell_corners(const unsigned int c) const { return corners(mesh_.cells[c], X_); }

    const TetMesh              &mesh_;
    const NodalVectors<double> &X_;
    BoxTree                     tree_;
  };
} // namespace retroforge
