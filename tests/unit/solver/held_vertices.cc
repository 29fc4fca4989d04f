// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Which points of a quadratic velocity are pressed, at random velocities between a wavy die and a tilted
// plane. Proved:
// - a point with h > 0 is; a vertex with h <= 0 is where the middles of all its surface edges are in reach of
// its die
//   and have h > 0, and the die bulges into none of them by more than 0.06 of its length, and only there; a
//   middle with h <= 0 is not;
// - residual and matrix without a choice are those of that choice: on a vertex held by its middles acts a
// force that pulls.

#include <deal.II/base/mpi.h>

#include "corner_stage.h"

using namespace retroforge;

/// Whether the die under an edge's middle, pair q, bulges into the edge by more than 0.06 of its length.
bool spans_a_corner(const CornerStage &corner, const unsigned int q)
{
  const auto &pairs  = corner.contact.pairs;
  const auto &[a, b] = pairs[q].point.nodes;
  if (!corner.scene.dies[pairs[q].die].surface())
    return false;
  double       ends = 0.;
  unsigned int n    = 0;
  for (unsigned int p = 0; p < pairs.size(); ++p)
    if (pairs[p].die == pairs[q].die && pairs[p].point.is_node() &&
        (pairs[p].point.nodes[0] == a || pairs[p].point.nodes[0] == b))
    {
      ends += 0.5 * corner.contact.own_gaps[p];
      ++n;
    }
  return n == 2 && std::abs(ends - corner.contact.own_gaps[q]) > 0.06 * (corner.X[a] - corner.X[b]).norm();
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);

  Random      random;
  CornerStage corner(random, 50., ElementPair::taylor_hood, {{4, 6, 4}}, 0.7);
  const auto &pairs   = corner.contact.pairs;
  const auto  stage   = corner.stage();
  const auto  pair_at = [&](const unsigned int die, const NodeIndex velocity_node) {
    return std::find_if(pairs.begin(),
                        pairs.end(),
                        [&](const ContactPair &pair) {
                          return pair.die == die && pair.point.velocity_node == velocity_node;
                        }) -
           pairs.begin();
  };
  unsigned int n_held = 0, n_free = 0, n_wrong = 0, n_pulls = 0;
  for (unsigned int trial = 0; trial < 100; ++trial)
  {
    Field<double> W = corner.random_field(random);
    // Middles move towards a die that is near them, so that vertices are surrounded.
    for (const ContactPair &pair : pairs)
      if (!pair.point.is_node() && random.scalar() < 0.9)
        W.V[pair.point.velocity_node] += 1.5 * Vec3(pair.die == 0 ? Vec3({0., 0., -1.}) : Vec3({1., 0., 0.}));
    const ActiveSet   active = stage.decide_active(W);
    std::vector<char> own;
    for (unsigned int p = 0; p < pairs.size(); ++p)
      own.push_back(approach_excess(stage.contact_node(p, W, active)) > 0.);
    for (unsigned int p = 0; p < pairs.size(); ++p)
    {
      bool held = pairs[p].point.is_node();
      if (held)
        for (const auto &[a, b] : corner.scene.topology.surface_edges)
          if (a == pairs[p].point.nodes[0] || b == pairs[p].point.nodes[0])
          {
            const NodeIndex middle = corner.scene.discretization.middles()->between(a, b);
            const auto      q      = pair_at(pairs[p].die, middle);
            held                   = held && q < pairs.size() && own[q] && !spans_a_corner(corner, q);
          }
      n_wrong += bool(active[p]) != (own[p] || held);
      n_held += held && !own[p];
      n_free += pairs[p].point.is_node() && !held && !own[p];
      if (held && !own[p])
      {
        const auto          node    = stage.contact_node(p, W, active);
        ContactNode<double> sliding = node;
        sliding.Sf                  = 0.;
        n_pulls += contact_force(sliding, corner.physics.material.law, corner.physics.contact) * node.n < 0.;
      }
    }
    const Field<double> r = stage.residual(W, active), decided = stage.residual(W, {});
    for (std::size_t k = 0; k < r.V.size(); ++k)
      n_wrong += r.V[k] != decided.V[k];
  }
  unsigned int n_corners = 0;
  for (unsigned int p = 0; p < pairs.size(); ++p)
    n_corners += !pairs[p].point.is_node() && spans_a_corner(corner, p);
  std::cout << "vertices that only their middles hold: " << (n_held > 5 ? "yes" : "NO")
            << "\nvertices that nothing holds: " << (n_free > 5 ? "yes" : "NO")
            << "\npulled where held: " << (n_pulls == n_held ? "yes" : "NO")
            << "\nedges that span a corner: " << (n_corners > 5 ? "yes" : "NO")
            << "\nas the rule says, and so the residual: " << (n_wrong == 0 ? "yes" : "NO") << std::endl;
}
