// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/geometry/triangle_surface.h>

#include <string>
#include <vector>

namespace retroforge
{
  /// A facet whose height over its longest edge is a smaller part of it has no area.
  constexpr double least_facet_height = 1e-9;

  /// Facets that share vertices, not checked yet.
  struct Facets
  {
    NodalVectors<double>  vertices;
    std::vector<Triangle> triangles;
    NodalVectors<double>  normals; ///< as the file gives them for each triangle; zero: not given
  };

  /// Gives corners that are nearer to each other than `distance` one vertex; three corners make a facet.
  /// Vertices are numbered as they first appear.
  Facets
  merge_corners(const NodalVectors<double> &corners, const NodalVectors<double> &normals, double distance);

  /// Mends what exporters do to surfaces and what leaves the surface where it is: joins vertices of the rim
  /// nearer to each other than `seam`, which rounding took apart; leaves out facets with two equal corners
  /// and those that are there twice; and where a facet has no height over its longest edge, leaves it out and
  /// divides its neighbour there; and turns facets that show another side than the rest of their piece, where
  /// these are no more than a fifth of its area. Vertices that are then unused are left out.
  /// @return what was done, a sentence each
  std::vector<std::string> mend(Facets &facets, double seam);

  struct NormalsAgainst
  {
    unsigned int n       = 0;
    unsigned int first   = invalid_index; ///< facet
    bool         are_few = true;          ///< no more than a fifth of the area that has normals
  };

  /// Given normals that point against the order of the corners, counter-clockwise as seen from their side.
  NormalsAgainst normals_against_corners(const Facets &facets);
} // namespace retroforge
