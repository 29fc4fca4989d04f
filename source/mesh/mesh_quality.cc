// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/mesh/mesh_quality.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace retroforge
{
  namespace
  {
    // The two corners of each edge, and the two others.
    constexpr unsigned int edges[6][4] =
      {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}};

    // Twice the area vector of the face opposite each corner, pointing inwards when V > 0.
    std::array<Vec3, 4> face_normals(const TetCorners &x)
    {
      return {{cross_product_3d(x[3] - x[1], x[2] - x[1]),
               cross_product_3d(x[2] - x[0], x[3] - x[0]),
               cross_product_3d(x[3] - x[0], x[1] - x[0]),
               cross_product_3d(x[1] - x[0], x[2] - x[0])}};
    }
  } // namespace

  TetCorners corners(const std::array<NodeIndex, 4> &cell, const NodalVectors<double> &X)
  {
    Assert(*std::max_element(cell.begin(), cell.end()) < X.size(),
           dealii::ExcMessage("a cell has a node without a position"));
    return {{X[cell[0]], X[cell[1]], X[cell[2]], X[cell[3]]}};
  }

  double tet_volume(const TetCorners &x)
  {
    return cross_product_3d(x[1] - x[0], x[2] - x[0]) * (x[3] - x[0]) / 6;
  }

  double minimum_dihedral_angle(const TetCorners &x)
  {
    if (!(tet_volume(x) > 0))
      return 0;
    const auto normal = face_normals(x);
    double     angle  = 180;
    for (const auto &edge : edges)
    {
      const Vec3  &a = normal[edge[2]], &b = normal[edge[3]];
      const double sine = cross_product_3d(a, b).norm();
      angle             = std::min(angle, std::atan2(sine, -(a * b)) * 180 / M_PI);
    }
    return angle;
  }

  double tet_quality(const TetCorners &x)
  {
    const double six_volume = 6 * tet_volume(x);
    const auto   normal     = face_normals(x);
    double       squares[4], sum = 0, least = std::numeric_limits<double>::max(), most = 0;
    for (unsigned int a = 0; a < 4; ++a)
      squares[a] = normal[a].norm_square();
    // sin = 3 V l / (2 A1 A2), and the normals have twice the areas; one root for all six, this is called
    // often
    for (const auto &edge : edges)
    {
      const double l_square = (x[edge[1]] - x[edge[0]]).norm_square();
      const double areas    = squares[edge[2]] * squares[edge[3]];
      sum += l_square;
      if (areas > 0)
      {
        least = std::min(least, l_square / areas);
        most  = std::max(most, l_square / areas);
      }
    }
    if (!(sum > 0))
      return 0;
    const double length  = std::sqrt(sum / 6);
    const double quality = std::sqrt(2.) * six_volume / (length * length * length);
    return most > 0 ? std::min(quality, six_volume * std::sqrt(six_volume > 0 ? least : most)) : quality;
  }

  double volume(const std::vector<std::array<NodeIndex, 4>> &cells, const NodalVectors<double> &X)
  {
    double sum = 0;
    for (const auto &cell : cells)
      sum += tet_volume(corners(cell, X));
    return sum;
  }

  double minimum_dihedral_angle(const std::vector<std::array<NodeIndex, 4>> &cells,
                                const NodalVectors<double>                  &X)
  {
    double angle = 180;
    for (const auto &cell : cells)
      angle = std::min(angle, minimum_dihedral_angle(corners(cell, X)));
    return angle;
  }

  double minimum_quality(const std::vector<std::array<NodeIndex, 4>> &cells, const NodalVectors<double> &X)
  {
    double quality = std::numeric_limits<double>::max();
    for (const auto &cell : cells)
      quality = std::min(quality, tet_quality(corners(cell, X)));
    return quality;
  }
} // namespace retroforge
