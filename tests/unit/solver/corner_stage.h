// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/solver/equilibrium.h>

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
        : scene(half_box_mesh(Vec3({10., 8., 6.}), cells), {pair}, make_dies(hills), MPI_COMM_WORLD)
        , X(scene.mesh.X)
        , W(scene.discretization)
    {
      for (Vec3 &x : X)
        x += 0.05 * random.vector();
      physics = {MaterialLaw<double>{1.3, 0.4, 0.2}, {rho, 0.3}, {{}, {}}};
      for (auto &die : physics.dies)
        die = {0.3 * random.vector(), Vec3(), 0.3, {}};
      const FrictionRamp ramp{0.5, false};
      contact = make_contact_set<double>(scene.view(physics.dies, X),
                                         find_contact_pairs(scene.view(physics.dies, X), ramp, 0.8, true),
                                         {ramp, 0.4, 0.3, 0.3});
      W       = random_field(random);
      active  = stage().decide_active(W);
    }

    Equilibrium<double> stage() const { return {scene, physics, contact, X}; }

    /// Without what the plane of symmetry fixes; the same on any number of ranks.
    Field<double> random_field(Random &random) const
    {
      const auto          &discretization = scene.discretization;
      const NodeNumbering &nodes          = *discretization.condensed_nodes();
      NodalVectors<double> V(nodes.n() + (discretization.has_bubbles() ? scene.mesh.n_cells() : 0));
      std::vector<double>  P(scene.mesh.n_nodes());
      for (NodeIndex k = 0; k < V.size(); ++k)
      {
        V[k] = (k < nodes.n() ? 1. : 0.1) * random.vector();
        if (k < P.size())
          P[k] = random.scalar();
      }
      Field<double> x(discretization);
      x.V.take(V);
      x.P.take(P);
      for (unsigned int place = 0; place < nodes.n_places(); ++place)
        for (const Vec3 &n : discretization.fixed_directions(place))
        {
          Vec3 &v = x.V[nodes.node_at(place)];
          v -= (v * n) * n;
        }
      return x;
    }

    /// Velocities at all nodes but bubbles.
    NodalVectors<double> velocities(const Field<double> &W_of_rank) const
    {
      return W_of_rank.V.complete(*scene.discretization.condensed_nodes());
    }
  };
} // namespace retroforge
