// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/mesh/cell_faces.h>
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/remeshing/trigger.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  namespace
  {
    // The boundary faces, to be asked for by their nodes.
    class BoundaryIndex
    {
    public:
      explicit BoundaryIndex(const TetMesh &mesh)
      {
        keys_.reserve(mesh.faces.size());
        for (const auto &face : mesh.faces)
          keys_.push_back(face_key(face.nodes));
        std::sort(keys_.begin(), keys_.end());
      }

      bool contains(const FaceKey &key) const { return std::binary_search(keys_.begin(), keys_.end(), key); }

    private:
      std::vector<FaceKey> keys_;
    };

    // Smallest angle of a cell, without those between two boundary faces; 0 when it is inverted.
    double free_angle(const std::array<NodeIndex, 4> &cell,
                      const NodalVectors<double>     &X,
                      const BoundaryIndex            &boundary)
    {
      if (!(tet_volume(corners(cell, X)) > 0))
        return 0;
      std::array<bool, 4> is_boundary;
      std::array<Vec3, 4> normal;
      for (unsigned int a = 0; a < 4; ++a)
      {
        const auto                    &local = tet_face_corners[a];
        const std::array<NodeIndex, 3> nodes = {{cell[local[0]], cell[local[1]], cell[local[2]]}};
        is_boundary[a]                       = boundary.contains(face_key(nodes));
        normal[a] = cross_product_3d(X[nodes[1]] - X[nodes[0]], X[nodes[2]] - X[nodes[0]]);
      }
      double angle = 180;
      for (unsigned int a = 0; a < 4; ++a)
        for (unsigned int b = a + 1; b < 4; ++b)
          if (!is_boundary[a] || !is_boundary[b])
          {
            const double sine = cross_product_3d(normal[a], normal[b]).norm();
            angle             = std::min(angle, std::atan2(sine, -(normal[a] * normal[b])) * 180 / M_PI);
          }
      return angle;
    }

    // The sines in the quality bound every angle, and cost less.
    bool may_have_angle_below(const std::array<NodeIndex, 4> &cell,
                              const NodalVectors<double>     &X,
                              const double                    degrees)
    {
      return !(tet_quality(corners(cell, X)) >= std::sin(degrees * M_PI / 180));
    }

    std::vector<CellIndex> suspects(const TetMesh &mesh, const NodalVectors<double> &X, const double degrees)
    {
      std::vector<CellIndex> found;
      for (CellIndex c = 0; c < mesh.n_cells(); ++c)
        if (may_have_angle_below(mesh.cells[c], X, degrees))
          found.push_back(c);
      return found;
    }
  } // namespace

  std::vector<bool> frozen_cells(const TetMesh &mesh, const RemeshingParameters &parameters)
  {
    std::vector<bool>   frozen(mesh.n_cells(), false);
    const BoundaryIndex boundary(mesh);
    for (const CellIndex c : suspects(mesh, mesh.X, parameters.trigger_angle))
      frozen[c] = free_angle(mesh.cells[c], mesh.X, boundary) < parameters.trigger_angle;
    return frozen;
  }

  bool needs_remeshing(const TetMesh              &mesh,
                       const NodalVectors<double> &X,
                       const RemeshingParameters  &parameters,
                       const std::vector<bool>    &frozen)
  {
    AssertDimension(X.size(), mesh.n_nodes());
    Assert(frozen.empty() || frozen.size() == mesh.n_cells(),
           dealii::ExcDimensionMismatch(frozen.size(), mesh.n_cells()));
    const auto bad = suspects(mesh, X, parameters.trigger_angle);
    if (bad.empty())
      return false;
    const BoundaryIndex boundary(mesh);
    return std::any_of(bad.begin(), bad.end(), [&](const CellIndex c) {
      const double allowed = !frozen.empty() && frozen[c] ? free_angle(mesh.cells[c], mesh.X, boundary) / 2
                                                          : parameters.trigger_angle;
      const double angle   = free_angle(mesh.cells[c], X, boundary);
      return !(angle >= allowed);
    });
  }

  double minimum_free_angle(const TetMesh &mesh, const NodalVectors<double> &X)
  {
    const BoundaryIndex boundary(mesh);
    double              angle = 180;
    for (const auto &cell : mesh.cells)
      angle = std::min(angle, free_angle(cell, X, boundary));
    return angle;
  }
} // namespace retroforge
