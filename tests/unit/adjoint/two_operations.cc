// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// A process of two operations in whole runs of a block: a tilted die, then another one in its place.
// - Half a stroke, and the other half by a die that stands where the first one stopped, is the whole stroke.
// - The record tells the operation of each increment, whose stroke begins at 0; strokes and times of the
//   process go on.
// - A run that is restored from the record in the second operation is the same to the bit, and goes on as one
//   that was not.
// - Efforts of the dies are those of their operations: times the strokes they are the energy, to 1e-12; a window of stroke
//   counts from the start of the first one, and has none of a die that stands in the other one.
// - The derivatives of the energy, of both mean efforts, and of the largest one of the second die, of a window, by the
//   positions of the nodes, the speeds and the offsets of both dies and by K: by the adjoint and by the direct method, to
//   1e-10; differences of replays, to 1e-6.

#include "ways.h"

#include <retroforge/core/error.h>
#include <retroforge/objective/effort.h>

#include <deal.II/base/mpi.h>

#include <cmath>
#include <functional>
#include <iostream>

using namespace retroforge;

namespace
{
  /// The tilted block with a third die, which stands in the second operation.
  Parameters three_dies(const Vec3 &point, const Vec3 &facing, const Vec3 &velocity)
  {
    Parameters p = tilted_block();
    p.dies.emplace_back("second");
    p.dies[2].point    = point;
    p.dies[2].facing   = facing;
    p.dies[2].velocity = velocity;
    p.dies[2].friction = 0.4;
    return p;
  }

  ForgingProblem problem_of(const Parameters &p, const double first, const double second)
  {
    ForgingProblem problem =
      problem_between(resolved(p, Meshes::one), {p.dies[0].die(), p.dies[1].die(), p.dies[2].die()}, {}, {});
    Operation<double> operation = problem.process.operations.front();
    operation.dies              = {0, 1};
    operation.leading_die       = 1;
    operation.stroke            = first;
    problem.process.operations  = {operation, {{0, 2}, 2, 1., {}, second}};
    return problem;
  }

  void check_halves()
  {
    // Metal begins an operation at rest, which the width of ramps sees: here it is one everywhere.
    Parameters p            = tilted_block();
    p.contact.ramp_at_walls = 1.;
    Parameters three =
      three_dies(p.dies[1].point - Vec3({0., 0., 1.5}), p.dies[1].facing, p.dies[1].velocity);
    three.contact.ramp_at_walls = 1.;
    ForwardRun halves(problem_of(three, 1.5, 1.5), ForwardRun::Keep::increments, timings_of_runs());
    halves.forge();
    const RecordedRun whole(p);
    const double      error = relative_error(halves.state().energy.total(), whole.state().energy.total());
    double            apart = 0.;
    for (std::size_t k = 0; k < whole.X_0().size(); ++k)
      apart = std::max(apart, (halves.state().workpiece.X[k] - whole.state().workpiece.X[k]).norm());
    std::cout << "two halves: increments " << halves.state().increments << " of " << whole.state().increments
              << ", energy within 1e-9: " << yes(error < 1e-9)
              << ", nodes within 1e-8 mm: " << yes(apart < 1e-8) << "\n";
  }

  /// Of both dies over the whole run, and of the second one over a part of its stroke.
  void add_efforts(Objectives &objectives)
  {
    const auto add =
      [&](const std::string &name, const unsigned int die, std::unique_ptr<const PathObjective> path) {
        objectives.push_back({name, 1., SymmetryScaling::force, die, std::move(path), nullptr});
      };
    const PathWindow end{PathWindow::Over::stroke, 3.4, 4.9}, all, last{PathWindow::Over::stroke, 4.5};
    add("effort of the first die", 1, std::make_unique<MeanEffort>(Effort(1), all));
    add("effort of the second die", 2, std::make_unique<MeanEffort>(Effort(2), all));
    add("largest", 2, std::make_unique<MaximumEffort>(Effort(2, Effort::By::force), end, SmoothMaximum{}));
    add("at the end", 2, std::make_unique<MeanEffort>(Effort(2), last));
  }

  void check_efforts(RecordedRun &run)
  {
    const std::vector<double> values = run.values();
    std::cout << "efforts are those of their operations: "
              << yes(relative_error(3. * values[1] + 2. * values[2], run.state().energy.total()) < 1e-12)
              << ", the largest one within 10 % of that at the end: "
              << yes(std::abs(values[3] / values[4] - 1.) < 0.1) << "\n";
    const auto refused = [&](const PathWindow &window) {
      Objectives objectives;
      objectives.push_back(
        {"none", 1., SymmetryScaling::force, 1, std::make_unique<MeanEffort>(Effort(1), window), nullptr});
      ForgingProblem problem = problem_of(run.parameters, 3., 2.);
      problem.objectives     = std::move(objectives);
      ForwardRun other(std::move(problem), ForwardRun::Keep::nothing, timings_of_runs());
      try
      {
        other.forge();
        other.values();
        return false;
      }
      catch (const Error &)
      {
        return true;
      }
    };
    std::cout << "a window in which the die does not stand: refused: "
              << yes(refused({PathWindow::Over::stroke, 3.1, 5.})) << "\n";
  }

  void check_derivatives(const RecordedRun &run)
  {
    const auto                 sweep = run.sweep(each(run.objectives()));
    const NodalVectors<double> still(run.scene.mesh.n_nodes());
    std::vector<Way>           ways = {Way{{"the nodes", random_vectors(still.size()), 0., 0., {}}},
                                       Way{{"the speed of the first die", still, 1., 0., {}}},
                                       Way{{"the offset of the first die", still, 0., 1., {}}}};
    const auto add = [&](const std::string &of, const std::function<void(Process<double> &)> &dots) {
      ways.push_back({{of, still, 0., 0., {}}, dots});
    };
    add("K", [](Process<double> &dot) { dot.material.law.K = 1.; });
    add("the speed of the second die", [](Process<double> &dot) { dot.dies[2].velocity[2] = -80.; });
    add("the offset of the second die", [](Process<double> &dot) { dot.dies[2].displacement[2] = 1.; });
    for (std::size_t o = 0; o < sweep.gradients.size(); ++o)
    {
      WorstErrors worst;
      for (const Way &way : ways)
        worst.take(slope_errors(run, way, sweep.gradients, 1e-3)[o], way.direction.name);
      worst.print(run.objectives()[o].name + ": ");
    }
  }

  /// Restored after some increments of the second operation.
  void check_restored(const ForwardRun &run, const Parameters &p, const unsigned int n)
  {
    ForwardRun again(problem_of(p, 3., 2.), ForwardRun::Keep::increments, timings_of_runs());
    again.restore(n, run.recording().access(), [](const IncrementEvent &) {});
    std::cout << "restored in operation " << again.state().operation << ", left: " << yes(again.is_left());
    again.forge();
    std::cout << ", goes on as if nothing had been: "
              << yes(again.state().workpiece.X == run.state().workpiece.X &&
                     again.state().energy.total() == run.state().energy.total())
              << "\n";
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  check_halves();
  const Parameters p =
    three_dies(Vec3({0., 0., 30.}), Vec3({0.029809, -0.049900, -0.998309}), Vec3({0, 0, -80.}));
  ForgingProblem problem = problem_of(p, 3., 2.);
  add_efforts(problem.objectives);
  RecordedRun run(std::move(problem));
  double      stroke  = 0.;
  bool        goes_on = true;
  for (const IncrementRecord &record : run.records)
  {
    const double now = run.process().whole_stroke(record.stroke + record.step, record.operation);
    goes_on          = goes_on && std::abs(now - stroke - record.step) < 1e-12;
    stroke           = now;
    std::cout << "operation " << record.operation << " from " << record.stroke << " by " << record.step
              << " mm\n";
  }
  std::cout << "strokes go on: " << yes(goes_on) << ", to " << stroke
            << " mm, none left: " << yes(!run.is_left()) << "\n";
  check_restored(run, p, run.state().increments - 1);
  check_efforts(run);
  check_derivatives(run);
}
