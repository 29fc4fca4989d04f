// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/tet_mesh.h>

#include <functional>
#include <string>

#include <mpi.h>

namespace retroforge
{
  /// Makes a mesh on rank 0 and gives it to all ranks. When `make` throws there, all ranks throw the same
  /// Error, so that none waits for the others. Collective.
  /// @param where    that a failure is told of, when it is none of the project's own
  /// @param with_it  a list that `make` fills and all ranks get too; may be null
  TetMesh make_on_root(const std::string              &where,
                       const std::function<TetMesh()> &make,
                       MPI_Comm                        communicator,
                       std::vector<NodeIndex>         *with_it = nullptr);
} // namespace retroforge
