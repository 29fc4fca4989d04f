// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
//
// The energy and its adjoint derivative along one design parameter, at equally spaced values, one line of CSV
// each:
//   roughness_scan CASE.prm FROM TO POINTS [Section/name=value]...
// The mesh is made once: values differ by the design's map only, and all decisions are taken anew at each.

#include <deal.II/base/mpi.h>

#include <retroforge/adjoint/sweep.h>
#include <retroforge/core/error.h>
#include <retroforge/parameters.h>

#include <cstdio>
#include <iostream>

using namespace retroforge;

namespace
{
  std::vector<Die> make_dies(const std::vector<DieParameters> &parameters)
  {
    std::vector<Die> dies;
    for (const auto &die : parameters)
      dies.push_back(die.die());
    return dies;
  }

  struct Scan
  {
    explicit Scan(const Parameters &all)
        : parameters(all)
        , mesh(make_billet(all.billet, MPI_COMM_WORLD))
        , nominal(parameters.settle(all.billet.size[2]).process(all.billet.size[2]))
        , model{make_dies(all.dies),
                parameters.step_model(),
                parameters.newton,
                parameters.linear_solver,
                MPI_COMM_WORLD}
        , design(all.design.names, all.billet, all.dies, nominal, mesh)
        , leg(std::make_shared<Leg>(mesh, model, timings))
        , remesher(parameters.remeshing, parameters.edge_length(mesh), model.dies, MPI_COMM_WORLD)
        , forging(model, parameters.press, remesher, timings)
    {
    }

    void print_line(const double mu)
    {
      const std::vector<double>    value   = {mu};
      const Process<double>        process = design.process(value);
      std::vector<IncrementRecord> records;
      ForgingState                 forged     = forging.start(leg, design.positions(value));
      const Objectives             objectives = parameters.make_objectives(model.dies);
      ObjectiveTrace               trace(objectives, model, process);
      forging.run(process, forged, [&](const IncrementEvent &event) {
        records.push_back(event.record);
        trace.add(event);
      });
      const RecordedForging run{model,
                                leg,
                                process,
                                [&](const unsigned int i) -> const IncrementRecord & { return records[i]; },
                                forged.increments,
                                objectives,
                                timings};
      const AdjointResult   result = adjoint_sweep(run, trace.rows(), forged, each(objectives)).of[0];
      std::printf("%.17g,%.17g,%.17g,%u,%u\n",
                  mu,
                  forged.energy.total(),
                  design.pull_back(value, result.X_0, result.process)[0],
                  mesh.n_nodes(),
                  forged.increments);
      std::fflush(stdout);
    }

    Parameters           parameters;
    Timings              timings;
    TetMesh              mesh;
    Process<double>      nominal;
    ForgingModel         model;
    Design               design;
    std::shared_ptr<Leg> leg;
    Remesher             remesher;
    Forging              forging;
  };
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  if (argc < 5)
  {
    std::cerr << "usage: roughness_scan CASE.prm FROM TO POINTS [Section/name=value]...\n";
    return 2;
  }
  try
  {
    const double                                     from = std::stod(argv[2]), to = std::stod(argv[3]);
    const unsigned int                               n = std::stoul(argv[4]);
    std::vector<std::pair<std::string, std::string>> overrides;
    for (int i = 5; i < argc; ++i)
    {
      const std::string word(argv[i]);
      overrides.emplace_back(word.substr(0, word.find('=')), word.substr(word.find('=') + 1));
    }
    std::string echo;
    Scan        scan(Parameters::read(argv[1], overrides, echo));
    std::printf("mu,energy,gradient,nodes,increments\n");
    for (unsigned int i = 0; i < n; ++i)
      scan.print_line(n == 1 ? from : from + (to - from) * i / (n - 1));
  }
  catch (const std::exception &error)
  {
    std::cerr << error.what() << std::endl;
    return 1;
  }
  return 0;
}
