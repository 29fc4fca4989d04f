// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/mesh/cell_faces.h>
#include <retroforge/mesh/point_location.h>

#include <algorithm>
#include <limits>

namespace retroforge
{
  namespace
  {
    template <std::size_t n>
    Vec3 combination(const std::array<double, n> &weights, const std::array<Vec3, n> &p)
    {
      Vec3 x;
      for (std::size_t a = 0; a < n; ++a)
        x += weights[a] * p[a];
      return x;
    }

    // Closest point of the sides of a simplex, side `i` having the corners `sides[i]`.
    template <std::size_t n, std::size_t n_side, typename Sides, typename ClosestOnSide>
    std::array<double, n> closest_on_sides(const Vec3                &x,
                                           const std::array<Vec3, n> &p,
                                           const Sides               &sides,
                                           const ClosestOnSide       &closest_on_side)
    {
      std::array<double, n> best        = {};
      double                best_square = std::numeric_limits<double>::max();
      for (const auto &side : sides)
      {
        std::array<Vec3, n_side> corners_of_side;
        for (std::size_t j = 0; j < n_side; ++j)
          corners_of_side[j] = p[side[j]];
        const auto   weights = closest_on_side(x, corners_of_side);
        const double square  = (combination(weights, corners_of_side) - x).norm_square();
        if (square < best_square)
        {
          best_square = square;
          best        = {};
          for (std::size_t j = 0; j < n_side; ++j)
            best[side[j]] = weights[j];
        }
      }
      return best;
    }

    double smallest(const std::array<double, 4> &weights)
    {
      return *std::min_element(weights.begin(), weights.end());
    }

    std::vector<BoundingBox> boxes_of_cells(const TetMesh &mesh, const NodalVectors<double> &X)
    {
      std::vector<BoundingBox> boxes;
      boxes.reserve(mesh.n_cells());
      for (const auto &cell : mesh.cells)
      {
        boxes.emplace_back(X[cell[0]]);
        for (unsigned int a = 1; a < 4; ++a)
          boxes.back().include(X[cell[a]]);
      }
      return boxes;
    }
  } // namespace

  std::array<double, 2> closest_on_segment(const Vec3 &x, const std::array<Vec3, 2> &p)
  {
    const Vec3   edge   = p[1] - p[0];
    const double square = edge.norm_square();
    const double t      = square > 0 ? std::clamp((x - p[0]) * edge / square, 0., 1.) : 0.;
    return {{1 - t, t}};
  }

  std::array<double, 3> closest_on_triangle(const Vec3 &x, const std::array<Vec3, 3> &p)
  {
    const Vec3   normal = cross_product_3d(p[1] - p[0], p[2] - p[0]);
    const double square = normal.norm_square();
    if (square > 0)
    {
      const double w1 = cross_product_3d(x - p[0], p[2] - p[0]) * normal / square;
      const double w2 = cross_product_3d(p[1] - p[0], x - p[0]) * normal / square;
      const double w0 = 1 - w1 - w2;
      if (w0 >= 0 && w1 >= 0 && w2 >= 0)
        return {{w0, w1, w2}};
    }
    constexpr unsigned int edges[3][2] = {{0, 1}, {1, 2}, {2, 0}};
    return closest_on_sides<3, 2>(x, p, edges, closest_on_segment);
  }

  std::array<double, 4> barycentric_coordinates(const Vec3 &x, const TetCorners &p)
  {
    std::array<double, 4> volumes;
    for (unsigned int a = 0; a < 4; ++a)
    {
      TetCorners q = p;
      q[a]         = x;
      volumes[a]   = tet_volume(q);
    }
    const double sum = volumes[0] + volumes[1] + volumes[2] + volumes[3];
    for (double &v : volumes)
      v /= sum;
    return volumes;
  }

  std::array<double, 4> closest_on_tetrahedron(const Vec3 &x, const TetCorners &p)
  {
    const auto inside = barycentric_coordinates(x, p);
    if (smallest(inside) >= 0)
      return inside;
    return closest_on_sides<4, 3>(x, p, tet_face_corners, closest_on_triangle);
  }

  CellLocator::CellLocator(const TetMesh &mesh, const NodalVectors<double> &X)
      : mesh_(mesh), X_(X), tree_(boxes_of_cells(mesh, X))
  {
  }

  CellPoint CellLocator::locate(const Vec3 &x) const
  {
    CellPoint found = {invalid_index, {}};
    double    depth = 0;
    for (const CellIndex c : tree_.containing(x))
    {
      const auto weights = barycentric_coordinates(x, cell_corners(c));
      if (smallest(weights) > depth || (found.cell == invalid_index && smallest(weights) == 0))
      {
        found = {c, weights};
        depth = smallest(weights);
      }
    }
    if (found.cell == invalid_index) // outside, or lost by rounding between two cells
    {
      found.cell    = tree_.closest(x, [&](const unsigned int c) {
        const TetCorners p = cell_corners(c);
        return (combination(closest_on_tetrahedron(x, p), p) - x).norm_square();
      });
      found.weights = closest_on_tetrahedron(x, cell_corners(found.cell));
    }
    return found;
  }
} // namespace retroforge
