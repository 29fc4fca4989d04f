// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/tet_mesh.h>
#include <retroforge/remeshing/remeshing_parameters.h>
#include <retroforge/remeshing/remeshing_report.h>
#include <retroforge/remeshing/tape_writer.h>

#include <optional>
#include <vector>

namespace retroforge
{
  /// A mesh after local remeshing. Its X are the new positions.
  struct RemeshedMesh
  {
    TetMesh mesh;
    /// For each node the old node it is, or invalid_index when it is new or was moved by more than the volume
    /// correction is allowed to. Nodes that remeshing did not touch come first, in their old order.
    std::vector<NodeIndex> old_node;
    /// Displacement of each kept node by the volume correction; zero for those that kept their position bit
    /// for bit.
    NodalVectors<double> correction;
    RemeshingReport      report;
  };

  /// Repairs a deformed mesh only where it is bad: first edges far from the wanted length, then bad cells
  /// (see length_pass() and QualityPass), then the volume lost on curved surfaces (see correct_volume()).
  /// Patches, ridges, corners and symmetry planes stay (see SurfaceFeatures, OldSurface), most nodes keep
  /// their identity, and the same input gives the same bits.
  ///
  /// @param mesh  connectivity and patches; its X are not looked at
  /// @param X     positions of its nodes
  /// @param size  wanted edge length, may vary in space
  /// @param push_out  keeps new surface nodes out of the dies; may be empty
  /// @param touches   nodes the volume correction leaves where they are; may be empty
  /// @param wanted_volume  volume that the correction restores [mm^3]; by default that of the mesh
  /// @param tape      on which to write how the new positions follow from X; its nodes are those of the mesh
  /// Throws Error when a cell has no positive volume: then the mesh must be rebuilt from its surface.
  RemeshedMesh remesh_locally(const TetMesh              &mesh,
                              const NodalVectors<double> &X,
                              const SizeField            &size,
                              const RemeshingParameters  &parameters,
                              const PushOut              &push_out      = {},
                              const TouchesDie           &touches       = {},
                              std::optional<double>       wanted_volume = {},
                              TapeWriter                 *tape          = nullptr);
} // namespace retroforge
