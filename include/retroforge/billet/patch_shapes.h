// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/billet/spline_curve.h>
#include <retroforge/mesh/tet_mesh.h>

#include <optional>
#include <string>
#include <vector>

namespace retroforge
{
  /// Round surface of radius `radius` about the line through `point` along the unit vector `axis`.
  struct CylinderSurface
  {
    Vec3   point;
    Vec3   axis;
    double radius;
  };

  /// Surface of revolution of a curve of the meridian plane about the line through `point` along z; the
  /// curve's r counts from this line, its z from `point`.
  struct RevolvedCurve
  {
    Vec3        point;
    SplineCurve curve;
  };

  /// The exact surface a patch lies on, where it is known. A patch without any is free form.
  struct PatchShape
  {
    Patch                          patch;
    std::optional<Plane>           plane;
    std::optional<CylinderSurface> cylinder;
    std::optional<RevolvedCurve>   revolved;
  };

  /// Makes `mesh.faces` and `mesh.patches` anew: each outer face of the cells, turned outwards, goes to the
  /// first shape all three of its nodes lie on, within `tolerance` [length]. Patches that get no face are
  /// left out. Throws Error at `where` when a face lies on none of the shapes.
  /// @return the shapes of the patches that remain, in the order of `mesh.patches`
  std::vector<PatchShape> assign_patches(TetMesh                       &mesh,
                                         const std::vector<PatchShape> &shapes,
                                         double                         tolerance,
                                         const std::string             &where);

  /// Moves each boundary node, by the shortest way, onto all the surfaces of the patches it
  /// belongs to, to rounding. `shapes` are in the order of `mesh.patches`.
  void snap_nodes(TetMesh &mesh, const std::vector<PatchShape> &shapes);

  /// Fits the planes of the patches marked in `is_symmetry` to their nodes, stores them in the patches and
  /// snaps the nodes onto them. Throws Error at `where` when a node is farther from the plane than 1e-6 of
  /// the size of the mesh.
  void fit_symmetry_planes(TetMesh &mesh, const std::vector<bool> &is_symmetry, const std::string &where);

  /// Length of the diagonal of the box about all nodes.
  double mesh_size(const TetMesh &mesh);
} // namespace retroforge
