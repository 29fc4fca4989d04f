// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/remeshing/editable_mesh.h>
#include <retroforge/remeshing/old_surface.h>
#include <retroforge/remeshing/tape_writer.h>

#include <optional>

namespace retroforge
{
  /// The data that every operation of local remeshing reads: the mesh as it is, the surface as it was, the
  /// wanted edge lengths, and the limits.
  struct RemeshingContext
  {
    EditableMesh              &mesh;
    const OldSurface          &old_surface;
    const SizeField           &size;
    const RemeshingParameters &parameters;
    TapeWriter                *tape = nullptr; ///< that tells where positions come from; none: nobody asks

    /// Changes the mesh, and writes how a node got where it is.
    void apply(const CavityChange &change) const;

    /// Returns the length of an edge over the wanted one at its middle.
    double relative_length(NodeIndex a, NodeIndex b) const;
    double relative_length(const Vec3 &a, const Vec3 &b) const;

    /// Return whether the relative length is larger, or smaller, than a limit: cheaper than the length
    /// itself.
    bool is_longer(NodeIndex a, NodeIndex b, double limit) const;
    bool is_shorter(NodeIndex a, NodeIndex b, double limit) const;
  };

  /// Writes how a position is found on the mesh as it is, before the change.
  TapeWriter::Slot write(const Placement &placement, const RemeshingContext &context, TapeWriter &tape);

  /// Positions of three nodes.
  std::array<Vec3, 3> corners(const std::array<NodeIndex, 3> &face, const EditableMesh &mesh);

  /// Fills in the qualities before and after, giving up (false) as soon as an added cell is not better than
  /// `bound`, which is at least 0 so that no inverted cell passes.
  bool evaluate(const EditableMesh &mesh, double bound, CavityChange &change);

  /// Smallest quality of some cells; 1 when there are none.
  double minimum_quality(const EditableMesh &mesh, const std::vector<CellIndex> &cells);

  /// Returns whether two triangles face the same way: cosine of the angle of their normals above 0.85.
  bool look_alike(const std::array<Vec3, 3> &a, const std::array<Vec3, 3> &b);

  /// Returns whether faces of the surface would lie deeper in dies than those they are exchanged for, and by more
  /// than the surface may be moved: chords over the edge of a die, behind which metal hides.
  bool hides_metal(const RemeshingContext &context, const CavityChange &change);

  /// The set of positions allowed to a new node of the given kind: anywhere in the interior, on the old
  /// region or on the old curve on the boundary.
  struct Place
  {
    const OldSurface &old_surface;
    NodeKind          kind;
    unsigned int      feature; ///< region or curve
    Vec3              operator()(const Vec3 &x) const;

    /// The point at `part` of the way from x to another, on the planes of the region or curve.
    Vec3 towards(const Vec3 &target, const Vec3 &x, double part) const;
  };

  Place place_of_node(const RemeshingContext &context, NodeIndex node);
  Place place_of_edge(const RemeshingContext &context, NodeIndex a, NodeIndex b);
} // namespace retroforge
