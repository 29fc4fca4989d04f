// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/dual.h>
#include <retroforge/design/first_mesh.h>

namespace retroforge
{
  /// The map from the parameters of the billet's shape to the initial positions of its nodes. The mesh is
  /// made once, at some values, as a rule the nominal ones; there the map is the identity, bit for bit.
  ///
  /// With `volume held by` one parameter nu is no longer free but follows from the others, nu = f(mu), such
  /// that the sum of the tetrahedra's volumes stays,  V(X_0(mu, nu)) = V(X).  f is found by Newton's method
  /// to rounding, its derivative  df/dmu = -(dV/dnu)^-1 dV/dmu  by the implicit function theorem.
  /// @cite Laroussi2003, Eqs. (121)-(126)
  class BilletMap
  {
  public:
    /// @param mesh  made at the nominal values
    /// @throws Error when `volume held by` names no parameter of the shape
    BilletMap(const BilletParameters &billet, const TetMesh &mesh);
    BilletMap(const BilletParameters &billet, const FirstMesh &first);

    /// The free parameters. Those that would move nodes off a symmetry plane are not among them.
    const std::vector<ShapeParameter> &parameters() const { return free_; }

    /// All parameters of the shape, as FirstMesh has them.
    const std::vector<ShapeParameter> &shape_parameters() const { return shapes_.parameters; }

    /// X_0(mu), mu in the order of parameters().
    /// @throws Error when a portion of the contour vanishes or crosses another, when no value of the held
    /// parameter keeps the volume, or when the mesh would be turned inside out
    template <typename Number>
    NodalVectors<Number> positions(const std::vector<Number> &mu) const;

    /// X_bar · dX_0/dmu, for all parameters at once: a product of fields for each, and one gradient of the
    /// volume where that is held.
    std::vector<double> pull_back(const std::vector<double> &mu, const NodalVectors<double> &X_bar) const;

    /// Smallest quality of the cells at X_0(mu), of a mesh turned inside out too: see tet_quality().
    double mesh_quality(const std::vector<double> &mu) const;

    /// Returns the positions of the nodes in the nominal shape, which the mesh need not be able to follow.
    NodalVectors<double> nominal_positions() const;

    /// All parameters of the shape, in the order of FirstMesh, the held one included.
    std::vector<double> all_values(const std::vector<double> &mu) const;

    /// Returns the parameter that holds the volume; null where none does.
    const ShapeParameter *held() const { return held_ ? &shapes_.parameters[*held_] : nullptr; }

    /// f(mu), the value of the parameter that holds the volume.
    template <typename Number>
    Number held_value(const std::vector<Number> &mu) const;

  private:
    template <typename Number>
    NodalVectors<Number> moved(const std::vector<Number> &mu) const;
    template <typename Number>
    NodalVectors<Number> positions(const std::vector<Number> &mu, bool checked) const;
    double               held_by_newton(const NodalVectors<double> &X) const;
    std::vector<double>  all_values(const std::vector<double> &mu, double held) const;
    void                 check(const std::vector<double> &mu, double held) const;
    void                 check_cells(const NodalVectors<double> &X) const;

    NodalVectors<double>                  X_;
    std::vector<std::array<NodeIndex, 4>> cells_;
    double                                volume_;
    BilletShapes                          shapes_;
    std::vector<double>                   at_; ///< values of all parameters at X_
    std::vector<ShapeParameter>           free_;
    std::vector<unsigned int>   place_; ///< position of each free parameter among those of the shape
    std::optional<unsigned int> held_;  ///< position of the held parameter
  };
} // namespace retroforge
