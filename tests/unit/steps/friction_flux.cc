// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Half a box slides on a die as a whole: the flux of friction's heat is traction times slip wherever all of a node's surface
// touches, on the plane of symmetry, too, with both pairs of elements, weighted as the stage is; at rims, where a part F of the
// surface A does, it is F/(0.9 F + 0.1 A) of that; elsewhere none.

#include <deal.II/base/mpi.h>

#include <retroforge/contact/interface_law.h>
#include <retroforge/mesh/surface_areas.h>
#include <retroforge/steps/friction_heat.h>

#include "../solver/corner_stage.h"

#include <algorithm>
#include <cmath>
#include <iostream>

using namespace retroforge;

namespace
{
  const Vec3       size({10., 8., 6.}), velocity({3., -2., 0.});
  constexpr double weight = 0.25, alpha = 0.4;

  /// Largest differences to what is expected, of the flux that all of a node's surface has.
  struct FluxErrors
  {
    double       on_die = 0., elsewhere = 0.;
    unsigned int n_inside = 0, n_rim = 0;
  };

  FluxErrors flux_errors(const ElementPair pair)
  {
    const Scene scene(
      half_box_mesh(size, {{4, 4, 3}}), {pair}, {Die("lower", Vec3(), Vec3({0., 0., 1.}))}, MPI_COMM_WORLD);
    const NodalVectors<double> X = scene.mesh.X;
    Physics<double>            physics{MaterialLaw<double>{1.3, 0.4, 0.2}, {100., 1e-7}, {{}}};
    physics.dies[0] = {Vec3(), Vec3(), alpha, {}};
    const FrictionRamp ramp{0.5, false};
    const auto         view = scene.view(physics.dies, X);
    const auto         contact =
      make_contact_set<double>(view, find_contact_pairs(view, ramp, 0.8, true), {ramp, 0.4, 0.3, 0.3});
    const auto          &nodes = *scene.discretization.condensed_nodes();
    NodalVectors<double> V(nodes.n() + (scene.discretization.has_bubbles() ? scene.mesh.n_cells() : 0));
    std::fill(V.begin(), V.begin() + nodes.n(), velocity);
    Field<double> W(scene.discretization);
    W.V.take(V);
    const Equilibrium<double>     stage{scene, physics, contact, X};
    const EquilibriumView<double> at{stage, W, stage.decide_active(W), weight};
    std::vector<double>           flux(scene.mesh.n_nodes(), 0.);
    add_friction_flux(at, flux);

    const double slip = velocity.norm();
    const double whole =
      weight * slip * friction_traction({alpha, 0., 0}, {slip, 0., 0.}, physics.material.law);
    // Of each node's surface that symmetry does not cut off, what lies on the die, and all of it.
    std::vector<double> touching(X.size(), 0.), surface(X.size(), 0.);
    for (const BoundaryFace &face : scene.mesh.faces)
      if (face.patch != 2)
      {
        const bool on_die =
          std::all_of(face.nodes.begin(), face.nodes.end(), [&](const NodeIndex k) { return X[k][2] == 0.; });
        for (const NodeIndex k : face.nodes)
        {
          surface[k] += triangle_area(face.nodes, X);
          touching[k] += on_die ? triangle_area(face.nodes, X) : 0.;
        }
      }
    FluxErrors worst;
    for (NodeIndex k = 0; k < X.size(); ++k)
      if (touching[k] == 0.)
        worst.elsewhere = std::max(worst.elsewhere, std::abs(flux[k]) / whole);
      else
      {
        const double part = touching[k] / (0.9 * touching[k] + 0.1 * surface[k]);
        worst.on_die      = std::max(worst.on_die, std::abs(flux[k] / whole - part));
        ++(touching[k] == surface[k] ? worst.n_inside : worst.n_rim);
      }
    return worst;
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const ElementPair pair : {ElementPair::mini, ElementPair::taylor_hood})
  {
    const FluxErrors worst = flux_errors(pair);
    std::cout << (pair == ElementPair::mini ? "mini" : "P2-P1") << ": traction times slip at "
              << worst.n_inside << " nodes, and its part at " << worst.n_rim
              << " of the rim, within 1e-6: " << (worst.on_die < 1e-6 ? "yes" : "NO")
              << "; elsewhere none: " << (worst.elsewhere == 0. ? "yes" : "NO") << "\n";
  }
}
