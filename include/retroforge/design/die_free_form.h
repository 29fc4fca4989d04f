// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/numbers.h>
#include <retroforge/geometry/die_parameters.h>
#include <retroforge/mesh/tet_mesh.h>

#include <map>

namespace retroforge
{
  /// Free form of a die of facets: its vertices move by a few modes of its surface (surface_modes),
  ///   x_k = x_k of the die + sum_i mu_i phi_i(k) e_k,
  /// e_k the die's facing, or the surface's normal at the vertex. Where a mode is positive, so is the move
  /// towards the workpiece: a cavity gets less deep.
  ///
  /// Along the facing a vertex stays where it is in plan, so that facets that face the workpiece go on doing
  /// so, whatever the values, and walls keep their draft where the modes do not change across them. Sharp
  /// edges stay sharp, and smooth ones smooth: which they are was decided on the die as made.
  ///
  /// Planes of symmetry of the billet that the die moves in are mirrors of the modes, on a whole die as on
  /// one cut by them, and so are the mirrors asked for. Vertices are folded by reflections into the sector
  /// between them; there a vertex is free, elsewhere it is tied to the facet that its image lies on.
  class DieFreeForm
  {
  public:
    /// A die whose vertices stay.
    DieFreeForm() = default;

    /// @param symmetry  planes of the billet     @throws Error  for fewer vertices than modes, or too many
    DieFreeForm(const DieParameters &die, const std::vector<Plane> &symmetry);

    unsigned int n_modes() const { return moves_.size(); }

    /// phi_i(k) e_k of each vertex: dx/dmu_i.
    const NodalVectors<double> &move(const unsigned int mode) const { return moves_[mode]; }

    /// Vertices of the die as made [mm].
    const NodalVectors<double> &vertices() const { return vertices_; }

    /// Moves vertices by some coefficients [mm].
    /// @throws Error  where a facet would turn by a right angle or more from where it is as made
    template <typename Number>
    void forward(const std::map<unsigned int, Number> &coefficients, NodalVectors<Number> &vertices) const;

    /// Pull-back of forward by one coefficient.
    double reverse(unsigned int mode, const NodalVectors<double> &vertices_bar) const;

  private:
    /// @param x  vertices where the coefficients have them
    void check_facets(const NodalVectors<double> &before, const NodalVectors<double> &x) const;

    std::string                       section_;
    NodalVectors<double>              vertices_;
    std::vector<Triangle>             triangles_;
    std::vector<NodalVectors<double>> moves_;
  };
} // namespace retroforge
