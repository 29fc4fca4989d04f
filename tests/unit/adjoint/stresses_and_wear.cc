// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Whole runs judged by the stresses within the metal, by its damage and by the wear of a die. Proved:
// - the backward sweep agrees with the direct method to 1e-10 and with replayed differences to 1e-6, by node
//   positions, speed and offset of the die, K with m of the metal, and by the vertices of curved dies; along each the
//   remainder of Taylor's expansion falls with the square of the step. With both pairs of elements and both
//   schemes, on a block under a tilted die, of metal that hardens and warms, under a bell where
//   the mesh is made anew, and by Krylov's method;
// - damage is followed where it is asked for, is carried to new meshes, nowhere below zero, and changes
//   nothing: energies have the same bits, and without it the state has no entry.

#include <deal.II/base/mpi.h>

#include <retroforge/objective/cell_statistics.h>
#include <retroforge/objective/die_wear.h>
#include <retroforge/objective/largest_wear.h>
#include <retroforge/objective/stress_maxima.h>

#include "curved_scenes.h"
#include "ways.h"

using namespace retroforge;

namespace
{
  Objectives objectives(const Parameters &p)
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
    add_path(
      "largest wear",
      std::make_unique<LargestWear>(
        1, DieSites(p.dies[1].die(), make_billet(p.billet, MPI_COMM_WORLD), Vec3({0., 0., -1.}), 25.), 12.));
    add_final("damage", std::make_unique<CellStatistics>(CellQuantity::damage, CellStatistic::largest));
    add_final("mean damage", std::make_unique<CellStatistics>(CellQuantity::damage, CellStatistic::mean));
    return all;
  }

  Parameters damaged(Parameters p)
  {
    p.material.damage = Damage::latham_cockcroft;
    return p;
  }

  void check_gradients(const std::string &name, const Parameters &p, const Meshes meshes = Meshes::one)
  {
    RecordedRun                run(damaged(p), {p.dies[0].die(), p.dies[1].die()}, objectives(p), {}, meshes);
    const auto                 sweep  = run.sweep(each(run.objectives()));
    const auto                &damage = run.state().workpiece.damage;
    const NodalVectors<double> still(run.scene.mesh.n_nodes());
    std::vector<Way>           ways = {Way{{"random X_0", random_vectors(still.size()), 0., 0., {}}},
                                       Way{{"speed", still, 1., 0., {}}},
                                       Way{{"offset", still, 0., 1., {}}},
                                       Way{{"K and m", still, 0., 0., {}}, [](Process<double> &dot) {
                                   dot.material.law.K = 1.;
                                   dot.material.law.m = 0.1;
                                 }}};
    if (run.scene.dies[1].surface())
      ways.push_back({random_vertices(run)});
    WorstErrors worst;
    for (const Way &way : ways)
    {
      const auto errors = slope_errors(run, way, sweep.gradients);
      for (std::size_t o = 0; o < errors.size(); ++o)
        worst.take(errors[o], run.objectives()[o].name + " by " + way.direction.name);
    }
    const auto [least, largest] = std::minmax_element(damage.begin(), damage.end());
    worst.print(name + ": meshes made anew: " + (run.state().remeshed.empty() ? "none" : "some") +
                ", damaged: " + yes(*largest > 1e-3) + ", nowhere below zero: " + yes(*least >= 0.) + ", ");
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
