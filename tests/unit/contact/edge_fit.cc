// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Edges that span a corner of a die, of those that touch, by hand: a unit cube stands on a roof whose ridge
// runs along y under the middle of its bottom, with slopes s on both sides. Ends at x = 0 and 1 have the gap
// d = s/2 / sqrt(1 + s^2), middles at x = 1/2 none: the roof bulges by d into the two edges along x, of
// length 1, and into the diagonal of length sqrt(2), and not into the two along y. Where the ramp is narrower
// than d, the latter do not touch.

#include <deal.II/base/mpi.h>

#include <retroforge/contact/level_gaps.h>

#include <cstdio>

#include "../mesh/block_mesh.h"

#include "../discretization/middles_of.h"

using namespace retroforge;

/// Two rectangles under |x| <= 5 around the ridge, |y| <= 5, that fall with slope s.
TriangleSurface roof(const double s)
{
  NodalVectors<double> x;
  for (const double along : {-5., 0.5, 6.})
    for (const double y : {-5., 6.})
      x.push_back(Vec3({along, y, -s * std::abs(along - 0.5)}));
  return TriangleSurface("roof", x, {{{0, 2, 3}}, {{0, 3, 1}}, {{2, 4, 5}}, {{2, 5, 3}}});
}

void tell(const std::string &name, const double s, const double ramp_width)
{
  const TetMesh                       mesh = block_mesh({{1, 1, 1}}, [](auto, auto, auto) { return true; });
  const Topology                      topology(mesh);
  const MiddleNodes                   edges  = middles_of(mesh);
  const std::vector<Die>              dies   = {Die("roof", roof(s), 2., {false, 60., 1.})};
  const std::vector<DieState<double>> states = {{Vec3(), Vec3(), 0.3, {}}};
  const FrictionRamp                  ramp{ramp_width, false};
  const ContactView<double>           view{mesh, topology, dies, states, mesh.X, &edges};
  const auto                          pairs   = find_contact_pairs(view, ramp, 0.4, true);
  const auto                          contact = make_contact_set<double>(view, pairs, {ramp, 1.});
  const EdgeFit                       fit     = edge_fit(mesh.X, ramp, contact);
  const double                        d       = 0.5 * s / std::sqrt(1. + s * s);
  std::printf("%s: %u touch, %u span a corner, the worst as by hand %s",
              name.c_str(),
              fit.touching,
              fit.spanning,
              std::abs(fit.largest - d) < 1e-14 ? "yes" : "NO");
  if (fit.largest > 0.)
    std::printf(", at x = %.3g under die %u", fit.place[0], fit.die);
  std::printf("\n");
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  tell("flat", 0., 0.5);
  tell("a gentle roof", 0.2, 0.5);  // 0.098 and 0.069 of the lengths
  tell("a steep one", 0.35, 0.5);   // 0.165 and 0.117
  tell("a steeper one", 0.5, 0.5);  // 0.224 and 0.158
  tell("a narrow ramp", 0.35, 0.1); // ends at 0.165 do not touch
}
