// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/tet_mesh.h>
#include <retroforge/remeshing/remeshing_parameters.h>

#include <vector>

namespace retroforge
{
  /// The features of the boundary that must survive remeshing, found from the patches and the positions.
  ///
  /// A ridge is a boundary edge between two patches, or one whose faces turn by more than the ridge angle,
  /// unless one of them cuts into a die: then they are chords of the die's rounding, not an edge of the body.
  /// Ridges form curves from corner to corner, or closed ones. A corner is a node where the number of ridges
  /// is neither zero nor two, or where a ridge turns by more than the corner angle. A region is a piece of
  /// one patch bounded by ridges.
  struct SurfaceFeatures
  {
    struct Curve
    {
      std::vector<NodeIndex>      nodes; ///< in order; a closed curve repeats its first node at the end
      std::array<unsigned int, 2> regions;
      bool                        is_closed() const { return nodes.front() == nodes.back(); }
    };

    std::vector<unsigned int> region_of_face;
    std::vector<unsigned int> patch_of_region;
    std::vector<Curve>        curves;
    std::vector<bool>         is_corner; ///< one entry per node

    /// Angles in degrees: 0 is flat, or straight.
    SurfaceFeatures(const TetMesh              &mesh,
                    const NodalVectors<double> &X,
                    double                      ridge_angle,
                    double                      corner_angle,
                    const PushOut              &push_out = {});
  };

  /// Two boundary faces that share an edge; `nodes` ascending, faces[0] < faces[1].
  struct SurfaceEdge
  {
    std::array<NodeIndex, 2>    nodes;
    std::array<unsigned int, 2> faces;
  };

  /// The edges of a closed manifold boundary, sorted by their nodes.
  std::vector<SurfaceEdge> surface_edges(const std::vector<BoundaryFace> &faces);

  /// Outward unit normals of the boundary faces.
  std::vector<Vec3> face_unit_normals(const std::vector<BoundaryFace> &faces, const NodalVectors<double> &X);
} // namespace retroforge
