// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// A process of two operations in whole runs of a block: a tilted die, then another one in its place.
// - Half a stroke, and the other half by a die that stands where the first one stopped, is the whole stroke.
// - The record tells the operation of each increment, whose stroke begins at 0; strokes and times of the
//   process go on.
// - A run that is restored from the record in the second operation is the same to the bit, and goes on as one
//   that was not.
// - The derivative of the energy by the positions of the nodes, the speeds and the offsets of both dies and
//   by K: by the adjoint and by the direct method, to 1e-10; differences of replays, to 1e-6.

#include "directions.h"

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

  /// A number of the process by which derivatives are taken, or the nodes along a direction.
  struct Way
  {
    std::string  name;
    unsigned int die    = invalid_index;
    bool         offset = false;

    template <typename Number>
    void move(Process<Number> &process, const Number &t) const
    {
      if (die == invalid_index)
        process.material.law.K += t;
      else if (offset)
        process.dies[die].displacement[2] += t;
      else
        process.dies[die].velocity[2] += t;
    }

    double of(const Process<double> &bar) const
    {
      return die == invalid_index ? bar.material.law.K
             : offset             ? bar.dies[die].displacement[2]
                                  : bar.dies[die].velocity[2];
    }
  };

  double best_difference(const std::function<double(double)> &energy, const double adjoint, const double size)
  {
    double best = 1e300;
    for (const double h : {1e-3, 1e-4, 1e-5})
      best =
        std::min(best, relative_error((energy(h * size) - energy(-h * size)) / (2. * h * size), adjoint));
    return best;
  }

  void check_derivatives(const ForwardRun &run)
  {
    const AdjointResult bar  = run.sweep(each(run.objectives())).gradients[0];
    const auto          tell = [](const std::string &name, const double direct, const double differences) {
      std::cout << "  by " << name << ": direct method within 1e-10: " << yes(direct < 1e-10)
                << ", differences within 1e-6: " << yes(differences < 1e-6) << "\n";
    };
    NodalVectors<Dual> X;
    convert(run.X_0(), X);
    for (const Way &way : {Way{"K"},
                           Way{"the speed of the first die", 1},
                           Way{"the speed of the second die", 2},
                           Way{"the offset of the first die", 1, true},
                           Way{"the offset of the second die", 2, true}})
    {
      Dual t(0.);
      t.fastAccessDx(0)  = 1.;
      auto         along = converted<Dual>(run.process());
      const double found = way.of(bar.process);
      way.move(along, t);
      tell(way.name,
           relative_error(run.tangent(along, X)[0].dx(0), found),
           best_difference(
             [&](const double change) {
               Process<double> process = run.process();
               way.move(process, change);
               return run.replay(process, run.X_0()).energy.total();
             },
             found,
             way.die == invalid_index || way.offset ? 1. : 100.));
    }
    const NodalVectors<double> X_dot = random_vectors(run.X_0().size());
    double                     found = 0.;
    for (std::size_t k = 0; k < X_dot.size(); ++k)
      found += bar.X_0[k] * X_dot[k];
    tell("the nodes",
         relative_error(
           run.tangent(converted<Dual>(run.process()), moved<Dual>(run.X_0(), X_dot, 0.))[0].dx(0), found),
         best_difference(
           [&](const double t) {
             return run.replay(run.process(), moved<double>(run.X_0(), X_dot, t)).energy.total();
           },
           found,
           1.));
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
  ForwardRun run(problem_of(p, 3., 2.), ForwardRun::Keep::increments, timings_of_runs());
  double     stroke = 0., time = 0.;
  bool       goes_on = true;
  run.forge([&](const IncrementEvent &event) {
    const double now = run.process().whole_stroke(event.state.stroke, event.state.operation);
    goes_on          = goes_on && std::abs(now - stroke - event.record.step) < 1e-12 && event.time > time;
    stroke           = now;
    time             = event.time;
    std::cout << "operation " << event.record.operation << " from " << event.record.stroke << " by "
              << event.record.step << " mm\n";
  });
  run.values();
  std::cout << "strokes and times go on: " << yes(goes_on) << ", to " << stroke
            << " mm, none left: " << yes(!run.is_left()) << "\n";
  check_restored(run, p, run.state().increments - 1);
  check_derivatives(run);
}
