// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/solver/stage.h>

#include "../contact/wavy_sheet.h"
#include "../element/element_test_tools.h"
#include "../mesh/block_mesh.h"

namespace retroforge
{
  inline std::vector<Die> make_dies(const double hills)
  {
    const Vec3 side = Vec3({-1., 0.1, 0.2});
    return {Die("lower", wavy_sheet(hills), 2., {true, 40., 1.}),
            Die("side", Vec3({5., 0., 0.}), side / side.norm())};
  }

  /// A corner of a billet with a plane of symmetry between a wavy die and a tilted plane, at any velocity.
  struct CornerStage
  {
    Scene                scene;
    NodalVectors<double> X;
    Physics<double>      physics;
    ContactSet<double>   contact;
    Field<double>        W;
    ActiveSet            active;

    CornerStage(Random                            &random,
                const double                       rho,
                const ElementPair                  pair  = ElementPair::mini,
                const std::array<unsigned int, 3> &cells = {{4, 6, 4}},
                const double                       hills = 0.3)
        : scene(half_box_mesh(Vec3({10., 8., 6.}), cells),
                pair,
                make_dies(hills),
                MPI_COMM_WORLD,
                Bubbles::all)
        , X(scene.mesh.X)
        , W(scene.spaces)
    {
      for (Vec3 &x : X)
        x += 0.05 * random.vector();
      physics = {{1.3, 0.4, 0.2}, {rho, 0.3}, {{}, {}}};
      for (auto &die : physics.dies)
        die = {0.3 * random.vector(), Vec3(), 0.3, {}};
      const FrictionRamp ramp{0.5, false};
      contact = make_contact_set<double>(scene.view(physics.dies, X),
                                         find_contact_pairs(scene.view(physics.dies, X), ramp, 0.8, true),
                                         {ramp, 0.4, 0.3, 0.3});
      W       = random_field(random);
      active  = stage().decide_active(W);
    }

    Stage<double> stage() const { return {scene, physics, contact, X}; }

    /// Without what the plane of symmetry fixes.
    Field<double> random_field(Random &random) const
    {
      Field<double> x(scene.spaces);
      for (NodeIndex k = 0; k < scene.spaces.n_velocity_nodes(); ++k)
      {
        x.V[k] = random.vector();
        if (k < scene.mesh.n_nodes())
          x.P[k] = random.scalar();
        for (const Vec3 &n : scene.spaces.fixed_directions(k))
          x.V[k] -= (x.V[k] * n) * n;
      }
      for (Vec3 &beta : x.beta)
        beta = 0.1 * random.vector();
      return x;
    }
  };
} // namespace retroforge
