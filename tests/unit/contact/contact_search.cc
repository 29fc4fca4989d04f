// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The search for contacts, divided over ranks. Proved, on one and on two ranks, for linear and quadratic
// velocities between a wavy die that bulges into edges and a tilted plane, with the corner of a billet whose
// nodes are scattered: pairs, gaps, normals and the deepest point are, to the last bit and in their order,
// what a rank finds by itself; points of all kinds are among them.

#include <deal.II/base/mpi.h>

#include <retroforge/contact/contact_kinematics.h>
#include <retroforge/contact/penetration.h>

#include <iostream>

#include "../element/element_test_tools.h"
#include "../mesh/block_mesh.h"
#include "wavy_sheet.h"

#include "../discretization/middles_of.h"

using namespace retroforge;

namespace
{
  const char *yes(const bool right)
  {
    return dealii::Utilities::MPI::min(right ? 1 : 0, MPI_COMM_WORLD) == 1 ? "yes" : "NO";
  }

  bool same(const ContactPair &a, const ContactPair &b)
  {
    return a.point == b.point && a.die == b.die && a.touching == b.touching && a.feature == b.feature;
  }

  bool same(const Projection<double> &a, const Projection<double> &b)
  {
    return a.delta == b.delta && a.n == b.n;
  }

  template <typename T>
  bool same(const std::vector<T> &a, const std::vector<T> &b)
  {
    return std::equal(
      a.begin(), a.end(), b.begin(), b.end(), [](const T &x, const T &y) { return same(x, y); });
  }

  void compare(const std::string &name, ContactView<double> together)
  {
    const FrictionRamp  ramp{0.5, false};
    ContactView<double> alone{
      together.mesh, together.topology, together.dies, together.states, together.X, together.edges};
    together.comm       = MPI_COMM_WORLD;
    const auto pairs    = find_contact_pairs(alone, ramp, 0.8, true);
    const auto found    = find_contact_pairs(together, ramp, 0.8, true);
    const auto set      = make_contact_set<double>(alone, pairs, {ramp, 0.3}),
               of_ranks = make_contact_set<double>(together, pairs, {ramp, 0.3});
    const auto count    = [&](const bool nodes) {
      return std::count_if(
        pairs.begin(), pairs.end(), [&](const ContactPair &pair) { return pair.point.is_node() == nodes; });
    };
    const bool same_pairs = same(pairs, found),
               same_set   = same(set.projections, of_ranks.projections) && set.ramps == of_ranks.ramps;
    std::cout << name << ": " << count(true) << " nodes, " << count(false)
              << " middles; the pairs of one rank: " << yes(same_pairs)
              << ", its gaps and normals: " << yes(same_set) << std::endl;
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) > 0)
    std::cout.setstate(std::ios::failbit);
  Random               random;
  const TetMesh        mesh = half_box_mesh(Vec3({10., 8., 6.}), {{4, 6, 4}});
  const Topology       topology(mesh);
  const MiddleNodes    edges = middles_of(mesh);
  NodalVectors<double> X     = mesh.X;
  for (Vec3 &x : X)
    x += 0.1 * random.vector();
  const Vec3                          side   = Vec3({-1., 0.1, 0.2});
  const std::vector<Die>              dies   = {Die("lower", wavy_sheet(), 2., {true, 60., 1.}),
                                                Die("side", Vec3({5., 0., 0.}), side / side.norm())};
  const std::vector<DieState<double>> states = {{Vec3(), Vec3({0., 0., 0.02}), 0.3, {}},
                                                {Vec3(), Vec3(), 0.2, {}}};
  compare("linear velocities", {mesh, topology, dies, states, X});
  compare("quadratic velocities", {mesh, topology, dies, states, X, &edges});

  const Penetration alone    = deepest_point(mesh, topology, dies, states, X),
                    together = deepest_point(mesh, topology, dies, states, X, MPI_COMM_WORLD);
  std::cout << "the deepest point of one rank: "
            << yes(alone.depth > 0. && alone.depth == together.depth && alone.place == together.place &&
                   alone.die == together.die)
            << std::endl;
}
