// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Whole runs judged by the stresses within the metal, by its damage and by the wear of a die. Proved:
// - the backward sweep agrees with the direct method to 1e-10 and with replayed differences to 1e-6, by node
//   positions, speed and offset of the die, K with m of the metal, and by the vertices of curved dies; along each the
//   remainder of Taylor's expansion falls with the square of the step. With both pairs of elements and both
//   schemes, on a block under a tilted die, of metal that hardens and warms, under a bell where
//   the mesh is made anew, and by Krylov's method;
// - damage is followed where it is asked for, is carried to new meshes, nearly within its range, and changes
//   nothing: energies have the same bits, and without it the state has no entry.

#include <deal.II/base/mpi.h>

#include <retroforge/objective/damage_statistics.h>
#include <retroforge/objective/die_wear.h>
#include <retroforge/objective/stress_maxima.h>

#include "curved_scenes.h"
#include "directions.h"

#include <algorithm>
#include <iostream>
#include <map>

using namespace retroforge;

namespace
{
  Objectives objectives()
  {
    Objectives all;
    const auto add_path = [&](const std::string &name, std::unique_ptr<PathObjective> path) {
      all.push_back({name, 1., SymmetryScaling::none, invalid_index, std::move(path), nullptr});
    };
    const auto add_final = [&](const std::string &name, std::unique_ptr<FinalObjective> at_end) {
      all.push_back({name, 1., SymmetryScaling::none, invalid_index, nullptr, std::move(at_end)});
    };
    const PathWindow   late{PathWindow::Over::stroke, 1.3, 1e9};
    const SmoothRegion region{{Vec3({-50., -50., 4.}), Vec3({50., 50., 20.})}, 5.};
    add_path("pressure", std::make_unique<StressMaximum>(InnerStress::pressure, 12., 2.));
    add_path("shear", std::make_unique<StressMaximum>(InnerStress::shear, 12., 2., late, region));
    add_path("wear", std::make_unique<DieWear>(1, Wear::mean));
    add_path("wear late", std::make_unique<DieWear>(1, Wear::total, late));
    add_final("damage", std::make_unique<DamageObjective>(DamageStatistic::largest));
    add_final("mean damage", std::make_unique<DamageObjective>(DamageStatistic::mean));
    return all;
  }

  /// A direction, or K or m of the metal.
  struct Way
  {
    Direction direction;
    double    K_dot = 0., m_dot = 0.;
  };

  template <typename Number>
  std::pair<Process<Number>, NodalVectors<Number>> at(const RecordedRun &run, const Way &way, const double t)
  {
    auto  there = along<Number>(run, way.direction, t);
    auto &law   = there.first.material.law;
    law.K       = number<Number>(value_of(law.K) + t * way.K_dot, way.K_dot);
    law.m       = number<Number>(value_of(law.m) + t * way.m_dot, way.m_dot);
    return there;
  }

  struct Largest
  {
    double      tangent = 0., difference = 0., order = 0.;
    std::string of_tangent, of_difference, of_order;
  };

  void take_larger(const double value, const std::string &name, double &largest, std::string &of_largest)
  {
    if (value <= largest) // so that a NaN counts as larger
      return;
    largest    = value;
    of_largest = name;
  }

  void check_way(RecordedRun &run, const Way &way, const std::vector<AdjointResult> &bars, Largest &largest)
  {
    const auto [process, X]                        = at<Dual>(run, way, 0.);
    const auto                            tangents = run.tangent(process, X);
    std::map<double, std::vector<double>> known;
    const auto                            value = [&](const std::size_t o, const double t) {
      if (known.count(t) == 0)
      {
        const auto [moved, there] = at<double>(run, way, t);
        known[t]                  = run.replayed_values(moved, there);
      }
      return known[t][o];
    };
    for (std::size_t o = 0; o < bars.size(); ++o)
    {
      const double adjoint = slope(run, bars[o], way.direction) + way.K_dot * bars[o].process.material.law.K +
                             way.m_dot * bars[o].process.material.law.m;
      double best = 1e300, order = 0.;
      for (const double h : {1e-4, 1e-6})
        best = std::min(best, relative_error((value(o, h) - value(o, -h)) / (2. * h), adjoint));
      const auto remainder = [&](const double t) {
        return std::abs(value(o, t) - value(o, 0.) - t * adjoint);
      };
      for (const double h : {1e-2, 1e-3, 1e-4})
        if (const double found = std::log2(remainder(h) / remainder(0.5 * h));
            std::abs(found - 2.) < std::abs(order - 2.))
          order = found;
      const std::string name = run.objectives()[o].name + " by " + way.direction.name;
      take_larger(relative_error(tangents[o].dx(0), adjoint), name, largest.tangent, largest.of_tangent);
      take_larger(best, name, largest.difference, largest.of_difference);
      take_larger(std::abs(order - 2.), name, largest.order, largest.of_order);
    }
  }

  Parameters damaged(Parameters p)
  {
    p.material.damage = Damage::latham_cockcroft;
    return p;
  }

  void check_gradients(const std::string &name, const Parameters &p, const Meshes meshes = Meshes::one)
  {
    RecordedRun                run(damaged(p), {p.dies[0].die(), p.dies[1].die()}, objectives(), {}, meshes);
    const auto                 sweep  = run.sweep(each(run.objectives()));
    const auto                &damage = run.state().workpiece.damage;
    const NodalVectors<double> still(run.scene.mesh.n_nodes());
    std::vector<Way>           ways = {Way{{"random X_0", random_vectors(still.size()), 0., 0., {}}},
                                       Way{{"speed", still, 1., 0., {}}},
                                       Way{{"offset", still, 0., 1., {}}},
                                       Way{{"K and m", still, 0., 0., {}}, 1., 0.1}};
    if (run.scene.dies[1].surface())
      ways.push_back({random_vertices(run)});
    Largest largest;
    for (const Way &way : ways)
      check_way(run, way, sweep.gradients, largest);
    std::cout << name << ": meshes made anew: " << (run.state().remeshed.empty() ? "none" : "some")
              << ", damaged: " << yes(*std::max_element(damage.begin(), damage.end()) > 1e-3)
              << ", hardly below zero anywhere: "
              << yes(*std::min_element(damage.begin(), damage.end()) >
                     -0.01 * *std::max_element(damage.begin(), damage.end()))
              << ", direct method within 1e-10: " << yes(largest.tangent < 1e-10)
              << ", differences within 1e-6: " << yes(largest.difference < 1e-6)
              << ", remainders of second order: " << yes(largest.order < 0.05) << "\n";
    if (!(largest.tangent < 1e-10))
      std::cout << "  direct method: " << largest.tangent << ", " << largest.of_tangent << "\n";
    if (!(largest.difference < 1e-6))
      std::cout << "  differences: " << largest.difference << ", " << largest.of_difference << "\n";
    if (!(largest.order < 0.05))
      std::cout << "  order: " << largest.order << ", " << largest.of_order << "\n";
  }

  Parameters quadratic(Parameters p, const double element_size)
  {
    p.discretization.choice.pair = ElementPair::taylor_hood;
    p.billet.element_size        = element_size;
    return p;
  }

  Parameters remeshed(Parameters p)
  {
    p.remeshing.when   = RemesherParameters::When::increments;
    p.remeshing.every  = 2;
    p.remeshing.method = RemesherParameters::Method::rebuild;
    return p;
  }

  /// Hardens by its strain, and softens by its warmth.
  Parameters hardening(Parameters p)
  {
    p.material.type        = "power";
    p.material.numbers     = {{"n", 0.3}, {"q0", 0.1}, {"beta", 0.002}, {"m1", 1e-4}, {"T0", 900.}};
    p.material.temperature = "1000";
    p.heat.heating         = Heating::adiabatic;
    p.heat.capacity        = 0.05;
    return p;
  }

  void check_cost()
  {
    const Parameters  p = hardening(remeshed(tilted_block()));
    const RecordedRun without(p, {p.dies[0].die(), p.dies[1].die()}, {}, {}, Meshes::anew),
      with(damaged(p), {p.dies[0].die(), p.dies[1].die()}, {}, {}, Meshes::anew);
    std::cout << "not asked for: no entry: " << yes(without.state().workpiece.damage.empty())
              << ", the same energy: " << yes(without.state().energy.total() == with.state().energy.total())
              << "\n";
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) > 0)
    std::cout.setstate(std::ios::failbit);
  const Parameters block  = tilted_block();
  Parameters       krylov = block, euler = remeshed(block), curved = remeshed(bell_scene());
  krylov.linear_solver.method = LinearSolverParameters::Method::automatic;
  euler.press.scheme          = "euler";
  euler.press.increments      = 5;
  check_gradients("tilted die", block);
  check_gradients("tilted die, Krylov's method", krylov);
  check_gradients("tilted die, quadratic velocities", quadratic(block, 20.));
  check_gradients("remeshing, hardening and warming", hardening(euler), Meshes::anew);
  check_gradients("remeshing, quadratic velocities", quadratic(euler, 20.), Meshes::anew);
  check_gradients("remeshing under a bell", curved, Meshes::anew);
  check_cost();
}
