// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/heat/surface_temperature.h>

#include "../geometry/geometry_test_tools.h"
#include "../mesh/block_mesh.h"
#include "../random_numbers.h"

#include <cmath>
#include <iostream>

namespace retroforge
{
  /// A box [0, size] of n[0] x n[1] x n[2] blocks of six tetrahedra, without planes of symmetry.
  inline TetMesh box_mesh(const Vec3 &size, const std::array<unsigned int, 3> &n)
  {
    TetMesh mesh = block_mesh(n, [](unsigned int, unsigned int, unsigned int) { return true; });
    for (Vec3 &x : mesh.X)
      for (unsigned int i = 0; i < 3; ++i)
        x[i] *= size[i] / n[i];
    return mesh;
  }

  /// Hot steel, and dies of which nothing is known: all that is not set is insulated.
  inline HeatLaw<double> steel()
  {
    HeatLaw<double> law;
    law.capacity       = 5.;
    law.conductivity   = 28.;
    law.surroundings   = 20.;
    law.die_effusivity = 10.;
    law.gap            = 0.1;
    return law;
  }

  /// A mesh, plane dies, and heat that flows in it.
  struct Body
  {
    TetMesh                       mesh;
    Topology                      topology;
    NetworkEdges                  edges;
    std::vector<Die>              dies;
    std::vector<DieState<double>> states;

    explicit Body(TetMesh made, std::vector<Die> made_dies = {})
        : mesh(std::move(made))
        , topology(mesh)
        , edges(mesh, topology)
        , dies(std::move(made_dies))
        , states(dies.size())
    {
    }

    template <typename Number>
    ThermalSurface<Number>
    surface(const std::vector<DieState<Number>> &at, const NodalVectors<Number> &X, const double gap) const
    {
      return thermal_surface<Number>(
        {mesh, topology, dies, at, X}, std::vector<bool>(dies.size(), true), gap);
    }

    /// Skins of what has touched nothing.
    NodeSkins<double> no_skins() const { return NodeSkins<double>::none(mesh.n_nodes(), dies.size()); }

    /// Heat flows for a time, in n steps, at positions X.
    /// @return heat that came in [mJ]
    double conduct(const HeatLaw<double>      &law,
                   const NodalVectors<double> &X,
                   const double                time,
                   const unsigned int          n,
                   std::vector<double>        &T,
                   NodeSkins<double>          &skin) const
    {
      const auto network = conduction_network(mesh, edges, X);
      const auto touched = surface(states, X, law.gap);
      double     heat    = 0.;
      for (unsigned int i = 0; i < n; ++i)
        heat += retroforge::conduct<double>(
          {edges, network, touched, law, law.contact_film, states}, time / n, T, skin);
      return heat;
    }
  };

  /// All that a surface says, by random weights.
  template <typename Number>
  Number sum_of_all(const ThermalSurface<Number> &surface, RandomNumbers numbers)
  {
    Number sum(0.);
    for (const auto &at : surface.touching)
    {
      sum += numbers.scalar() * at.weight;
      sum += numbers.scalar() * at.area;
      sum += numbers.scalar() * at.later.part;
      sum += numbers.scalar() * at.later.gap;
    }
    for (const auto &edge : surface.edges)
    {
      sum += numbers.scalar() * edge.later.part;
      sum += numbers.scalar() * edge.later.gap;
    }
    for (const auto &face : surface.faces)
      sum += numbers.scalar() * face.area;
    for (const Number &free : surface.free)
      sum += numbers.scalar() * free;
    return sum;
  }

  /// Its derivatives.
  inline ThermalSurfaceBar sum_of_all_bar(const ThermalSurface<double> &surface, RandomNumbers numbers)
  {
    ThermalSurfaceBar bar(surface);
    for (std::size_t i = 0; i < surface.touching.size(); ++i)
    {
      bar.weight[i]        = numbers.scalar();
      bar.touching_area[i] = numbers.scalar();
      bar.later[i].part    = numbers.scalar();
      bar.later[i].gap     = numbers.scalar();
    }
    for (auto &later : bar.later_of_edge)
    {
      later.part = numbers.scalar();
      later.gap  = numbers.scalar();
    }
    for (auto *of : {&bar.face_area, &bar.free})
      for (double &x : *of)
        x = numbers.scalar();
    return bar;
  }

  /// Sets a dual vector to x, with its derivative along a direction.
  /// @return the direction
  inline Vec3 varied(const Vec3 &x, const Vec3 &direction, Vector3<Dual> &to)
  {
    for (unsigned int i = 0; i < 3; ++i)
    {
      to[i]                 = Dual(x[i]);
      to[i].fastAccessDx(0) = direction[i];
    }
    return direction;
  }
} // namespace retroforge
