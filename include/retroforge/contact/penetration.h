// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/geometry/die.h>
#include <retroforge/mesh/topology.h>

#include <mpi.h>

namespace retroforge
{
  /// The deepest point of the workpiece's surface in a die, or of a die in the workpiece.
  struct Penetration
  {
    double       depth = 0.; ///< [mm]; 0 when none is in a die
    Vec3         place;
    unsigned int die = invalid_index;
  };

  /// Looks at the nodes, the middles of the edges and the centres of the faces of the surface, and at the
  /// vertices and edges of the dies in the metal (find_die_in_metal). A point of the surface farther inside
  /// than the edges there are long is not found: it is behind the die rather than in it. Each rank looks at
  /// its share of the points, and all find the same. Collective.
  Penetration deepest_point(const TetMesh                       &mesh,
                            const Topology                      &topology,
                            const std::vector<Die>              &dies,
                            const std::vector<DieState<double>> &states,
                            const NodalVectors<double>          &X,
                            MPI_Comm                             comm = MPI_COMM_SELF);
} // namespace retroforge
