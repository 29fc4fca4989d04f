// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Whole runs of a metal that hardens with its accumulated strain, made by the test: each cell has the law of
// its strain at the start of an increment. Proved:
// - uniform frictionless upsetting, whose increments are known by hand, gives that energy, and more than
//   metal that does not harden;
// - under a tilted die with friction the backward sweep agrees with the direct method to 1e-10, and with
//   replayed differences to 1e-6, by node positions, speed and offset of the die, and the numbers K, m, a and
//   n of the metal, of both element pairs and both schemes, of the energy, and of an objective of the strain;
//   along each the remainder of Taylor's expansion falls with the square of the step;
// - so it does where the mesh is made anew in between, and the strain is carried over.

#include <deal.II/base/mpi.h>

#include <retroforge/objective/energy.h>
#include <retroforge/objective/strain_statistics.h>

#include "../adjoint/directions.h"
#include "hardening_metal.h"

#include <algorithm>
#include <iostream>
#include <map>

using namespace retroforge;

namespace
{
  constexpr double a = 2., n = 0.4;

  void harden(Parameters &p)
  {
    p.material.type    = "hardening";
    p.material.numbers = {a, n};
  }

  constexpr double height = 30., stroke = 12., speed = 100.;

  /// A quarter of a cube between frictionless dies.
  Parameters cube(const ElementPair element)
  {
    Parameters p;
    p.billet.size                = Vec3({height, height, height});
    p.billet.element_size        = height;
    p.billet.symmetry_planes     = {Vec3({-1., 0., 0.}), Vec3({0., -1., 0.})};
    p.dies                       = {DieParameters("lower"), DieParameters("upper")};
    p.dies[0].facing             = Vec3({0, 0, 1});
    p.dies[1].point              = Vec3({0, 0, height});
    p.dies[1].facing             = Vec3({0, 0, -1});
    p.dies[1].velocity           = Vec3({0, 0, -speed});
    p.material.law               = {1.7, 0.3, 0.05};
    p.press.stroke               = stroke;
    p.press.increments           = 12;
    p.press.largest_move         = 10.;
    p.press.largest_loss         = 0.1;
    p.contact.penetration        = 1e-9;
    p.newton.tolerance           = 1e-10;
    p.linear_solver.method       = LinearSolverParameters::Method::direct;
    p.discretization.choice.pair = element;
    return p;
  }

  /// Energy of the quarter by hand: in each stage of an increment the velocity is  speed/h (x/2, y/2, -z),
  /// its strain rate speed/h, and the strain is that at the start of the increment.
  double energy_by_hand(const Scheme &scheme, const Parameters &p, const double hardening)
  {
    const MaterialLaw<double> &law = p.material.law;
    const double               dt  = stroke / p.press.increments / speed;
    double                     w = height, h = height, q = 0., energy = 0.;
    for (unsigned int i = 0; i < p.press.increments; ++i)
    {
      std::vector<double> w_dot;
      double              w_next = w, q_next = q;
      for (unsigned int s = 0; s < scheme.n_stages(); ++s)
      {
        double w_s = w, h_s = h;
        for (unsigned int r = 0; r < scheme.a[s].size(); ++r)
        {
          w_s += dt * scheme.a[s][r] * w_dot[r];
          h_s -= dt * scheme.a[s][r] * speed;
        }
        const double e      = speed / h_s;
        const double K      = law.K * std::pow(1. + hardening * q, n);
        const double stress = 3. * K * e * std::pow(3. * (e * e + law.e0 * law.e0), 0.5 * (law.m - 1.));
        energy += 0.25 * dt * scheme.b[s] * w_s * w_s * h_s * stress * e;
        w_dot.push_back(w_s * e / 2.);
        w_next += dt * scheme.b[s] * w_dot.back();
        q_next += dt * scheme.b[s] * e;
      }
      w = w_next;
      q = q_next;
      h -= dt * speed;
    }
    return energy;
  }

  void check_upsetting(const ElementPair element, const Scheme &scheme)
  {
    Parameters p = cube(element);
    harden(p);
    const RecordedRun run(p, {p.dies[0].die(), p.dies[1].die()}, {}, scheme);
    const double      by_hand = energy_by_hand(scheme, p, a), soft = energy_by_hand(scheme, p, 0.);
    const double      error = relative_error(run.state().energy.total(), by_hand);
    std::cout << "upsetting, " << (element == ElementPair::mini ? "mini" : "P2-P1") << ", " << scheme.name
              << ": increments " << run.records.size()
              << ", energy by hand within 1e-7: " << yes(error < 1e-7)
              << ", hardening adds a tenth or more: " << yes(by_hand > 1.1 * soft) << "\n";
  }

  /// A direction, or numbers of the metal: K, m, e0, a, n.
  struct Way
  {
    Direction           direction;
    std::vector<double> metal_dot = {0., 0., 0., 0., 0.};
  };

  template <typename Number>
  std::pair<Process<Number>, NodalVectors<Number>> at(const RecordedRun &run, const Way &way, const double t)
  {
    auto there = along<Number>(run, way.direction, t);
    auto dot   = way.metal_dot.begin();
    for_each_number(
      [&](Number &x) {
        x = number<Number>(value_of(x) + t * *dot, *dot);
        ++dot;
      },
      there.first.material);
    return there;
  }

  std::vector<double> values(const RecordedRun &run, const Way &way, const double t)
  {
    const auto [process, X] = at<double>(run, way, t);
    return run.replayed_values(process, X);
  }

  double by_adjoint(const RecordedRun &run, const AdjointResult &bar, const Way &way)
  {
    double sum = slope(run, bar, way.direction);
    auto   dot = way.metal_dot.begin();
    for_each_number([&](const double &x) { sum += x * *dot++; }, bar.process.material);
    return sum;
  }

  Objectives objectives()
  {
    Objectives all;
    all.push_back(
      {"energy", 1., SymmetryScaling::none, invalid_index, std::make_unique<EnergyObjective>(), nullptr});
    all.push_back({"variance of the strain",
                   1.,
                   SymmetryScaling::none,
                   invalid_index,
                   nullptr,
                   std::make_unique<StrainObjective>(StrainStatistic::variance)});
    return all;
  }

  struct Largest
  {
    double tangent = 0., difference = 0., order = 0.;
  };

  /// Along one way, of objective o.
  void check_way(RecordedRun &run, const Way &way, const std::vector<AdjointResult> &bars, Largest &largest)
  {
    const auto [process, X]                        = at<Dual>(run, way, 0.);
    const auto                            tangents = run.tangent(process, X);
    std::map<double, std::vector<double>> known;
    const auto                            value = [&](const std::size_t o, const double t) {
      if (known.count(t) == 0)
        known[t] = values(run, way, t);
      return known[t][o];
    };
    for (std::size_t o = 0; o < bars.size(); ++o)
    {
      const double adjoint = by_adjoint(run, bars[o], way);
      const double tangent = relative_error(tangents[o].dx(0), adjoint);
      double       best = 1e300, order = 0.;
      for (const double h : {1e-4, 1e-5})
        best = std::min(best, relative_error((value(o, h) - value(o, -h)) / (2. * h), adjoint));
      const auto remainder = [&](const double t) {
        return std::abs(value(o, t) - value(o, 0.) - t * adjoint);
      };
      for (const double h : {1e-2, 1e-3})
        if (const double found = std::log2(remainder(h) / remainder(0.5 * h));
            std::abs(found - 2.) < std::abs(order - 2.))
          order = found;
      largest.tangent    = std::max(largest.tangent, tangent);
      largest.difference = std::max(largest.difference, best);
      largest.order      = std::max(largest.order, std::abs(order - 2.));
    }
  }

  void check_gradients(const std::string &name, const Parameters &p, const Meshes meshes)
  {
    RecordedRun                run(p, {p.dies[0].die(), p.dies[1].die()}, objectives(), {}, meshes);
    const auto                 sweep = run.sweep(each(run.objectives()));
    const NodalVectors<double> still(run.scene.mesh.n_nodes());
    const auto                 metal = [&](const std::string &number, const unsigned int i) {
      Way way{{number, still, 0., 0., {}}};
      way.metal_dot[i] = 1.;
      return way;
    };
    Largest largest;
    for (const Way &way : {Way{{"random X_0", random_vectors(still.size()), 0., 0., {}}},
                           Way{{"speed", still, 1., 0., {}}},
                           Way{{"offset", still, 0., 1., {}}},
                           metal("K", 0),
                           metal("m", 1),
                           metal("a", 3),
                           metal("n", 4)})
      check_way(run, way, sweep.gradients, largest);
    std::cout << name << ": meshes made anew: " << (run.state().remeshed.empty() ? "none" : "some")
              << ", direct method within 1e-10: " << yes(largest.tangent < 1e-10)
              << ", differences within 1e-6: " << yes(largest.difference < 1e-6)
              << ", remainders of second order: " << yes(largest.order < 0.1) << "\n";
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) > 0)
    std::cout.setstate(std::ios::failbit);
  add_hardening_metal();
  for (const ElementPair element : {ElementPair::mini, ElementPair::taylor_hood})
    for (const Scheme &scheme : Scheme::all())
      check_upsetting(element, scheme);
  Parameters block = tilted_block();
  harden(block);
  Parameters quadratic                 = block;
  quadratic.discretization.choice.pair = ElementPair::taylor_hood;
  quadratic.billet.element_size        = 20.;
  Parameters krylov                    = block;
  krylov.linear_solver.method          = LinearSolverParameters::Method::automatic;
  check_gradients("tilted die", block, Meshes::one);
  check_gradients("tilted die, Krylov's method", krylov, Meshes::one);
  check_gradients("tilted die, quadratic velocities", quadratic, Meshes::one);
  for (Parameters *p : {&block, &quadratic})
  {
    p->press.scheme     = "euler";
    p->remeshing.when   = RemesherParameters::When::increments;
    p->remeshing.every  = 2;
    p->remeshing.method = RemesherParameters::Method::rebuild;
    p->press.increments = 5;
  }
  check_gradients("remeshing", block, Meshes::anew);
  check_gradients("remeshing, quadratic velocities", quadratic, Meshes::anew);
}
