// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Velocities made to respect the dies, at any velocity of the corner of a billet. Proved, on one rank and on
// two:
// - afterwards no node goes through its die by more than 1e-7 of its speed, nodes between two dies too, and
//   those corrected at one die count as active;
// - what the plane of symmetry fixes stays fixed, nodes that no die holds keep their velocity;
// - also where they stick to a die they touch, which leaves them no speed of their own;
// - nodes that were active in a step are left alone by what follows the step;
// - a node that leaves its die, but that the metal presses against it, is held; so is one that is said to be
//   pressed, where the metal pulls;
// - nodes that lean on stiff dies are in balance along the normals: what is left is what the metal's forces
//   change by sinking in, of the order of viscosity over penalty.

#include <deal.II/base/mpi.h>

#include <retroforge/solver/contact_steps.h>

#include "corner_stage.h"

#include <cstdio>

using namespace retroforge;

namespace
{
  const char *yes(const bool condition)
  {
    return condition ? "yes" : "NO";
  }

  void compare(const char          *title,
               const CornerStage   &corner,
               const Field<double> &before,
               const Field<double> &after)
  {
    const auto               &pairs    = corner.contact.pairs;
    const auto                V_before = corner.velocities(before), V_after = corner.velocities(after);
    std::vector<unsigned int> n_dies(V_before.size(), 0);
    for (const ContactPair &pair : pairs)
      n_dies[pair.point.nodes[0]] += pair.point.is_node();
    std::vector<bool> watched(V_before.size(), false);
    double            through = 0., out_of_plane = 0.;
    unsigned int      stopped = 0, active = 0, strangers = 0;
    for (unsigned int p = 0; p < pairs.size(); ++p)
      if (pairs[p].point.is_node())
      {
        watched[pairs[p].point.nodes[0]] = true;
        const auto node                  = corner.stage().contact_node(p, after, {});
        through                          = std::max(through, approach_excess(node) / node.u.norm());
        const NodeIndex k                = pairs[p].point.nodes[0];
        if (corner.stage().contact_node(p, before, {}).active && n_dies[k] == 1)
        {
          ++stopped;
          active += node.active;
        }
      }
    for (NodeIndex k = 0; k < V_before.size(); ++k)
    {
      strangers += !watched[k] && (V_after[k] - V_before[k]).norm() > 0.;
      for (const Vec3 &n : corner.scene.topology.fixed_directions[k])
        out_of_plane = std::max(out_of_plane, std::abs(V_after[k] * n));
    }
    std::printf("%s: nodes stopped: %s, through a die: %s, of one die all count as active: %s\n"
                "  out of the plane of symmetry: %s, others moved: %u\n",
                title,
                yes(stopped > 3),
                through < 1e-7 ? "none" : "some",
                yes(active == stopped),
                out_of_plane < 1e-14 ? "none" : "some",
                strangers);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) != 0)
    std::freopen("/dev/null", "w", stdout);
  Random            random;
  const CornerStage corner(random, 10.);
  const auto       &pairs = corner.contact.pairs;
  Field<double>     held  = corner.W;
  project_onto_dies(corner.stage(), held);
  compare("any velocity", corner, corner.W, held);

  Field<double> stopped = corner.W;
  clip_to_dies(corner.stage(), ActiveSet(pairs.size(), 0), stopped);
  compare("after a step without contact", corner, corner.W, stopped);

  // Nodes that touch a die, straight into it.
  Random      again;
  CornerStage touching(again, 10.);
  for (unsigned int p = 0; p < pairs.size(); ++p)
    if (pairs[p].point.is_node())
    {
      touching.contact.projections[p].delta = 0.;
      touching.W.V[pairs[p].point.nodes[0]] =
        touching.physics.dies[pairs[p].die].velocity + touching.contact.projections[p].n;
      for (const Vec3 &n : touching.scene.topology.fixed_directions[pairs[p].point.nodes[0]])
        touching.W.V[pairs[p].point.nodes[0]] -= (touching.W.V[pairs[p].point.nodes[0]] * n) * n;
    }
  Field<double> sticking = touching.W;
  clip_to_dies(touching.stage(), ActiveSet(pairs.size(), 0), sticking);
  std::vector<unsigned int> dies_of(corner.scene.mesh.n_nodes(), 0);
  for (const ContactPair &pair : pairs)
    dies_of[pair.point.nodes[0]] += pair.point.is_node();
  unsigned int straight = 0, at_rest = 0, count = 0;
  for (unsigned int p = 0; p < pairs.size(); ++p)
    if (const NodeIndex k = pairs[p].point.nodes[0]; pairs[p].point.is_node() && dies_of[k] == 1 &&
                                                     touching.scene.topology.fixed_directions[k].size() == 0)
    {
      const auto node = touching.stage().contact_node(p, sticking, {});
      ++straight;
      at_rest += node.u.norm() < 1e-6;
      count += node.active;
    }
  std::printf("straight into a die they touch: some: %s, at rest: %s, count as active: %s\n",
              yes(straight > 3),
              yes(at_rest == straight),
              yes(count == straight));

  Field<double> same = corner.W;
  clip_to_dies(corner.stage(), corner.active, same);
  double     change   = 0.;
  const auto V_before = corner.velocities(corner.W), V_after = corner.velocities(same);
  for (NodeIndex k = 0; k < V_after.size(); ++k)
    change = std::max(change, (V_after[k] - V_before[k]).norm());
  std::printf("active in the step: moved: %s\n", change == 0. ? "none" : "some");

  // A billet at rest under pressure: its boundary pushes outwards.
  Field<double> pressed(corner.scene.discretization);
  for (double &pressure : pressed.P)
    pressure = 50.;
  const auto velocity_of = [&](const unsigned int p) -> Vec3 & { return pressed.V[pairs[p].point.nodes[0]]; };
  std::vector<unsigned int> n_dies(corner.scene.mesh.n_nodes(), 0);
  for (unsigned int p = 0; p < pairs.size(); ++p)
    if (pairs[p].point.is_node())
    {
      ++n_dies[pairs[p].point.nodes[0]];
      velocity_of(p) = Vec3({0., 5., 0.});
    }
  // Nodes inside the wavy die, and not at the other: they slide along it, and away from it by 0.1.
  unsigned int inside = 0, held_there = 0;
  const auto   chosen = [&](const unsigned int p) {
    return pairs[p].point.is_node() && pairs[p].die == 0 && n_dies[pairs[p].point.nodes[0]] == 1 &&
           corner.contact.projections[p].delta < 0. &&
           corner.scene.topology.fixed_directions[pairs[p].point.nodes[0]].size() == 0;
  };
  for (unsigned int p = 0; p < pairs.size(); ++p)
    if (chosen(p))
    {
      const auto node = corner.stage().contact_node(p, pressed, {});
      velocity_of(p) -= (approach_excess(node) + 0.1) * node.n;
    }
  project_onto_dies(corner.stage(), pressed);
  for (unsigned int p = 0; p < pairs.size(); ++p)
    if (chosen(p))
    {
      ++inside;
      held_there += std::abs(approach_excess(corner.stage().contact_node(p, pressed, {}))) < 1e-6;
    }
  std::printf("leaving, but pressed by the metal: some: %s, held: %s\n",
              yes(inside > 3),
              held_there == inside      ? "all"
              : held_there > inside / 2 ? "most"
                                        : "few");

  // The same nodes, and metal that pulls them away.
  ActiveSet said(pairs.size(), 0);
  for (unsigned int p = 0; p < pairs.size(); ++p)
    said[p] = chosen(p);
  const auto n_held = [&](const ActiveChoice &pressed_nodes) {
    Field<double> pulled = pressed;
    for (double &pressure : pulled.P)
      pressure = -50.;
    for (unsigned int p = 0; p < pairs.size(); ++p)
      if (chosen(p))
        pulled.V[pairs[p].point.nodes[0]] -= 0.1 * corner.contact.projections[p].n;
    const std::vector<char> on_die = project_onto_dies(corner.stage(), pulled, pressed_nodes);
    unsigned int            n      = 0;
    for (unsigned int p = 0; p < pairs.size(); ++p)
      n += chosen(p) && on_die[p] &&
           std::abs(approach_excess(corner.stage().contact_node(p, pulled, {}))) < 1e-6;
    return n;
  };
  std::printf("pulled away: held: %s, said to be pressed: %s\n",
              n_held({}) == 0 ? "none" : "some",
              n_held(said) == inside ? "all" : "few");

  // Stiff dies, and metal that presses against both.
  Random        third;
  CornerStage   stiff(third, 1e6);
  Field<double> leaning        = pressed;
  stiff.contact.edge_stiffness = 1e-6; // edges press with nodes that sink in, as softly as in a run
  apply_contact_pressure(stiff.stage(), project_onto_dies(stiff.stage(), leaning), leaning);
  Field<double> r = stiff.stage().residual(leaning, {});
  r.V.update_ghosts();
  double       unbalanced = 0.;
  unsigned int leant      = 0;
  for (unsigned int p = 0; p < pairs.size(); ++p)
    if (chosen(p))
    {
      const auto   node  = stiff.stage().contact_node(p, leaning, {});
      const double force = contact_force(node, stiff.physics.material.law, stiff.physics.contact) * node.n;
      ++leant;
      unbalanced = std::max(unbalanced, std::abs(r.V[pairs[p].point.velocity_node] * node.n) / force);
    }
  std::printf("leaning: some: %s, unbalanced: %s\n",
              yes(leant > 3),
              unbalanced < 1e-4 ? "below 1e-4 of the force" : "more");
}
