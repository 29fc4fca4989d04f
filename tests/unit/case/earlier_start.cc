// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
//
// How much earlier a press begins whose dies would stand in the billet, by hand: a block of edges 20 (size 20: what
// touches is 0.02, what is refused 1) between planes, the lower one at rest.
// - apart, touching and 0.01 inside: not at all;
// - the upper plane 0.5 inside, along its facing: 0.5, of a stroke of 5 a tenth; to twice its speed the same path;
// - inclined by 60 degrees to its way: 0.5 / cos 60;
// - the lower die coming up at a quarter of the speed: it stands back by a quarter of the path;
// - the lower die, at rest, 0.5 inside, alone or as the upper one is: not at all; 1.5 inside: not at all, which is refused;
// - the upper plane 0.5 inside, where it stands in a second operation, too: not at all; where the one at rest does: 0.5;
// - the tip of a pyramid 0.3 inside, between the nodes: 0.3;
// - moved by what it says no die stands in the billet, and the leading die ends where it would;
// - on dual numbers derivatives stay.

#include <deal.II/base/mpi.h>

#include <retroforge/billet/billet.h>
#include <retroforge/case/earlier_start.h>
#include <retroforge/contact/die_overlap.h>
#include <retroforge/core/dual.h>

#include <cmath>
#include <iostream>
#include <optional>

using namespace retroforge;

namespace
{
  const Vec3 down({0., 0., -1.}), up({0., 0., 1.});

  /// A block between two planes, the upper one `inside` of it.
  Parameters block(const double inside, const Vec3 &velocity)
  {
    Parameters p;
    p.billet.size         = Vec3({20., 20., 20.});
    p.billet.element_size = 10.;
    p.dies                = {DieParameters("lower"), DieParameters("upper")};
    p.dies[0].facing      = up;
    p.dies[1].facing      = down;
    p.dies[1].point       = (20. - inside) * up;
    p.dies[1].velocity    = velocity;
    p.press.stroke        = 5.;
    p.press.increments    = 5;
    p.resolve_defaults({20., 20.});
    return p;
  }

  /// A pyramid whose tip points downwards, at (2.3, 1.7, 19.7).
  Die tip()
  {
    const Vec3                 apex({2.3, 1.7, 19.7});
    const NodalVectors<double> x = {apex,
                                    apex + Vec3({-4., -4., 10.}),
                                    apex + Vec3({4., -4., 10.}),
                                    apex + Vec3({4., 4., 10.}),
                                    apex + Vec3({-4., 4., 10.})};
    return Die("upper",
               TriangleSurface("tip", x, {{{0, 2, 1}}, {{0, 3, 2}}, {{0, 4, 3}}, {{0, 1, 4}}}),
               10.,
               {false, 30., 1.});
  }

  /// @param later  dies of a second operation; none: there is no such
  /// @param upper  in place of the plane
  void report(const std::string               &name,
              const Parameters                &parameters,
              const std::vector<unsigned int> &later = {},
              const std::optional<Die>        &upper = {})
  {
    const TetMesh   mesh    = make_billet(parameters.billet, MPI_COMM_WORLD);
    Process<double> process = parameters.process({20., 20.});
    if (!later.empty())
    {
      process.operations.push_back(process.operations.front());
      process.operations.back().dies = later;
    }
    std::vector<Die> dies;
    for (const DieParameters &die : parameters.dies)
      dies.push_back(die.die());
    if (upper)
      dies[1] = *upper;
    const Vec3         end   = process.at_stroke(5.).dies[1].displacement;
    const EarlierStart start = earlier_start(parameters, mesh, dies, process, mesh.X);
    start.apply(process);
    std::printf("%s: %.4f mm", name.c_str(), start.path);
    const MetalSurface metal = metal_surface(mesh, mesh.X);
    double             deep  = 0.;
    for (std::size_t d = 0; d < dies.size(); ++d)
      deep = std::max(deep, find_overlap(dies[d], process.dies[d].displacement, metal).depth);
    const bool at_end = (process.at_stroke(5.).dies[1].displacement - end).norm() < 1e-12;
    std::printf(
      ", of the stroke %.4f, overlap then %.4f, ends where it would: %s, lower die by %.4f, %zu remarks\n",
      start.scale,
      deep,
      at_end ? "yes" : "NO",
      start.shifts.empty() ? 0. : start.shifts[0].norm(),
      start.remarks.size());
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  report("apart", block(-1., 100. * down));
  report("touching", block(0., 100. * down));
  report("0.01 inside", block(0.01, 100. * down));
  report("inside", block(0.5, 100. * down));
  report("at twice the speed", block(0.5, 200. * down));
  report("inclined", block(0.5, Vec3({100. * std::sqrt(3.), 0., -100.})));
  Parameters both       = block(0.5, 100. * down);
  both.dies[0].velocity = 25. * up;
  report("both", both);
  report("farther inside", block(1.5, 100. * down));
  Parameters at_rest    = block(0., 100. * down);
  at_rest.dies[0].point = 0.5 * up;
  report("at rest", at_rest);
  at_rest.dies[1].point = 19.5 * up;
  report("at rest, and the other as deep", at_rest);

  report("and again in a second operation", block(0.5, 100. * down), {0, 1});
  report("the lower die alone there", block(0.5, 100. * down), {0});

  report("a tip between the nodes", block(0., 100. * down), {}, tip());

  const Parameters parameters                     = block(0.5, 100. * down);
  auto             process                        = converted<Dual>(parameters.process({20., 20.}));
  process.dies[1].displacement[2].fastAccessDx(0) = 3.;
  EarlierStart{0.5, 0.1, {Vec3(), 0.5 * up}, {}}.apply(process);
  std::cout << "derivatives stay: " << process.dies[1].displacement[2].dx(0) << ", "
            << process.operations[0].path_scale.dx(0) << "\n";
}
