// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/point_location.h>
#include <retroforge/mesh/tet_mesh.h>

#include <vector>

namespace retroforge
{
  /// The patches of the faces at a node, ascending: none inside, one on a face, two on a ridge, more in a
  /// corner.
  using PatchSet = std::vector<unsigned int>;
  std::vector<PatchSet> patches_at_nodes(const TetMesh &mesh);

  /// A point of the boundary:  sum weights_i X[nodes_i],  weights >= 0, sum 1; one to three nodes.
  struct BoundaryPoint
  {
    std::vector<NodeIndex> nodes;
    std::vector<double>    weights;
    PatchSet               patches; ///< patches of the node, edge or face it lies in
  };

  /// Finds the closest point of the boundary that belongs to given patches.
  class BoundaryLocator
  {
  public:
    /// Keeps a reference to X.
    BoundaryLocator(const TetMesh &mesh, const NodalVectors<double> &X);

    /// Closest point of what the patches have in common: of the faces of one patch, of the ridge (the edges
    /// between faces of different patches) of two, of the corner nodes of three or more. What does not exist
    /// is replaced by the next larger part of the boundary: ridges of some two of the patches, faces of some
    /// of them, all faces.
    BoundaryPoint locate(const Vec3 &x, const PatchSet &patches) const;

  private:
    /// One node, edge or face of the boundary, and what it belongs to.
    struct Feature
    {
      PatchSet                 patches;
      std::array<NodeIndex, 3> nodes;
    };

    /// The features of one kind that belong to the same patches.
    struct Group
    {
      PatchSet                              patches;
      unsigned int                          n_corners;
      std::vector<std::array<NodeIndex, 3>> features;
      BoxTree                               tree;
    };

    void          add_groups(std::vector<Feature> features, const unsigned int n_corners);
    BoundaryPoint point_on(const Group &group, const unsigned int feature, const Vec3 &x) const;
    double        square_distance(const BoundaryPoint &point, const Vec3 &x) const;
    template <typename Condition>
    BoundaryPoint closest_of(const Vec3 &x, const unsigned int n_corners, const Condition &condition) const;

    const NodalVectors<double> &X_;
    std::vector<Group>          groups_; ///< nodes, edges, faces, each sorted by patches
  };
} // namespace retroforge
