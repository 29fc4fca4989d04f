// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/billet/patch_shapes.h>
#include <retroforge/billet/section.h>

#include <functional>
#include <string>
#include <vector>

namespace retroforge
{
  /// A box, cylinder or body of revolution standing along z on the centre of its base, cut by planes.
  struct CutSolid
  {
    Section section;            ///< section of the body of revolution; none for box and cylinder
    double section_angle = 360; ///< angle by which it is revolved, from the direction +x towards +y [degrees]
    bool   is_cylinder   = false;
    Vec3   base_centre;
    Vec3   size;       ///< lengths of the box
    double radius = 0; ///< radius of the cylinder
    double height = 0; ///< height before cuts, of any of them
    /// Cutting planes: the side that the normal points to is cut away.
    std::vector<Plane> cuts;
    /// Number of the first cuts that are made by `section_angle` already.
    unsigned int n_cuts_of_section = 0;
  };

  /// Cells and nodes of an unstructured tetrahedral mesh of the solid, edges of about `element_size`. Cells
  /// are positively oriented. When the first mesh has a dihedral angle below 15 degrees, even once `improve`
  /// has changed it, others are tried, with edges up to 6 % shorter or 4 % longer, and the best is returned
  /// (a sharp edge of the solid limits it). The same input gives the same mesh, bit for bit. Throws Error at
  /// `where` when the cuts leave nothing or Gmsh fails. To be called on one rank only.
  /// @param improve  gets the mesh, without faces and patches, and the angle; its faces and patches are kept
  TetMesh mesh_with_gmsh(const CutSolid                               &solid,
                         double                                        element_size,
                         const std::function<void(TetMesh &, double)> &improve,
                         const std::string                            &where);

  /// Of the solid itself, by Gmsh.  Throws and is called as mesh_with_gmsh().  Units: mm^3.
  double volume_with_gmsh(const CutSolid &solid, const std::string &where);

  /// Cells and nodes of an unstructured tetrahedral mesh of what the triangles enclose. The triangles, turned
  /// outwards, are kept as they are; the nodes of the result are first `X`, then those made inside. The same
  /// input gives the same mesh, bit for bit. Throws Error at `where` when Gmsh fails, which it does when
  /// triangles cross. To be called on one rank only.
  /// @param X     positions of the nodes of the triangles, and of no others
  /// @param size  wanted length of edges at a point
  TetMesh fill_with_gmsh(const NodalVectors<double>                  &X,
                         const std::vector<std::array<NodeIndex, 3>> &triangles,
                         const std::function<double(const Vec3 &)>   &size,
                         const std::string                           &where);
} // namespace retroforge
