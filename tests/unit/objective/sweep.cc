// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// All objectives within a whole forging: on a small block under a tilted die, the gradients of one backward
// sweep agree with the direct method along the speed of the die, and with central differences of replays
// along all nodes at random and along that speed.

#include <deal.II/base/mpi.h>

#include <retroforge/objective/cell_statistics.h>
#include <retroforge/objective/contact_pressure.h>
#include <retroforge/objective/effort.h>
#include <retroforge/objective/energy.h>
#include <retroforge/objective/filling.h>
#include <retroforge/objective/fold.h>
#include <retroforge/objective/shape_distance.h>
#include <retroforge/objective/unfilled_volume.h>

#include "../adjoint/recorded_run.h"
#include "../geometry/geometry_test_tools.h"
#include "objective_test_tools.h"

using namespace retroforge;

Objectives all_objectives(const unsigned int upper)
{
  Objectives objectives;
  const auto path = [&](const std::string &name, auto &&objective) {
    objectives.push_back({name,
                          1.,
                          SymmetryScaling::none,
                          invalid_index,
                          std::make_unique<std::decay_t<decltype(objective)>>(std::move(objective)),
                          nullptr});
  };
  const auto at_end = [&](const std::string &name, auto &&objective) {
    objectives.push_back({name,
                          1.,
                          SymmetryScaling::none,
                          invalid_index,
                          nullptr,
                          std::make_unique<std::decay_t<decltype(objective)>>(std::move(objective))});
  };
  const PathWindow late{PathWindow::Over::stroke, 1.1, 3.}, early{PathWindow::Over::time, 0.002, 0.019};
  path("energy", EnergyObjective());
  path("mean effort", MeanEffort(Effort(upper), late));
  path("mean force", MeanEffort(Effort(upper, Effort::By::force), early));
  path("maximum effort", MaximumEffort(Effort(upper), early, {}));
  path("fold", FoldObjective(3.));
  path("dimensionless fold", DimensionlessFold(3.));
  path("contact pressure", ContactPressure(upper, 6., 10.));

  NodalVectors<double> ball = sphere(2).vertices();
  for (Vec3 &x : ball)
    x = 24. * x + Vec3({1., 2., 14.});
  const TargetSurface target(std::make_shared<TriangleSurface>("ball", ball, sphere(2).triangles()));
  at_end("variance of the strain", CellStatistics(CellQuantity::strain, CellStatistic::variance));
  at_end("maximum strain", CellStatistics(CellQuantity::strain, CellStatistic::largest));
  at_end("shape distance", ShapeDistance(target));
  at_end("filling", FillingObjective(target, 0.01));
  at_end("filling of free nodes", FillingObjective(target, 0.01, FreeNodes(FrictionRamp{1., false})));
  at_end("unfilled volume", UnfilledVolume(target));
  return objectives;
}

/// Central differences of all objectives, of fourth order: what cancels is far below what is left out.
template <typename Values>
std::vector<double> differences(const Values &at, const double h)
{
  const auto          near_plus = at(h), near_minus = at(-h), far_plus = at(2. * h), far_minus = at(-2. * h);
  std::vector<double> slopes;
  for (std::size_t j = 0; j < near_plus.size(); ++j)
    slopes.push_back((8. * (near_plus[j] - near_minus[j]) - (far_plus[j] - far_minus[j])) / (12. * h));
  return slopes;
}

/// The direct method along the speed of the leading die.
std::vector<Dual> tangent_in_speed(RecordedRun &run)
{
  const auto constant = [](const Vec3 &v) { return Vector3<Dual>({Dual(v[0]), Dual(v[1]), Dual(v[2])}); };
  auto       process  = converted<Dual>(run.process());
  for (unsigned int i = 0; i < 3; ++i)
  {
    Dual &v           = process.dies[process.operations[0].leading_die].velocity[i];
    v.fastAccessDx(0) = v.val();
  }
  NodalVectors<Dual> X;
  for (const Vec3 &x : run.scene.mesh.X)
    X.push_back(constant(x));
  return run.tangent(process, X);
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const Parameters                         parameters = tilted_block();
  const unsigned int                       upper      = 1;
  RecordedRun run(parameters, {parameters.dies[0].die(), parameters.dies[1].die()}, all_objectives(upper));
  const auto  sweep   = run.sweep(each(run.objectives()));
  const auto  tangent = tangent_in_speed(run);

  Random               random;
  NodalVectors<double> X_dot(run.state().workpiece.X.size());
  for (Vec3 &x : X_dot)
    x = random.vector();
  const auto by_nodes = differences(
    [&](const double t) {
      NodalVectors<double> X = run.scene.mesh.X;
      for (std::size_t k = 0; k < X.size(); ++k)
        X[k] += t * X_dot[k];
      return run.replayed_values(run.process(), X);
    },
    2e-4);
  const auto by_speed = differences(
    [&](const double t) {
      Process<double> process = run.process();
      process.dies[upper].velocity *= 1. + t;
      return run.replayed_values(process, run.scene.mesh.X);
    },
    1e-3);

  Errors errors, tangents;
  for (std::size_t j = 0; j < run.objectives().size(); ++j)
  {
    const std::string &name     = run.objectives()[j].name;
    double             in_nodes = 0.;
    for (std::size_t k = 0; k < X_dot.size(); ++k)
      in_nodes += X_dot[k] * sweep.gradients[j].X_0[k];
    const double in_speed =
      sweep.gradients[j].process.dies[upper].velocity * run.process().dies[upper].velocity;
    tangents.compare(name + ", tangent", in_speed, tangent[j].dx(0));
    errors.compare(name + ", nodes", in_nodes, by_nodes[j]);
    errors.compare(name + ", speed", in_speed, by_speed[j]);
  }
  tangents.print(1e-10);
  errors.print(1e-7);
  std::cout << "FIGURE objective_gradient_error " << errors.largest() << std::endl;
}
