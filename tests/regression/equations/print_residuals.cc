// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Prints, one case per line, what the residual of one tetrahedron against a die depends on, and the residual
// as a stage of the program has it, with what objectives take from it: for equations.py, which finds it from the equations of the theory page
// alone. Both pairs of elements; a tilted plane, and a triangulated cap of a sphere, which bulges into edges.

#include <deal.II/base/mpi.h>

#include <retroforge/objective/die_wear.h>
#include <retroforge/objective/stress_maxima.h>
#include <retroforge/steps/damage.h>

#include <nlohmann/json.hpp>

#include "../../unit/random_numbers.h"

using namespace retroforge;
using Json = nlohmann::json;

Json as_json(const Vec3 &x)
{
  return {x[0], x[1], x[2]};
}

Json as_json(const std::vector<Vec3> &vectors)
{
  Json list = Json::array();
  for (const Vec3 &x : vectors)
    list.push_back(as_json(x));
  return list;
}

Json as_json(const Field<double> &W, const Discretization<3> &discretization)
{
  NodalVectors<double> V       = W.V.complete(*discretization.velocity_nodes());
  const auto           bubbles = V.begin() + discretization.condensed_nodes()->n();
  return {{"V", as_json({V.begin(), bubbles})},
          {"beta", as_json({bubbles, V.end()})},
          {"P", W.P.complete(*discretization.pressure_nodes())}};
}

/// What objectives find at a stage: (38a) to (38d).
Json objectives(const Equilibrium<double> &stage, const Field<double> &W)
{
  const ActiveSet               active = stage.decide_active(W);
  const EquilibriumView<double> view{stage, W, active};
  const CellStress<double>      stress = cell_stress(view, 0);
  std::vector<double>           damage(1, 0.);
  add_damage(view, 1., damage);
  return {{"shear", StressMaximum(InnerStress::shear, 2., 1.).integrals(view).complete()[2]},
          {"sigma_1", stress.largest_principal_stress()},
          {"sigma_0", stress.flow_stress()},
          {"damage", damage[0]},
          {"wear", DieWear(0, Wear::total).integrals(view).complete()}};
}

/// All faces are surface; the first is the one below.
TetMesh one_cell(RandomNumbers &random)
{
  TetMesh mesh;
  mesh.X = {Vec3({0., 0., 0.}), Vec3({2., 0., 0.}), Vec3({0.6, 1.8, 0.}), Vec3({0.9, 0.6, 1.7})};
  for (Vec3 &x : mesh.X)
    x += 0.12 * random.vector();
  mesh.cells   = {{{0, 1, 2, 3}}};
  mesh.faces   = {{{{0, 2, 1}}, 0}, {{{0, 1, 3}}, 0}, {{{1, 2, 3}}, 0}, {{{2, 0, 3}}, 0}};
  mesh.patches = {{"side", {}}};
  return mesh;
}

struct MadeDie
{
  Die  die;
  Json json;
};

MadeDie tilted_plane(RandomNumbers &random)
{
  const Vec3 point  = Vec3({0.9, 0.6, 0.1 * random.scalar()}),
             facing = Vec3({0., 0., 1.}) + 0.1 * random.vector();
  return {Die("plane", point, facing),
          {{"point", as_json(point)}, {"normal", as_json(-facing / facing.norm())}}};
}

/// Of a sphere below the cell, its normals upwards.
MadeDie cap(RandomNumbers &random, const double radius)
{
  const unsigned int    n    = 8;
  const double          half = 0.64 * radius, top = 0.15 + 0.1 * random.scalar();
  NodalVectors<double>  x;
  std::vector<Triangle> triangles;
  for (unsigned int j = 0; j <= n; ++j)
    for (unsigned int i = 0; i <= n; ++i)
    {
      const double a = half * (2. * i / n - 1.), b = half * (2. * j / n - 1.);
      x.push_back(Vec3({0.87 + a, 0.6 + b, top - radius + std::sqrt(radius * radius - a * a - b * b)}));
    }
  for (unsigned int j = 0; j < n; ++j)
    for (unsigned int i = 0; i < n; ++i)
    {
      const unsigned int k = j * (n + 1) + i;
      triangles.insert(triangles.end(), {{{k, k + 1, k + n + 2}}, {{k, k + n + 2, k + n + 1}}});
    }
  const Json json = {{"vertices", as_json(std::vector<Vec3>(x.begin(), x.end()))}, {"triangles", triangles}};
  return {Die("cap", TriangleSurface("cap", x, triangles), 2., {true, 60., 1.}), json};
}

/// @param sinking  whether the middles of edges go into the die below and its vertices out of it
Field<double> random_field(RandomNumbers &random, const Discretization<3> &discretization, const bool sinking)
{
  Field<double>      W(discretization);
  const unsigned int n_nodes = discretization.condensed_nodes()->n();
  for (NodeIndex k = 0; k < n_nodes; ++k)
    W.V[k] = 0.6 * random.vector() - Vec3({0., 0., 0.3});
  if (sinking)
    for (NodeIndex k = 0; k < n_nodes; ++k)
      W.V[k] += Vec3({0., 0., k < discretization.n_vertices() ? 1. : -4.});
  for (NodeIndex k = n_nodes; k < W.V.size(); ++k)
    W.V[k] = 0.2 * random.vector();
  for (double &p : W.P)
    p = random.scalar();
  return W;
}

/// Changes the pressure, so that sigma_1 is within half a hundredth of the flow stress.
void release(RandomNumbers &random, const Equilibrium<double> &stage, Field<double> &W)
{
  const ActiveSet          active = stage.decide_active(W);
  const CellStress<double> stress = cell_stress(EquilibriumView<double>{stage, W, active}, 0);
  const double more = stress.largest_principal_stress() + 5e-3 * random.scalar() * stress.flow_stress();
  for (double &p : W.P)
    p += more;
}

/// @param released  whether the metal is about to be pulled
void print_case(RandomNumbers    &random,
                const ElementPair pair,
                const double      m,
                const double      layer,
                const bool        sinking,
                const bool        released,
                const MadeDie    &made)
{
  const Scene     scene(one_cell(random), {pair}, {made.die}, MPI_COMM_WORLD);
  const auto     &X       = scene.mesh.X;
  Physics<double> physics = {MaterialLaw<double>{1.7, m, 0.1}, {20., 0.05}, {{}}};
  physics.dies            = {{0.2 * random.vector(), 0.05 * random.vector(), 0.4, {}}};
  const FrictionRamp   ramp{0.8, false, 0.5};
  NodalVectors<double> before; // in half of the cases the metal's velocity is known
  for (NodeIndex k = 0; sinking && k < X.size(); ++k)
    before.push_back(0.3 * random.vector());
  const double tau = 0.4, part = 0.5, edge_stiffness = 0.3, reach = 1.;
  const auto   view = scene.view(physics.dies, X, &before);
  const auto   contact =
    make_contact_set<double>(view,
                             find_contact_pairs(view, ramp, reach, true),
                             ContactApproach<double>{ramp, tau, ApproachLaw(layer, part), edge_stiffness});
  const Equilibrium<double> stage(scene, physics, contact, X);
  Field<double>             W = random_field(random, scene.discretization, sinking);
  if (released)
    release(random, stage, W);
  Json die            = made.json;
  die["velocity"]     = as_json(physics.dies[0].velocity);
  die["displacement"] = as_json(physics.dies[0].displacement);
  Json faces          = Json::array();
  for (const BoundaryFace &face : scene.mesh.faces)
    faces.push_back(face.nodes);
  const Json line = {
    {"pair", pair == ElementPair::mini ? "P1+/P1" : "P2/P1"},
    {"X", as_json(std::vector<Vec3>(X.begin(), X.end()))},
    {"faces", faces},
    {"middles",
     scene.discretization.middles() ? Json(scene.discretization.middles()->ends()) : Json::array()},
    {"W", as_json(W, scene.discretization)},
    {"K", physics.material.law.K},
    {"m", m},
    {"e_0", physics.material.law.e0},
    {"rho", physics.contact.rho},
    {"v_0", physics.contact.v0},
    {"alpha", physics.dies[0].friction},
    {"die", die},
    {"tau", tau},
    {"l", layer},
    {"theta", part},
    {"width", ramp.width},
    {"c_s", ramp.wall},
    {"V before", as_json(std::vector<Vec3>(before.begin(), before.end()))},
    {"kappa", edge_stiffness},
    {"reach", reach},
    {"objectives", objectives(stage, W)},
    {"R", as_json(stage.residual(W, {}), scene.discretization)}};
  std::cout << line << std::endl;
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  RandomNumbers                            random;
  for (const ElementPair pair : {ElementPair::mini, ElementPair::taylor_hood})
    for (const double m : {0.139, 1.})
      for (const double layer : {0.3, 0.})
        for (unsigned int repeat = 0; repeat < 5; ++repeat)
        {
          const bool sinking = pair == ElementPair::taylor_hood && repeat == 0, released = repeat == 1;
          print_case(random, pair, m, layer, sinking, released, tilted_plane(random));
          print_case(random, pair, m, layer, sinking, released, cap(random, 4.));
          print_case(random, pair, m, layer, sinking, released, cap(random, 10.));
        }
}
