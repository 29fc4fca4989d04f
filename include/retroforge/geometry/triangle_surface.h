// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/geometry/box_tree.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace retroforge
{
  using Triangle = std::array<unsigned int, 3>;

  /// A triangulated surface, open or closed: shared vertices, and who is next to whom. The corners of a facet
  /// run counter-clockwise as seen from the side its normal points to. Edge e of a facet goes from its corner
  /// e to its corner e+1.
  class TriangleSurface
  {
  public:
    struct Edge
    {
      unsigned int facet, edge;
    };

    struct Corner
    {
      unsigned int facet, corner;
    };

    /// @param where  what the surface is called in messages
    /// @throws Error  for no facets, corners that do not exist or are not finite, facets without area or
    /// twice there, edges of more than two facets, neighbours of opposite orientation or folded onto each
    /// other, and cracks: vertices of the rim that nearly touch another part of it
    TriangleSurface(const std::string &where, NodalVectors<double> vertices, std::vector<Triangle> triangles);

    /// Moves the vertices, for differences. Nothing is checked.
    void move_vertices(NodalVectors<double> vertices);

    const NodalVectors<double>  &vertices() const { return vertices_; }
    const std::vector<Triangle> &triangles() const { return triangles_; }
    unsigned int                 n_facets() const { return triangles_.size(); }

    /// The facet's other side of an edge, or facet = invalid_index on the rim.
    Edge neighbour(const unsigned int facet, const unsigned int edge) const
    {
      return neighbours_[facet][edge];
    }

    /// The facets around a vertex, in the order of their indices.
    const std::vector<Corner> &around(const unsigned int vertex) const { return around_[vertex]; }

    bool on_rim(const unsigned int vertex) const { return on_rim_[vertex]; }
    bool is_closed() const;

    /// Corners of the bounding box.
    const std::pair<Vec3, Vec3> &box() const { return box_; }
    double                       diagonal() const { return (box_.second - box_.first).norm(); }

    /// What lies nearer to the surface than this is on it: 1e-5 of the bounding box's diagonal as the surface
    /// was made, that rounded to a power of two.
    double rounding() const { return rounding_width * made_diagonal_; }

    /// The length over which the normal turns at edges and vertices (see project_on_feature): 3e-4 of that
    /// diagonal. A point held at a sharp edge goes another way when it moves by that much, and its derivatives
    /// are as large as its path in an increment over this length: with 1e-5 single edges in the corners of a
    /// pan moved by 70 times what moved them, and had a fifth of the slope of the energy.
    double edge_radius() const { return edge_width * made_diagonal_; }

    std::vector<std::string> remarks; ///< a sentence on each thing in its file that was mended or left out

  private:
    void check_facets(const std::string &where) const;
    void connect(const std::string &where);
    void check_folds(const std::string &where) const;
    void check_cracks(const std::string &where) const;

    NodalVectors<double>             vertices_;
    std::vector<Triangle>            triangles_;
    std::vector<std::array<Edge, 3>> neighbours_;
    std::vector<std::vector<Corner>> around_;
    std::vector<bool>                on_rim_;
    std::pair<Vec3, Vec3>            box_;
    double                           made_diagonal_ = 0.;

    static constexpr double rounding_width = 1e-5, edge_width = 3e-4; ///< of the diagonal
  };

  /// (b - a) x (c - a): along the normal of the facet a, b, c, with twice its area as length.
  template <typename Number>
  Vector3<Number> facet_vector(const Vector3<Number> &a, const Vector3<Number> &b, const Vector3<Number> &c)
  {
    const Vector3<Number> ab = b - a, ac = c - a;
    Vector3<Number>       v;
    for (unsigned int i = 0; i < 3; ++i)
      v[i] = ab[(i + 1) % 3] * ac[(i + 2) % 3] - ab[(i + 2) % 3] * ac[(i + 1) % 3];
    return v;
  }

  /// Corners of the smallest box around points; there must be one.
  std::pair<Vec3, Vec3> bounding_box(const NodalVectors<double> &points);

  /// The box of each facet.
  std::vector<BoundingBox> boxes_of_facets(const TriangleSurface &surface);

  /// Volume enclosed, positive when the normals point outwards: for a surface that is closed.
  double enclosed_volume(const TriangleSurface &surface);

  /// Returns the mean normal of a surface over its area: short where its facets look to all sides, zero where it
  /// is closed.
  Vec3 mean_normal(const TriangleSurface &surface);
} // namespace retroforge
