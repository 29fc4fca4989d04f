// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Time schemes are nothing but their tables: those that users may choose, and Kutta's of third order, three
// of whose stages have a weight.
// - A Newtonian cube of side h0 crushed without friction to h1 flows homogeneously: its side grows to
//   h0 sqrt(h0/h1), the energy is 3 K h0^3 v (1/h1 - 1/h0). The errors fall with the order of the scheme.
// - On a block under a tilted die, the backward sweep of Kutta's scheme agrees with the direct method and
// with
//   differences of replays, for an energy, for an effort and for a strain.

#include <deal.II/base/mpi.h>

#include <retroforge/objective/cell_statistics.h>
#include <retroforge/objective/effort.h>
#include <retroforge/objective/energy.h>

#include "../adjoint/directions.h"

#include <cstdio>

using namespace retroforge;

namespace
{
  const Scheme kutta{"kutta", "", {{}, {0.5}, {-1., 2.}}, {1. / 6., 2. / 3., 1. / 6.}};

  constexpr double h0 = 30., stroke = 15., v = 100.;

  Parameters cube(const unsigned int increments)
  {
    Parameters p;
    p.billet.size            = Vec3({h0, h0, h0});
    p.billet.element_size    = h0;
    p.billet.symmetry_planes = {Vec3({-1., 0., 0.}), Vec3({0., -1., 0.})};
    p.dies                   = {DieParameters("lower"), DieParameters("upper")};
    p.dies[0].facing         = Vec3({0, 0, 1});
    p.dies[1].point          = Vec3({0, 0, h0});
    p.dies[1].facing         = Vec3({0, 0, -1});
    p.dies[1].velocity       = Vec3({0, 0, -v});
    p.material.law           = {1.7, 1., 0.};
    p.press.stroke           = stroke;
    p.press.increments       = increments;
    p.press.largest_move     = 10.;
    p.press.largest_loss     = 0.1;
    p.contact.penetration    = 1e-9;
    p.newton.tolerance       = 1e-10;
    p.linear_solver.method   = LinearSolverParameters::Method::direct;
    return p;
  }

  /// Relative errors of the width and of the energy.
  std::pair<double, double> errors(const Scheme &scheme, const unsigned int increments)
  {
    const Parameters  p = cube(increments);
    const RecordedRun run(p, {p.dies[0].die(), p.dies[1].die()}, {}, scheme);
    if (run.records.size() != increments)
      std::printf("an increment was cut\n");
    double width = 0.;
    for (const Vec3 &x : run.state().workpiece.X)
      width = std::max(width, 2. * x[0]);
    const double h1 = h0 - stroke, K = p.material.law.K;
    // a quarter of the cube
    const double energy = 0.25 * 3. * K * h0 * h0 * h0 * v * (1. / h1 - 1. / h0);
    return {std::abs(width / (h0 * std::sqrt(h0 / h1)) - 1.),
            std::abs(run.state().energy.total() / energy - 1.)};
  }

  void show_order(const Scheme &scheme)
  {
    const auto coarse = errors(scheme, 20), fine = errors(scheme, 40);
    std::printf("%s: order of the width %.1f, of the energy %.1f\n",
                scheme.name.c_str(),
                std::log2(coarse.first / fine.first),
                std::log2(coarse.second / fine.second));
  }

  Objectives objectives()
  {
    constexpr unsigned int upper = 1;
    const PathWindow       late{PathWindow::Over::stroke, 1.1, 3.};
    Objectives             all;
    all.push_back(
      {"energy", 1., SymmetryScaling::none, invalid_index, std::make_unique<EnergyObjective>(), nullptr});
    all.push_back({"mean effort",
                   1.,
                   SymmetryScaling::none,
                   invalid_index,
                   std::make_unique<MeanEffort>(Effort(upper), late),
                   nullptr});
    all.push_back({"variance of the strain",
                   1.,
                   SymmetryScaling::none,
                   invalid_index,
                   nullptr,
                   std::make_unique<CellStatistics>(CellQuantity::strain, CellStatistic::variance)});
    return all;
  }

  std::vector<double> replayed(const RecordedRun &run, const Direction &direction, const double t)
  {
    const auto [process, X] = along<double>(run, direction, t);
    return run.replayed_values(process, X);
  }

  void judge(const std::string &what, const double found, const double bar)
  {
    if (found < bar)
      std::printf("%s within %.0e\n", what.c_str(), bar);
    else
      std::printf("%s off by %.1e\n", what.c_str(), found);
  }

  void check_gradients()
  {
    const Parameters parameters = tilted_block();
    RecordedRun run(parameters, {parameters.dies[0].die(), parameters.dies[1].die()}, objectives(), kutta);
    const auto  sweep = run.sweep(each(run.objectives()));
    const NodalVectors<double> still(run.state().workpiece.X.size());
    const double               h = 1e-5;
    for (const Direction &direction :
         {Direction{"nodes", random_vectors(run.state().workpiece.X.size()), 0., 0., {}},
          Direction{"speed", still, 1., 0., {}},
          Direction{"offset", still, 0., 1., {}}})
    {
      const auto [process, X] = along<Dual>(run, direction, 0.);
      const auto tangents     = run.tangent(process, X);
      const auto plus = replayed(run, direction, h), minus = replayed(run, direction, -h);
      for (std::size_t o = 0; o < run.objectives().size(); ++o)
      {
        const std::string what    = run.objectives()[o].name + ", " + direction.name + ": ";
        const double      adjoint = slope(run, sweep.gradients[o], direction);
        judge(what + "tangent", relative_error(adjoint, tangents[o].dx(0)), 1e-10);
        judge(what + "differences", relative_error(adjoint, (plus[o] - minus[o]) / (2. * h)), 1e-6);
      }
    }
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const Scheme &scheme : Scheme::all())
    show_order(scheme);
  show_order(kutta);
  check_gradients();
}
