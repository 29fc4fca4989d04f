// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// A die comes to a cube over a gap g, and crushes it without friction from h0 to h1 = h0 - (stroke - g). It
// arrives within an increment, at all nodes at once. In closed form the energy is
//   E = c (h1^-m - h0^-m)/m,  c = sqrt(3)^(m+1) K v^m V,  and  dE/dg = -c h1^(-m-1).
// - Energy and derivative by the offset of the die, in 15 and 40 increments, both pairs of elements, power laws
//   and Newtonian metal: 2e-4 and 5e-3; those of the stages alone lack up to some per cent.
// - The work of the forces is the energy, and without what is spent on gaps that close it is not.
// - On the tilted block, whose nodes arrive one by one, the derivatives of the energy and of both efforts agree
//   with the direct method and with differences of replays, the exponent m among them.
// - Terms made by hand: a die that comes slower, single points that arrive, both in closed form; a die that
//   sinks in by what a penalty lets it spends no more than the first order.

#include <deal.II/base/mpi.h>

#include <retroforge/objective/effort.h>
#include <retroforge/objective/energy.h>

#include "../adjoint/directions.h"

#include <cstdio>

using namespace retroforge;

namespace
{
  constexpr double       h0 = 30., stroke = 6., v = 100., K = 1.7;
  constexpr unsigned int upper = 1;

  Parameters cube(const double m, const double gap, const unsigned int increments, const ElementPair pair)
  {
    Parameters p;
    p.billet.size                = Vec3({h0, h0, h0});
    p.billet.element_size        = h0;
    p.billet.symmetry_planes     = {Vec3({-1., 0., 0.}), Vec3({0., -1., 0.})};
    p.dies                       = {DieParameters("lower"), DieParameters("upper")};
    p.dies[0].facing             = Vec3({0, 0, 1});
    p.dies[1].point              = Vec3({0, 0, h0 + gap});
    p.dies[1].facing             = Vec3({0, 0, -1});
    p.dies[1].velocity           = Vec3({0, 0, -v});
    p.material.law               = {K, m, 1e-5};
    p.press.stroke               = stroke;
    p.press.increments           = increments;
    p.press.largest_move         = 10.;
    p.press.largest_loss         = 0.1;
    p.discretization.choice.pair = pair;
    p.newton.tolerance           = 1e-10;
    p.adjoint.tolerance          = 1e-12;
    p.linear_solver.method       = LinearSolverParameters::Method::direct;
    return p;
  }

  struct Exact
  {
    double energy, slope;

    Exact(const double m, const double gap)
    {
      const double h1 = h0 - (stroke - gap),
                   c  = std::pow(3., 0.5 * (m + 1.)) * K * std::pow(v, m) * 0.25 * h0 * h0 * h0;
      energy          = c * (std::pow(h1, -m) - std::pow(h0, -m)) / m;
      slope           = -c * std::pow(h1, -m - 1.);
    }
  };

  void check_gap(const double m, const double gap, const ElementPair pair)
  {
    for (const unsigned int increments : {15u, 40u})
    {
      const Parameters  p = cube(m, gap, increments, pair);
      const RecordedRun run(p);
      const Exact       exact(m, gap);
      const auto       &energy = run.state().energy;
      double            work   = 0.;
      for (const IncrementRecord &record : run.records)
        work += record.forces[upper] * Vec3({0., 0., -record.step});
      const double slope = run.adjoint().process.dies[upper].displacement[2];
      std::printf("  %s, gap %.2f, %2u increments: energy within 2e-4: %s, slope within 5e-3: %s, the "
                  "forces' work: %s; "
                  "deformation alone is short by 4e-4 or more: %s\n",
                  pair == ElementPair::mini ? "mini" : "P2-P1",
                  gap,
                  increments,
                  yes(std::abs(energy.total() / exact.energy - 1.) < 2e-4),
                  yes(std::abs(slope / exact.slope - 1.) < 5e-3),
                  yes(std::abs(work / energy.total() - 1.) < 1e-8),
                  yes(energy.deformation / exact.energy - 1. < -4e-4));
    }
  }

  void check_left_out()
  {
    Parameters p             = cube(0.15, 0.3, 15, ElementPair::mini);
    p.contact.counts_closing = false;
    const RecordedRun run(p);
    double            work = 0., closing = 0.;
    for (const IncrementRecord &record : run.records)
    {
      work += record.forces[upper] * Vec3({0., 0., -record.step});
      closing += record.closing_energy;
    }
    std::printf("left out: nothing added: %s, the forces' work exceeds the energy by more than 1e-2: %s\n",
                yes(closing == 0. && run.state().energy.closing == 0.),
                yes(work / run.state().energy.total() - 1. > 1e-2));
  }

  Objectives objectives()
  {
    const PathWindow late{PathWindow::Over::stroke, 0.4, 3.};
    Objectives       all;
    all.push_back(
      {"energy", 1., SymmetryScaling::none, invalid_index, std::make_unique<EnergyObjective>(), nullptr});
    for (const auto by : {Effort::By::power, Effort::By::force})
      all.push_back({by == Effort::By::power ? "effort by power" : "effort by force",
                     1.,
                     SymmetryScaling::none,
                     invalid_index,
                     std::make_unique<MeanEffort>(Effort(upper, by), late),
                     nullptr});
    return all;
  }

  std::vector<double>
  replayed(const RecordedRun &run, const Direction &direction, const double m_dot, const double t)
  {
    auto [process, X] = along<double>(run, direction, t);
    process.material.law.m += m_dot * t;
    return run.replayed_values(process, X);
  }

  void check_gradients()
  {
    const Parameters parameters = tilted_block();
    RecordedRun      run(parameters, {parameters.dies[0].die(), parameters.dies[1].die()}, objectives());
    const auto       sweep = run.sweep(each(run.objectives()));
    const NodalVectors<double> still(run.state().workpiece.X.size());
    double                     counted = 0.;
    for (const IncrementRecord &record : run.records)
      counted += record.closing_energy;
    std::printf("one by one, more than 1e-3 of the energy is that of closing: %s\n",
                yes(counted > 1e-3 * run.state().energy.total()));
    const auto values = run.values();
    std::printf("  efforts by power and by force are one: %s\n",
                yes(std::abs(values[1] / values[2] - 1.) < 1e-9));
    const double h = 1e-5;
    for (const auto &[direction, m_dot] : std::vector<std::pair<Direction, double>>{
           {{"nodes", random_vectors(run.state().workpiece.X.size()), 0., 0., {}}, 0.},
           {{"speed", still, 1., 0., {}}, 0.},
           {{"offset", still, 0., 1., {}}, 0.},
           {{"m", still, 0., 0., {}}, 0.1}})
    {
      auto [process, X]                      = along<Dual>(run, direction, 0.);
      process.material.law.m.fastAccessDx(0) = m_dot;
      const auto tangents                    = run.tangent(process, X);
      const auto plus = replayed(run, direction, m_dot, h), minus = replayed(run, direction, m_dot, -h);
      for (std::size_t o = 0; o < run.objectives().size(); ++o)
      {
        const double adjoint =
          slope(run, sweep.gradients[o], direction) + m_dot * sweep.gradients[o].process.material.law.m;
        std::printf("  %s by %s: direct method 1e-10: %s, differences 1e-6: %s\n",
                    run.objectives()[o].name.c_str(),
                    direction.name.c_str(),
                    yes(relative_error(adjoint, tangents[o].dx(0)) < 1e-10),
                    yes(relative_error(adjoint, (plus[o] - minus[o]) / (2. * h)) < 1e-6));
      }
    }
  }

  /// Terms of a stage between two dies, the second of which closes at the speed 1: points with force and speed
  /// each.
  std::vector<double>
  terms(const double D, const double m, const std::vector<std::pair<double, double>> &points)
  {
    std::vector<double> result(n_power_terms(2), 0.);
    result[0] = D;
    result[2] = m;
    for (const auto &[N, u] : points)
    {
      const double q   = 1. / (1. + std::pow(u / 0.01, 2));
      double      *sum = &result[3 + n_closing_moments];
      for (const double moment : {N, N * u, N * u * u, N * q * q, N * q * q * u})
        *sum++ += moment;
    }
    return result;
  }

  void check_terms()
  {
    bool slower = true, single = true, forces = true, sunk = true, together = true;
    for (const double m : {0.05, 0.15, 0.5, 1.})
    {
      for (const double theta : {0.1, 0.5, 0.9})
      {
        const double D = std::pow(1. - theta, 1. + m), N = std::pow(1. - theta, m), truth = 1. - theta;
        const auto   at_once = terms(D, m, {{0.4 * N, theta}, {0.6 * N, theta}});
        slower               = slower && std::abs(spent_power(at_once).total() / truth - 1.) < 1e-12;
        forces = forces && std::abs((D + N * theta) * force_factor(at_once) / spent_power(at_once).total() -
                                    1.) < 1e-14;
      }
      // One point of a hundredth of the force.
      const auto   one = terms(1., m, {{1., 0.}, {1e-2, 0.3}});
      const double C   = 1e-2 * 0.3;
      single           = single && std::abs(spent_power(one).closing / C / (0.5 * (1. + m)) - 1.) < 0.05;
      const double u   = 1e-7;
      const auto   by_penalty = terms(1., m, {{1., u}});
      sunk                    = sunk && std::abs(spent_power(by_penalty).closing / u / m - 1.) < 1e-6;
      // A die that is farther off by u time, with points that arrive besides: what it costs is u N m.
      const auto shifted = [&](const double by) {
        return spent_power(terms(1., m, {{1., by}, {0.1, 0.3 + by}, {0.1, 0.7 + by}})).closing;
      };
      together = together && std::abs((shifted(u) - shifted(-u)) / (2. * u) / (1.2 * m) - 1.) < 0.02;
    }
    std::printf("by hand: a die that comes slower: %s, one of many: %s, sunk in: %s, with what arrives: %s, "
                "forces: %s\n",
                yes(slower),
                yes(single),
                yes(sunk),
                yes(together),
                yes(forces));
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  check_terms();
  for (const double m : {0.15, 1.})
  {
    std::printf("m = %.2f\n", m);
    for (const double gap : {0.05, 0.3, 1.})
      for (const ElementPair pair : {ElementPair::mini, ElementPair::taylor_hood})
        check_gap(m, gap, pair);
  }
  check_left_out();
  check_gradients();
}
