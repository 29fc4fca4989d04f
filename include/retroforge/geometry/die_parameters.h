// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/choice.h>
#include <retroforge/geometry/die.h>
#include <retroforge/geometry/die_shapes.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/tensor.h>

#include <map>

namespace retroforge
{
  /// What a parameter file says about a die.
  ///
  /// A plane goes through `point`. A tripod or bell has its origin there and its z axis along `facing`,
  /// turned about it by `angle`: x' = point + R x, R the rotation that takes z to `facing` the short way (for
  /// facing = -z: half a turn about the x axis) after the turn about z. The surface of an STL file stands as
  /// drawn, scaled, turned by `angle` about `axis` and moved by `point`; there `facing` only says along which
  /// way `die NAME/offset` moves it.
  struct DieParameters
  {
    std::string name;
    std::string shape = "plane";
    Vec3        point;
    Vec3        facing;
    Vec3        velocity;
    double      friction       = 0.;
    bool        follows_billet = false;
    double      depth          = 0.; ///< 0: a tenth of the surface's diagonal [mm]

    std::string surface_law     = "smooth";
    double      feature_angle   = 25.;  ///< [degrees]
    double      largest_sagitta = 3e-3; ///< of the surface's diagonal

    std::string file;
    double      scale = 1.;
    Vec3        axis  = Vec3({0., 0., 1.});
    double      angle = 0.; ///< [degrees]

    double              chord_error = 0.05; ///< [mm]
    TripodShape<double> tripod;
    BellShape<double>   bell;

    explicit DieParameters(std::string name) : name(std::move(name)) {}

    void add_parameters(dealii::ParameterHandler &prm);
    /// Normalises `facing`.
    void          check();
    static ReadBy read_by_shape();

    /// Names of the measures of a tripod or bell, as in its section; empty for other shapes.
    std::vector<std::string> measures() const;
    /// A measure by its name [mm, degrees].
    double measure(const std::string &name) const;

    /// Vertices where the die stands at the start, some of its measures changed; always as many as die() has.
    /// @throws Error  for measures that do not fit each other
    template <typename Number>
    NodalVectors<Number> vertices(const std::map<std::string, Number> &changed) const;

    /// @throws Error  for a file or measures that make no surface
    Die              die() const;
    DieState<double> initial_state() const { return {velocity, Vec3(), friction, {}}; }

  private:
    std::string     section() const { return "Die " + name; }
    TriangleSurface surface() const;
    template <typename Number>
    ShapeMesh<Number>    shape_mesh(const std::map<std::string, Number> &changed, Segments &segments) const;
    dealii::Tensor<2, 3> turn() const;
  };
} // namespace retroforge
