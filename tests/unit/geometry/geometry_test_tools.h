// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/geometry/triangle_surface.h>

#include <cmath>
#include <map>

namespace retroforge
{
  /// A unit sphere: an octahedron halved n times, its vertices on the sphere.
  inline TriangleSurface sphere(const unsigned int n)
  {
    NodalVectors<double>  x = {Vec3({1, 0, 0}),
                               Vec3({0, 1, 0}),
                               Vec3({-1, 0, 0}),
                               Vec3({0, -1, 0}),
                               Vec3({0, 0, 1}),
                               Vec3({0, 0, -1})};
    std::vector<Triangle> t = {
      {{0, 1, 4}}, {{1, 2, 4}}, {{2, 3, 4}}, {{3, 0, 4}}, {{1, 0, 5}}, {{2, 1, 5}}, {{3, 2, 5}}, {{0, 3, 5}}};
    for (unsigned int i = 0; i < n; ++i)
    {
      std::map<std::pair<unsigned int, unsigned int>, unsigned int> middles;
      const auto middle = [&](const unsigned int a, const unsigned int b) {
        const auto [found, is_new] = middles.insert({std::minmax(a, b), x.size()});
        if (is_new)
          x.push_back((x[a] + x[b]) / (x[a] + x[b]).norm());
        return found->second;
      };
      std::vector<Triangle> finer;
      for (const Triangle &f : t)
      {
        const unsigned int ab = middle(f[0], f[1]), bc = middle(f[1], f[2]), ca = middle(f[2], f[0]);
        finer.insert(finer.end(), {{{f[0], ab, ca}}, {{f[1], bc, ab}}, {{f[2], ca, bc}}, {{ab, bc, ca}}});
      }
      t = finer;
    }
    return TriangleSurface("sphere", x, t);
  }

  /// A closed surface with hills, valleys, and edges and vertices of all kinds.
  inline TriangleSurface bumpy_sphere(const unsigned int n)
  {
    TriangleSurface      surface = sphere(n);
    NodalVectors<double> x       = surface.vertices();
    for (unsigned int v = 0; v < x.size(); ++v)
      x[v] *= 1. + 0.3 * std::sin(7. * x[v][0] + 5. * x[v][1]) * std::cos(4. * x[v][2]) + 0.05 * (v % 3);
    return TriangleSurface("bumpy sphere", x, surface.triangles());
  }

  /// An open sheet over [-1, 1]^2 of n x n squares, facing up, of the given height at its vertices.
  template <typename Height>
  TriangleSurface sheet(const unsigned int n, const Height &height)
  {
    NodalVectors<double>  x;
    std::vector<Triangle> t;
    for (unsigned int j = 0; j <= n; ++j)
      for (unsigned int i = 0; i <= n; ++i)
      {
        const double a = -1. + 2. * i / n, b = -1. + 2. * j / n;
        x.push_back(Vec3({a, b, height(a, b)}));
      }
    for (unsigned int j = 0; j < n; ++j)
      for (unsigned int i = 0; i < n; ++i)
      {
        const unsigned int k = j * (n + 1) + i;
        t.insert(t.end(), {{{k, k + 1, k + n + 2}}, {{k, k + n + 2, k + n + 1}}});
      }
    return TriangleSurface("sheet", x, t);
  }

  /// The cube [0, 1]^3, where many features are equally close to many points.
  inline TriangleSurface cube()
  {
    NodalVectors<double> x;
    for (unsigned int v = 0; v < 8; ++v)
      x.push_back(Vec3({1. * (v & 1), 1. * (v >> 1 & 1), 1. * (v >> 2)}));
    return TriangleSurface("cube",
                           x,
                           {{{0, 2, 1}},
                            {{1, 2, 3}},
                            {{4, 5, 6}},
                            {{5, 7, 6}},
                            {{0, 1, 4}},
                            {{1, 5, 4}},
                            {{2, 6, 3}},
                            {{3, 6, 7}},
                            {{0, 4, 2}},
                            {{2, 4, 6}},
                            {{1, 3, 5}},
                            {{3, 7, 5}}});
  }

  inline const char *yes(const bool condition)
  {
    return condition ? "yes" : "NO";
  }
} // namespace retroforge
