// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/billet/billet_parameters.h>
#include <retroforge/mesh/tet_mesh.h>

#include <mpi.h>

namespace retroforge
{
  /// Makes or reads the mesh of the billet on rank 0 and gives it to all ranks: checked with check_mesh(),
  /// numbered with renumber(), nodes on planar patches on their plane to rounding. Collective.
  ///
  /// Patches of a box: `bottom`, `top`, `side -x`, `side +x`, `side -y`, `side +y`; of a cylinder: `bottom`,
  /// `top`, `side`; of a ring or profile: `bottom`, `top`, `side inner`, `side outer`, and of a ring `edge
  /// top outer`, `edge bottom outer`, `edge bottom inner`; then `symmetry 1`, ... with their planes: first
  /// those of the sector, then those listed. Patches of which the cuts leave nothing are absent. The names
  /// tell directions before the final rotation.
  TetMesh make_billet(const BilletParameters &parameters, MPI_Comm communicator);

  /// Moves the nodes of the faces of a mesh onto the shape that the measures give, each by the shortest way
  /// onto all patches it belongs to. The faces and patches of the mesh are those of make_billet(). Nodes of a
  /// billet from a file do not move.
  void snap_to_shape(const BilletParameters &parameters, TetMesh &mesh);

  /// Returns the volume that the measures and cuts of a billet bound, unless it is from a file: more than
  /// that of its mesh where that has chords for round sides. To be called on one rank only.  Units: mm^3.
  /// @throws Error
  double shape_volume(const BilletParameters &parameters);
} // namespace retroforge
