// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/tet_mesh.h>

namespace retroforge
{
  /// The number of copies of a model cut by symmetry planes in the whole part; dimensionless, NaN where it
  /// repeats without end, or in no simple way.
  struct WholePart
  {
    /// Factor of energies, volumes and surfaces: the full angle over that between the planes.
    double copies = 1.;

    /// Factor of the force of one die: over the planes along its path only. Across a plane normal to it
    /// another die presses.
    double force = 1.;

    bool is_model() const { return copies == 1.; }
  };

  /// The planes of symmetry among some patches of a mesh, each once.
  std::vector<Plane> symmetry_planes(const TetMesh &mesh, const std::vector<unsigned int> &patches);

  /// Returns the symmetry planes of the mesh.
  std::vector<Plane> symmetry_planes(const TetMesh &mesh);

  /// 1 for no plane, 2 for one; 2 pi over the angle between two, 4 pi over the solid angle between three.
  double n_copies(const std::vector<Plane> &planes);

  /// @param path  of the die, of any length
  WholePart whole_part(const TetMesh &mesh, const Vec3 &path);
} // namespace retroforge
