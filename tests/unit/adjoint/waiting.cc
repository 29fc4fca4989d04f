// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Transfer and dwell before each operation of a process: the tilted block of hot metal under one die, then, after some
// time in air and some on the lower die, under another one.
// - The step before a later stroke is that before the first one, to the bit, where metal and dies are the same, and there
//   is none further along a stroke.
// - Cooling in air of metal that conducts well, before the second stroke, is  T_a + (T - T_a) exp(-h A t/(rho c V))  on the
//   mean; the surface is colder than that by h L/(3 k) = 1e-3 of T - T_a, L half the edge of the block.
// - Times go on over the wait; those on dies leave out that in the air; the run without a wait ends hotter.
// - The derivatives of the energy, of the least temperature and of a mean effort over a time of the second stroke by both transfers and dwells, films, temperatures of metal and
//   dies, speed and offset of the second die and the nodes: by the adjoint and by the direct method to 1e-10, differences of
//   replays to 1e-6, order 2; on one mesh, and where the mesh is made anew; on two ranks a few of
//   them, with new meshes.
// - A run that is restored in the second operation, or just before it, is the same to the bit, and goes on as one that was
//   not (a direct solver on two ranks leaves rounding).
// - The times are design parameters, by their operation.
// - Times that are none, a die to wait on that is not there, a dwell without a film: one message each.

#include <retroforge/core/error.h>
#include <retroforge/objective/effort.h>
#include <retroforge/objective/temperatures.h>

#include <deal.II/base/mpi.h>

#include "two_strokes.h"
#include "ways.h"

using namespace retroforge;

namespace
{
  constexpr unsigned int first = 0, second = 1;

  unsigned int n_ranks()
  {
    return dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  }

  ForgingProblem problem_of(const Parameters &p, const Meshes meshes = Meshes::one)
  {
    ForgingProblem problem = two_strokes(p, meshes, {});
    problem.objectives.push_back({"coldest",
                                  1.,
                                  SymmetryScaling::none,
                                  invalid_index,
                                  nullptr,
                                  std::make_unique<TemperatureObjective>(TemperatureExtreme::least, 5.)});
    return problem;
  }

  /// Temperatures and skins after the first half of an increment.
  WorkpieceState<3, double>
  conducted(const RecordedRun &run, const Process<double> &process, const StrokeStep &at, const bool uniform)
  {
    const NetworkEdges        edges(run.scene.mesh, run.scene.topology);
    WorkpieceState<3, double> state = run.state().workpiece;
    state.X                         = run.X_0();
    if (uniform)
      state.temperature.assign(state.temperature.size(), 1000.);
    conduct_before(run.scene, edges, process, at, state);
    return state;
  }

  void check_step(const RecordedRun &run)
  {
    Process<double> process       = run.process();
    process.operations[1]         = process.operations[0];
    const auto before_first       = conducted(run, process, {0., 0.5, first}, false);
    const auto before_second      = conducted(run, process, {0., 0.5, second}, false);
    const auto further            = conducted(run, process, {0.5, 0.5, second}, false);
    process.operations[1].waiting = {};
    const auto no_wait            = conducted(run, process, {0., 0.5, second}, false);
    std::cout << "before the second stroke as before the first: "
              << yes(before_first.temperature == before_second.temperature &&
                     before_first.skin == before_second.skin)
              << ", not further on: " << yes(further.temperature != before_second.temperature)
              << ", and the wait matters: " << yes(no_wait.temperature != before_second.temperature) << "\n";
  }

  void check_cooling(const RecordedRun &run)
  {
    Process<double> process                = run.process();
    process.heat.conductivity              = 100.;
    process.heat.emissivity                = 0.;
    process.heat.waiting_steps             = 40;
    process.operations[second].waiting     = {0.7, 0., 0};
    process.dies[2].velocity               = Vec3({0., 0., -1e9}); // nothing flows under the press
    const WorkpieceState<3, double> cooled = conducted(run, process, {0., 0.5, second}, true);
    const double                    area   = 5. * 900. + 900.,
                 per_second                = process.heat.air_film * area / (process.heat.capacity * 27000.),
                 surroundings              = process.heat.surroundings;
    const double exact = surroundings + (1000. - surroundings) * std::exp(-0.7 * per_second);
    const auto   volumes =
      conduction_network(run.scene.mesh, NetworkEdges(run.scene.mesh, run.scene.topology), run.X_0()).volumes;
    double mean = 0.;
    for (std::size_t k = 0; k < volumes.size(); ++k)
      mean += volumes[k] * cooled.temperature[k] / 27000.;
    const double error = std::abs(mean - exact) / (1000. - exact);
    std::cout << "cooling in air by " << std::round(1000. - exact)
              << " K on the mean, within 3e-3 of it: " << yes(error < 3e-3) << "\n";
    if (error >= 3e-3)
      std::cout << "  off by " << error << "\n";
  }

  void check_times()
  {
    std::vector<double>       times;
    std::vector<unsigned int> of;
    std::array<double, 2>     coldest{};
    for (const bool waits : {false, true})
    {
      ForgingProblem problem = problem_of(block_of_two_strokes());
      if (!waits)
        problem.process.operations[second].waiting = {};
      ForwardRun run(std::move(problem), ForwardRun::Keep::nothing, timings_of_runs());
      times = {0.};
      of    = {};
      run.forge([&](const IncrementEvent &event) {
        times.push_back(event.time);
        of.push_back(event.record.operation);
      });
      coldest[waits]  = run.values()[1];
      const auto &end = run.state();
      if (waits)
        std::cout << "time on dies within 1e-12: "
                  << yes(std::abs(run.process().time_on_dies(end.stroke, end.operation) -
                                  (run.process().whole_time(end.stroke, end.operation) + 0.1 - 0.4)) < 1e-12)
                  << "\n";
    }
    double jump = 0.;
    for (std::size_t i = 1; i < of.size(); ++i)
      if (of[i] != of[i - 1])
        jump = times[i + 1] - times[i];
    std::cout << "time goes on over the wait: " << yes(jump > 0.6 && jump < 0.65)
              << ", metal that waits ends colder: " << yes(coldest[1] < coldest[0] - 1.) << "\n";
  }

  void check_derivatives(const std::string &name, const Parameters &p, const Meshes meshes)
  {
    ForgingProblem problem = problem_of(p, meshes);
    // The second stroke goes from 0.63 to 0.655 s: parts of increments at both ends.
    problem.objectives.push_back(
      {"force of the second die in a time",
       1.,
       SymmetryScaling::force,
       2,
       std::make_unique<MeanEffort>(Effort(2, Effort::By::force),
                                    PathWindow{PathWindow::Over::time, 0.634, 0.651}),
       nullptr});
    RecordedRun                run(std::move(problem));
    const auto                 sweep = run.sweep(each(run.objectives()));
    const NodalVectors<double> still(run.scene.mesh.n_nodes());
    std::vector<Way>           ways = {Way{{"random X_0", random_vectors(still.size()), 0., 0., {}}},
                                       Way{{"speed of the first die", still, 1., 0., {}}},
                                       Way{{"offset of the first die", still, 0., 1., {}}}};
    const auto add = [&](const std::string &of, const std::function<void(Process<double> &)> &dots) {
      ways.push_back({{of, still, 0., 0., {}}, dots});
    };
    add("speed of the second die", [](Process<double> &dot) { dot.dies[2].velocity[2] = -80.; });
    add("offset of the second die", [](Process<double> &dot) { dot.dies[2].displacement[2] = 1.; });
    add("temperature of the second die", [](Process<double> &dot) { dot.dies[2].temperature = 100.; });
    add("temperature of the lower die", [](Process<double> &dot) { dot.dies[0].temperature = 100.; });
    add("T_0", [](Process<double> &dot) { dot.material.initial.temperature = 100.; });
    for (const unsigned int o : {first, second})
    {
      add("transfer", [o](Process<double> &dot) { dot.operations[o].waiting.transfer = 0.4; });
      add("dwell", [o](Process<double> &dot) { dot.operations[o].waiting.dwell = 0.2; });
    }
    const HeatLaw<double> heat = run.process().heat;
    add("contact film", [heat](Process<double> &dot) { dot.heat.contact_film = heat.contact_film; });
    add("dwell film", [heat](Process<double> &dot) { dot.heat.dwell_film = heat.dwell_film; });
    add("air film", [heat](Process<double> &dot) { dot.heat.air_film = heat.air_film; });
    add("heat capacity", [heat](Process<double> &dot) { dot.heat.capacity = heat.capacity; });
    add("conductivity", [heat](Process<double> &dot) { dot.heat.conductivity = heat.conductivity; });
    add("die effusivity", [heat](Process<double> &dot) { dot.heat.die_effusivity = heat.die_effusivity; });
    WorstErrors       worst;
    const std::size_t every = n_ranks() > 1 ? 5 : 1;
    for (std::size_t i = 0; i < ways.size(); i += every)
    {
      const auto errors =
        slope_errors(run, ways[i], sweep.gradients, 1e-3, 1e-5); // as in material/hardening_runs
      for (std::size_t o = 0; o < errors.size(); ++o)
        worst.take(errors[o], run.objectives()[o].name + " by " + ways[i].direction.name);
    }
    worst.print(name + ": meshes made anew: " + (run.state().remeshed.empty() ? "none" : "some") + ", ");
  }

  void check_restored(const RecordedRun &run)
  {
    for (const unsigned int beyond : {0u, 1u})
    {
      unsigned int n = beyond;
      for (const IncrementRecord &record : run.records)
        n += record.operation == first ? 1 : 0;
      ForwardRun again(problem_of(block_of_two_strokes()), ForwardRun::Keep::increments, timings_of_runs());
      again.restore(n, run.recording().access(), [](const IncrementEvent &) {});
      const auto before = run.state().remembered[n].start.get();
      std::cout << "restored with " << beyond << " increments of the second operation to the bit: "
                << yes(again.state().workpiece.temperature == before.temperature &&
                       again.state().workpiece.skin == before.skin &&
                       again.state().workpiece.strain == before.strain);
      again.forge();
      double      apart = 0.;
      const auto &end = again.state().workpiece, &whole = run.state().workpiece;
      for (std::size_t k = 0; k < end.temperature.size(); ++k)
        apart = std::max(
          {apart, std::abs(end.temperature[k] - whole.temperature[k]), (end.X[k] - whole.X[k]).norm()});
      std::cout << ", goes on as if nothing had been, within 1e-11 K and mm: " << yes(apart < 1e-11) << "\n";
    }
  }

  void check_design(const RecordedRun &run)
  {
    const Parameters &p      = run.parameters;
    const double      height = p.billet.size[2];
    const Design      design({"heat/transfer time", "operation 2/dwell time", "operation 2/transfer time"},
                        p.billet,
                        p.dies,
                        run.process(),
                        p.open_contact({height, height}),
                        first_mesh(p.billet, run.scene.mesh));
    const Process<double> changed = design.process(std::vector<double>{1., 2., 3.});
    const auto            bar     = run.sweep(each(run.objectives())).gradients[0];
    const auto            slopes  = design.pull_back(design.nominal(), bar.X_0, bar.process);
    std::cout << "design parameters:";
    for (unsigned int j = 0; j < 3; ++j)
      std::cout << ' ' << design.parameters()[j].name << " = " << design.nominal()[j] << ' '
                << design.parameters()[j].unit << (j < 2 ? "," : "\n");
    std::cout << "  set: "
              << yes(changed.operations[0].waiting.transfer == 1. &&
                     changed.operations[1].waiting.dwell == 2. &&
                     changed.operations[1].waiting.transfer == 3. &&
                     changed.operations[0].waiting.dwell == 0.1)
              << ", pulled back: "
              << yes(slopes[0] == bar.process.operations[0].waiting.transfer &&
                     slopes[1] == bar.process.operations[1].waiting.dwell &&
                     slopes[2] == bar.process.operations[1].waiting.transfer)
              << ", a later wait makes the forging harder: " << yes(slopes[1] > 0. && slopes[2] > 0.) << "\n";
  }

  void check_refusals()
  {
    const auto refuse = [](const std::function<void(Process<double> &)> &spoil) {
      ForgingProblem problem = problem_of(block_of_two_strokes());
      spoil(problem.process);
      try
      {
        ForwardRun(std::move(problem), ForwardRun::Keep::nothing, timings_of_runs()).check();
        std::cout << "not refused: NO\n";
      }
      catch (const Error &error)
      {
        std::cout << error.what() << "\n";
      }
    };
    refuse([](Process<double> &process) { process.operations[1].waiting.transfer = -1.; });
    refuse([](Process<double> &process) { process.operations[1].waiting.dwell = std::nan(""); });
    refuse([](Process<double> &process) { process.operations[1].waiting.resting_die = 1; });
    refuse([](Process<double> &process) { process.operations[1].waiting.resting_die = 7; });
    refuse([](Process<double> &process) { process.heat.dwell_film = 0.; });
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) > 0)
    std::cout.setstate(std::ios::failbit);
  const RecordedRun run(problem_of(block_of_two_strokes()));
  check_step(run);
  check_cooling(run);
  check_times();
  check_restored(run);
  check_design(run);
  check_refusals();
  if (n_ranks() == 1)
    check_derivatives("one mesh", block_of_two_strokes(), Meshes::one);
  Parameters remeshed       = block_of_two_strokes();
  remeshed.remeshing.when   = RemesherParameters::When::increments;
  remeshed.remeshing.every  = 2;
  remeshed.remeshing.method = RemesherParameters::Method::rebuild;
  remeshed.press.increments = 5;
  check_derivatives("remeshed", remeshed, Meshes::anew);
}
