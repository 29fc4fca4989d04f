// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/contact/metal_surface.h>
#include <retroforge/geometry/vector_algebra.h>
#include <retroforge/mesh/point_location.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace retroforge
{
  namespace
  {
    constexpr double largest_hollow_angle = 45.; // degrees
    constexpr double most_fine_triangles  = 5e5;
    constexpr double most_cuts            = 32.; // of an edge

    std::vector<BoundingBox> boxes_of(const NodalVectors<double> &x, const std::vector<Triangle> &triangles)
    {
      std::vector<BoundingBox> boxes;
      boxes.reserve(triangles.size());
      for (const Triangle &t : triangles)
      {
        boxes.emplace_back(x[t[0]]);
        boxes.back().include(x[t[1]]);
        boxes.back().include(x[t[2]]);
      }
      return boxes;
    }

    BoundingBox box_of(const NodalVectors<double> &x)
    {
      BoundingBox box(x.at(0));
      for (const Vec3 &point : x)
        box.include(point);
      return box;
    }

    double angle_at(const Vec3 &x, const Vec3 &a, const Vec3 &b)
    {
      return angle_between(a - x, b - x);
    }

    /// Points and triangles of faces whose edges are cut into n parts; points of an edge are shared.
    class CutFaces
    {
    public:
      /// @param first  positions to begin with: the nodes'
      CutFaces(const NodalVectors<double> &first, const unsigned int n) : n_(n), X(first) {}

      void add(const BoundaryFace &face)
      {
        const auto &[a, b, c] = face.nodes;
        // Point (i, j): i parts towards b, j towards c.
        std::vector<std::vector<NodeIndex>> at(n_ + 1);
        for (unsigned int i = 0; i <= n_; ++i)
          for (unsigned int j = 0; i + j <= n_; ++j)
            at[i].push_back(j == 0        ? on_edge(a, b, i)
                            : i == 0      ? on_edge(a, c, j)
                            : i + j == n_ ? on_edge(b, c, j)
                                          : inside(face, i, j));
        for (unsigned int i = 0; i < n_; ++i)
          for (unsigned int j = 0; i + j < n_; ++j)
          {
            faces.push_back({{{at[i][j], at[i + 1][j], at[i][j + 1]}}, face.patch});
            if (i + j + 1 < n_)
              faces.push_back({{{at[i + 1][j], at[i + 1][j + 1], at[i][j + 1]}}, face.patch});
          }
      }

    private:
      NodeIndex on_edge(const NodeIndex a, const NodeIndex b, const unsigned int i)
      {
        if (i == 0 || i == n_)
          return i == 0 ? a : b;
        if (a > b)
          return on_edge(b, a, n_ - i);
        const auto [place, is_new] = edges_.insert({{a, b}, static_cast<NodeIndex>(X.size())});
        if (is_new)
          for (unsigned int k = 1; k < n_; ++k)
            X.push_back(X[a] + (double(k) / n_) * (X[b] - X[a]));
        return place->second + i - 1;
      }

      NodeIndex inside(const BoundaryFace &face, const unsigned int i, const unsigned int j)
      {
        const Vec3 &a = X[face.nodes[0]], &b = X[face.nodes[1]], &c = X[face.nodes[2]];
        const Vec3  x = a + (double(i) / n_) * (b - a) + (double(j) / n_) * (c - a);
        X.push_back(x);
        return X.size() - 1;
      }

      const unsigned int                                   n_;
      std::map<std::pair<NodeIndex, NodeIndex>, NodeIndex> edges_; ///< the first point in each

    public:
      NodalVectors<double>      X;
      std::vector<BoundaryFace> faces;
    };

    /// The boundary of a mesh, its edges cut into n parts.
    TetMesh cut_boundary(const TetMesh &mesh, const unsigned int n)
    {
      CutFaces cut(mesh.X, n);
      for (const BoundaryFace &face : mesh.faces)
        cut.add(face);
      return {cut.X, {}, cut.faces, mesh.patches, {}, {}};
    }

    /// Returns the displacements of points when they are put on the billet's shape.
    NodalVectors<double> lifts(const BilletParameters &billet, const TetMesh &cut)
    {
      TetMesh snapped = cut;
      snap_to_shape(billet, snapped);
      for (std::size_t k = 0; k < cut.X.size(); ++k)
        snapped.X[k] -= cut.X[k];
      return snapped.X;
    }

    double longest(const NodalVectors<double> &vectors)
    {
      double longest = 0.;
      for (const Vec3 &v : vectors)
        longest = std::max(longest, v.norm());
      return longest;
    }
  } // namespace

  MetalSurface::MetalSurface(NodalVectors<double>  vertices,
                             std::vector<Triangle> triangles,
                             std::vector<Plane>    symmetry)
      : vertices_(std::move(vertices))
      , triangles_(std::move(triangles))
      , symmetry_(std::move(symmetry))
      , vertex_normals_(vertices_.size())
      , hollow_(triangles_.size(), 0.)
      , box_(box_of(vertices_))
      , tree_(boxes_of(vertices_, triangles_))
  {
    rounding_ = 1e-9 * (box_.upper - box_.lower).norm();
    std::map<Edge, std::vector<unsigned int>> edges;
    for (unsigned int t = 0; t < triangles_.size(); ++t)
    {
      const auto x = corners(t);
      Vec3       n = facet_vector(x[0], x[1], x[2]);
      n /= std::max(n.norm(), std::numeric_limits<double>::min());
      face_normals_.push_back(n);
      for (unsigned int c = 0; c < 3; ++c)
      {
        vertex_normals_[triangles_[t][c]] += angle_at(x[c], x[(c + 1) % 3], x[(c + 2) % 3]) * n;
        edges[std::minmax(triangles_[t][c], triangles_[t][(c + 1) % 3])].push_back(t);
      }
    }
    for (unsigned int v = 0; v < vertices_.size(); ++v)
      vertex_normals_[v] = mirrored(vertex_normals_[v], {v});
    for (const auto &[ends, sides] : edges)
    {
      Vec3 n;
      for (const unsigned int t : sides)
        n += face_normals_[t];
      edge_normals_.push_back({ends, mirrored(n, {ends.first, ends.second})});
      if (sides.size() != 2)
        continue;
      const Vec3  &a = face_normals_[sides[0]], &b = face_normals_[sides[1]];
      const Vec3   middle        = 0.5 * (vertices_[ends.first] + vertices_[ends.second]);
      const double angle         = angle_between(a, b);
      const auto   x             = corners(sides[1]);
      const bool   turns_inwards = ((x[0] + x[1] + x[2]) / 3. - middle) * a > 0.;
      if (turns_inwards && angle < largest_hollow_angle * M_PI / 180.)
        for (const unsigned int t : sides)
        {
          const auto   y = corners(t);
          const double height =
            facet_vector(y[0], y[1], y[2]).norm() / (vertices_[ends.first] - vertices_[ends.second]).norm();
          hollow_[t] = std::max(hollow_[t], height * angle / 8.);
        }
    }
  }

  std::array<Vec3, 3> MetalSurface::corners(const unsigned int triangle) const
  {
    const Triangle &t = triangles_[triangle];
    return {{vertices_[t[0]], vertices_[t[1]], vertices_[t[2]]}};
  }

  Vec3 MetalSurface::mirrored(Vec3 normal, const std::vector<unsigned int> &vertices) const
  {
    std::vector<Vec3> across;
    for (const Plane &plane : symmetry_)
      if (std::all_of(vertices.begin(), vertices.end(), [&](const unsigned int v) {
            return std::abs((vertices_[v] - plane.point) * plane.normal) <= rounding_;
          }))
      {
        Vec3 n = plane.normal;
        for (const Vec3 &other : across)
          n -= (n * other) * other;
        if (n.norm() > 1e-6)
          across.push_back(n / n.norm());
      }
    for (const Vec3 &n : across)
      normal -= (normal * n) * n;
    return normal;
  }

  Vec3 MetalSurface::normal_at(const unsigned int triangle, const std::array<double, 3> &weights) const
  {
    const Triangle &t = triangles_[triangle];
    for (unsigned int c = 0; c < 3; ++c)
      if (weights[c] == 1.)
        return vertex_normals_[t[c]];
    for (unsigned int c = 0; c < 3; ++c)
      if (weights[c] == 0.)
      {
        const Edge edge  = std::minmax(t[(c + 1) % 3], t[(c + 2) % 3]);
        const auto found = std::lower_bound(edge_normals_.begin(),
                                            edge_normals_.end(),
                                            edge,
                                            [](const auto &a, const Edge &b) { return a.first < b; });
        return found->second;
      }
    return face_normals_[triangle];
  }

  MetalSurface::Foot MetalSurface::closest(const Vec3 &x) const
  {
    const auto point = [&](const std::array<double, 3> &w, const std::array<Vec3, 3> &p) {
      return Vec3(w[0] * p[0] + w[1] * p[1] + w[2] * p[2]);
    };
    const unsigned int found   = tree_.closest(x, [&](const unsigned int t) {
      const auto p = corners(t);
      return (x - point(closest_on_triangle(x, p), p)).norm_square();
    });
    const auto         p       = corners(found);
    const auto         weights = closest_on_triangle(x, p);
    const Vec3         place   = point(weights, p);
    const double       away    = (x - place).norm();
    return {(x - place) * normal_at(found, weights) < 0. ? -away : away, place, found};
  }

  bool MetalSurface::is_beyond(const Vec3 &x) const
  {
    return std::any_of(symmetry_.begin(), symmetry_.end(), [&](const Plane &plane) {
      return (x - plane.point) * plane.normal > rounding_;
    });
  }

  Vec3 MetalSurface::along_symmetry(const Vec3 &direction) const
  {
    Vec3              along = direction;
    std::vector<Vec3> across; // orthonormal
    for (const Plane &plane : symmetry_)
    {
      Vec3 n = plane.normal;
      for (const Vec3 &other : across)
        n -= (n * other) * other;
      if (n.norm() < 1e-6)
        continue;
      across.push_back(n / n.norm());
      along -= (along * across.back()) * across.back();
    }
    return along.norm() > 1e-6 * direction.norm() ? along : Vec3();
  }

  namespace
  {
    MetalSurface surface_of_faces(const TetMesh &mesh, const NodalVectors<double> &X)
    {
      std::vector<unsigned int> number(X.size(), invalid_index);
      NodalVectors<double>      vertices;
      std::vector<Triangle>     triangles;
      for (const BoundaryFace &face : mesh.faces)
        if (mesh.is_surface(face))
        {
          Triangle t;
          for (unsigned int c = 0; c < 3; ++c)
          {
            unsigned int &n = number[face.nodes[c]];
            if (n == invalid_index)
            {
              n = vertices.size();
              vertices.push_back(X[face.nodes[c]]);
            }
            t[c] = n;
          }
          triangles.push_back(t);
        }
      std::vector<Plane> symmetry;
      for (const Patch &patch : mesh.patches)
        if (patch.symmetry)
          symmetry.push_back(*patch.symmetry);
      return MetalSurface(std::move(vertices), std::move(triangles), std::move(symmetry));
    }
  } // namespace

  MetalSurface metal_surface(const TetMesh &mesh, const NodalVectors<double> &X)
  {
    return surface_of_faces(mesh, X);
  }

  MetalSurface billet_surface(const BilletParameters     &billet,
                              const TetMesh              &mesh,
                              const NodalVectors<double> &X,
                              const double                tolerance)
  {
    const NodalVectors<double> halved = lifts(billet, cut_boundary(mesh, 2));
    const double               bulge  = longest(halved);
    // A mesh that the billet's measures do not describe has nodes elsewhere.
    if (longest(NodalVectors<double>(halved.begin(), halved.begin() + mesh.n_nodes())) > tolerance)
      return metal_surface(mesh, X);
    const double wanted = std::ceil(std::sqrt(bulge / tolerance)),
                 most   = std::min(most_cuts, std::sqrt(most_fine_triangles / mesh.faces.size()));
    if (!(bulge > tolerance && most >= 2.))
      return metal_surface(mesh, X);
    const TetMesh              cut   = cut_boundary(mesh, static_cast<unsigned int>(std::min(wanted, most)));
    const NodalVectors<double> lift  = lifts(billet, cut);
    TetMesh                    moved = mesh;
    moved.X                          = X;
    moved                            = cut_boundary(moved, static_cast<unsigned int>(std::min(wanted, most)));
    for (std::size_t k = 0; k < lift.size(); ++k)
      moved.X[k] += lift[k];
    return surface_of_faces(moved, moved.X);
  }
} // namespace retroforge
