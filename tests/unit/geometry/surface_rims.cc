// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Rims. Proved: a closed surface has none, a plate one; a hole is found with its edges, length and place; two
// holes that touch at a vertex have one rim, which goes through it twice.

#include <retroforge/geometry/surface_rims.h>

#include <iostream>
#include <set>

#include "geometry_test_tools.h"

using namespace retroforge;

/// A plate of n x n squares of side 1, without some of them.
TriangleSurface plate(const unsigned int n, const std::set<std::pair<unsigned int, unsigned int>> &missing)
{
  NodalVectors<double>  vertices;
  std::vector<Triangle> triangles;
  for (unsigned int i = 0; i <= n; ++i)
    for (unsigned int j = 0; j <= n; ++j)
      vertices.push_back(Vec3({double(i), double(j), 0.}));
  for (unsigned int i = 0; i < n; ++i)
    for (unsigned int j = 0; j < n; ++j)
      if (missing.count({i, j}) == 0)
      {
        const unsigned int a = i * (n + 1) + j, b = a + n + 1;
        triangles.push_back({{a, b, b + 1}});
        triangles.push_back({{a, b + 1, a + 1}});
      }
  return {"plate", vertices, triangles};
}

void show(const std::string &title, const TriangleSurface &surface)
{
  std::cout << title << ':';
  for (const SurfaceRim &rim : find_rims(surface))
    std::cout << "  " << rim.n_edges << " edges, " << rim.length << " mm, around (" << rim.centre[0] << ", "
              << rim.centre[1] << ")";
  std::cout << '\n';
}

int main()
{
  const NodalVectors<double> corners = {
    Vec3({0., 0., 0.}), Vec3({1., 0., 0.}), Vec3({0., 1., 0.}), Vec3({0., 0., 1.})};
  show("tetrahedron", {"tetrahedron", corners, {{{0, 2, 1}}, {{0, 1, 3}}, {{1, 2, 3}}, {{0, 3, 2}}}});
  show("plate", plate(5, {}));
  show("a hole", plate(5, {{1, 2}}));
  show("two holes that touch", plate(5, {{1, 1}, {2, 2}}));
  show("a long hole and a short one", plate(7, {{1, 1}, {1, 2}, {4, 4}}));
}
