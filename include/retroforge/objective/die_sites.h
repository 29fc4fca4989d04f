// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/geometry/box_tree.h>
#include <retroforge/geometry/die.h>
#include <retroforge/mesh/tet_mesh.h>

namespace retroforge
{
  /// Sites on a die that gather what contact points spend on it, as a density per area. They are fixed to the die, half a
  /// reach apart. A point at y gives a site at z the part
  ///   K(z - y) = 3 / (pi r^2) (1 - |z - y|^2 / r^2)^2   of its own,   0 beyond the reach r,
  /// whose integral over a plane is 1: on a die whose curvature is small against 1/r the density is that of the die. Near a
  /// plane of symmetry what lies behind it counts, too: images of the point in the planes that map the die
  /// onto itself, those along the path of the press.
  class DieSites
  {
  public:
    /// Sites in the billet's box, made wider by as much as `spread` of its longest edge to each side, and in the sector that
    /// symmetry planes leave.
    /// @param path   of the press, of any length
    /// @param reach  r [mm]
    DieSites(const Die &die, const TetMesh &billet, const Vec3 &path, double reach);

    std::size_t size() const { return sites_.size(); }

    /// Returns where they are while the die stands at its start [mm].
    const NodalVectors<double> &places() const { return sites_; }

    /// Adds K times an amount to each site's density.
    /// @param y  the point, less the displacement of the die
    template <typename Number>
    void gather(const Vector3<Number> &y, const Number &amount, std::vector<Number> &densities) const;

    struct Sum
    {
      double value = 0.;
      Vec3   gradient; ///< in y
    };

    /// Returns the sum of weight times K over the sites: what gather() multiplies the amount by on the way back.
    Sum sum(const Vec3 &y, const std::vector<double> &weights) const;

    static constexpr double spread = 3.;

  private:
    /// x -> R x + t
    struct Isometry
    {
      dealii::Tensor<2, 3> R;
      Vec3                 t;
    };

    static std::vector<Isometry> images_of(const TetMesh &billet, const Vec3 &path);

    /// Calls f(site, image, R) for all sites within reach of an image of y.
    template <typename Number, typename F>
    void for_each_near(const Vector3<Number> &y, const F &f) const;

    double                reach_;
    NodalVectors<double>  sites_;
    BoxTree               tree_;
    std::vector<Isometry> images_;
  };
} // namespace retroforge
