// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/mesh/point_location.h>
#include <retroforge/mesh/self_crossing.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace retroforge
{
  namespace
  {
    using Corners = std::array<Vec3, 3>;

    Corners triangle(const BoundaryFace &face, const NodalVectors<double> &X)
    {
      return {{X[face.nodes[0]], X[face.nodes[1]], X[face.nodes[2]]}};
    }

    // Whether the segment passes through the inside of the triangle: its ends lie on either side, and the
    // volumes it spans with the three edges have one sign.
    bool crosses(const Vec3 &a, const Vec3 &b, const Corners &x)
    {
      const double at_a = tet_volume({{x[0], x[1], x[2], a}}), at_b = tet_volume({{x[0], x[1], x[2], b}});
      // In one plane (a patch of symmetry) all these volumes are rounding.
      const double area = cross_product_3d(x[1] - x[0], x[2] - x[0]).norm();
      const double none = 1e-9 * area * ((b - a).norm() + std::sqrt(area));
      if (!((at_a > none && at_b < -none) || (at_a < -none && at_b > none)))
        return false;
      double least = 0, most = 0;
      for (unsigned int i = 0; i < 3; ++i)
      {
        const double volume = tet_volume({{a, b, x[i], x[(i + 1) % 3]}});
        least               = i == 0 ? volume : std::min(least, volume);
        most                = i == 0 ? volume : std::max(most, volume);
      }
      return least > 0 || most < 0;
    }

    bool has_node(const BoundaryFace &face, const NodeIndex node)
    {
      return std::find(face.nodes.begin(), face.nodes.end(), node) != face.nodes.end();
    }

    void
    throw_crossing(const TetMesh &mesh, const BoundaryFace &face, const Vec3 &x, const std::string &where)
    {
      std::ostringstream what;
      what << "the boundary crosses itself in a face of the patch `" << mesh.patches[face.patch].name
           << "' near (" << x[0] << ", " << x[1] << ", " << x[2] << ")";
      throw Error(where,
                  what.str(),
                  "the surface of the workpiece may touch itself, but not pass through itself",
                  "use smaller increments or elements there, or stop before the fold closes");
    }
  } // namespace

  std::vector<SelfCrossing> self_crossings(const TetMesh &mesh, const NodalVectors<double> &X)
  {
    AssertDimension(X.size(), mesh.n_nodes());
    std::vector<BoundingBox> boxes;
    for (const auto &face : mesh.faces)
      boxes.emplace_back(triangle(face, X));
    const BoxTree             tree(boxes);
    std::vector<SelfCrossing> found;
    for (const auto &face : mesh.faces)
      for (unsigned int i = 0; i < 3; ++i)
      {
        const NodeIndex a = face.nodes[i], b = face.nodes[(i + 1) % 3];
        if (a > b) // the face on the other side has this edge as (b, a)
          continue;
        for (const unsigned int f : tree.intersecting(BoundingBox(std::array<Vec3, 2>{{X[a], X[b]}})))
        {
          const auto &other = mesh.faces[f];
          if (!has_node(other, a) && !has_node(other, b) && crosses(X[a], X[b], triangle(other, X)))
            found.push_back({{{a, b}}, f});
        }
      }
    return found;
  }

  void
  check_boundary_does_not_cross(const TetMesh &mesh, const NodalVectors<double> &X, const std::string &where)
  {
    const auto all = self_crossings(mesh, X);
    if (!all.empty())
      throw_crossing(mesh, mesh.faces[all[0].face], 0.5 * (X[all[0].edge[0]] + X[all[0].edge[1]]), where);
  }
} // namespace retroforge
