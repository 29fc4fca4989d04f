// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/remeshing/surface_features.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace retroforge
{
  namespace
  {
    constexpr double degree = M_PI / 180;

    // Components of the faces, joined edge by edge.
    class FaceGroups
    {
    public:
      explicit FaceGroups(const unsigned int n_faces) : parent_(n_faces)
      {
        std::iota(parent_.begin(), parent_.end(), 0);
      }

      unsigned int root(unsigned int face)
      {
        while (parent_[face] != face)
          face = parent_[face] = parent_[parent_[face]];
        return face;
      }

      void join(const unsigned int a, const unsigned int b)
      {
        const unsigned int x = root(a), y = root(b);
        parent_[std::max(x, y)] = std::min(x, y);
      }

    private:
      std::vector<unsigned int> parent_;
    };

    // A ridge as seen from one of its nodes.
    struct RidgeAtNode
    {
      NodeIndex                   other;
      std::array<unsigned int, 2> regions;
      bool                        is_walked = false;
    };
    using RidgesByNode = std::map<NodeIndex, std::vector<RidgeAtNode>>;

    // A chord that turns by 40 degrees is 0.09 of its length deep; faces on the planes of a sharp die, none.
    bool cuts_into_die(const BoundaryFace &face, const NodalVectors<double> &X, const PushOut &push_out)
    {
      if (!push_out)
        return false;
      const Vec3  &a = X[face.nodes[0]], &b = X[face.nodes[1]], &c = X[face.nodes[2]];
      const Vec3   middle = (a + b + c) / 3.;
      const double length = std::sqrt(cross_product_3d(b - a, c - a).norm());
      return (push_out(middle) - middle).norm() > 0.03 * length;
    }

    std::vector<SurfaceEdge> ridge_edges(const TetMesh                  &mesh,
                                         const NodalVectors<double>     &X,
                                         const std::vector<SurfaceEdge> &edges,
                                         const double                    ridge_angle,
                                         const PushOut                  &push_out)
    {
      const auto               normals = face_unit_normals(mesh.faces, X);
      const double             cosine  = std::cos(ridge_angle * degree);
      std::vector<SurfaceEdge> ridges;
      for (const auto &edge : edges)
      {
        const auto [f, g] = edge.faces;
        if (mesh.faces[f].patch != mesh.faces[g].patch ||
            (normals[f] * normals[g] < cosine && !cuts_into_die(mesh.faces[f], X, push_out) &&
             !cuts_into_die(mesh.faces[g], X, push_out)))
          ridges.push_back(edge);
      }
      return ridges;
    }

    // Faces reached from one another without crossing a ridge, numbered by their first face.
    void find_regions(const TetMesh                  &mesh,
                      const std::vector<SurfaceEdge> &edges,
                      const std::vector<SurfaceEdge> &ridges,
                      SurfaceFeatures                &features)
    {
      FaceGroups groups(mesh.faces.size());
      auto       ridge = ridges.begin();
      for (const auto &edge : edges)
        if (ridge != ridges.end() && ridge->nodes == edge.nodes)
          ++ridge;
        else
          groups.join(edge.faces[0], edge.faces[1]);
      features.region_of_face.resize(mesh.faces.size());
      for (unsigned int f = 0; f < mesh.faces.size(); ++f)
        if (groups.root(f) == f)
        {
          features.region_of_face[f] = features.patch_of_region.size();
          features.patch_of_region.push_back(mesh.faces[f].patch);
        }
        else
          features.region_of_face[f] = features.region_of_face[groups.root(f)];
    }

    bool turns(const NodalVectors<double> &X,
               const NodeIndex             before,
               const NodeIndex             node,
               const NodeIndex             after,
               const double                angle)
    {
      const Vec3 a = X[node] - X[before], b = X[after] - X[node];
      return a * b < std::cos(angle * degree) * a.norm() * b.norm();
    }

    RidgeAtNode &find_ridge(RidgesByNode &ridges, const NodeIndex from, const NodeIndex to)
    {
      auto &list = ridges[from];
      return *std::find_if(list.begin(), list.end(), [&](const RidgeAtNode &r) { return r.other == to; });
    }

    // Follows ridges from a node until a corner or the start.
    SurfaceFeatures::Curve
    walk(RidgesByNode &ridges, const std::vector<bool> &is_corner, const NodeIndex start, NodeIndex next)
    {
      SurfaceFeatures::Curve curve = {{start}, find_ridge(ridges, start, next).regions};
      while (true)
      {
        const NodeIndex at                     = curve.nodes.back();
        find_ridge(ridges, at, next).is_walked = true;
        find_ridge(ridges, next, at).is_walked = true;
        curve.nodes.push_back(next);
        if (next == start || is_corner[next])
          return curve;
        const auto &two = ridges[next];
        next            = two[0].other == at ? two[1].other : two[0].other;
      }
    }

    void find_curves(RidgesByNode &ridges, SurfaceFeatures &features)
    {
      for (const bool from_corners : {true, false})
        for (auto &[node, list] : ridges)
          if (features.is_corner[node] == from_corners)
            for (auto &ridge : list)
              if (!ridge.is_walked)
                features.curves.push_back(walk(ridges, features.is_corner, node, ridge.other));
    }
  } // namespace

  std::vector<SurfaceEdge> surface_edges(const std::vector<BoundaryFace> &faces)
  {
    std::vector<SurfaceEdge> half;
    half.reserve(3 * faces.size());
    for (unsigned int f = 0; f < faces.size(); ++f)
      for (unsigned int i = 0; i < 3; ++i)
      {
        const auto [a, b] = std::minmax(faces[f].nodes[i], faces[f].nodes[(i + 1) % 3]);
        half.push_back({{{a, b}}, {{f, f}}});
      }
    std::sort(half.begin(), half.end(), [](const SurfaceEdge &a, const SurfaceEdge &b) {
      return a.nodes != b.nodes ? a.nodes < b.nodes : a.faces < b.faces;
    });
    std::vector<SurfaceEdge> edges;
    edges.reserve(half.size() / 2);
    for (std::size_t i = 0; i + 1 < half.size(); i += 2)
      edges.push_back({half[i].nodes, {{half[i].faces[0], half[i + 1].faces[0]}}});
    return edges;
  }

  std::vector<Vec3> face_unit_normals(const std::vector<BoundaryFace> &faces, const NodalVectors<double> &X)
  {
    std::vector<Vec3> normals;
    normals.reserve(faces.size());
    for (const auto &face : faces)
    {
      const Vec3  &a      = X[face.nodes[0]];
      const Vec3   normal = cross_product_3d(X[face.nodes[1]] - a, X[face.nodes[2]] - a);
      const double length = normal.norm();
      normals.push_back(length > 0 ? normal / length : normal);
    }
    return normals;
  }

  SurfaceFeatures::SurfaceFeatures(const TetMesh              &mesh,
                                   const NodalVectors<double> &X,
                                   const double                ridge_angle,
                                   const double                corner_angle,
                                   const PushOut              &push_out)
      : is_corner(mesh.n_nodes(), false)
  {
    const auto edges  = surface_edges(mesh.faces);
    const auto ridges = ridge_edges(mesh, X, edges, ridge_angle, push_out);
    find_regions(mesh, edges, ridges, *this);

    RidgesByNode at_node;
    for (const auto &ridge : ridges)
      for (unsigned int end = 0; end < 2; ++end)
        at_node[ridge.nodes[end]].push_back(
          {ridge.nodes[1 - end], {{region_of_face[ridge.faces[0]], region_of_face[ridge.faces[1]]}}});
    for (const auto &[node, list] : at_node)
      is_corner[node] = list.size() != 2 || turns(X, list[0].other, node, list[1].other, corner_angle);
    find_curves(at_node, *this);
  }
} // namespace retroforge
