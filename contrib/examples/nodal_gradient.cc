// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/exception_message.h>
#include <retroforge/run/forward_run.h>

#include <iostream>

using namespace retroforge;

/// Forges the billet of a case, and tells of each objective what it is, its derivatives by Design/parameters,
/// and what a billet changes that is one per cent wider in x and y, found from the derivatives by all nodes:
///   nodal_gradient gradient CASE.prm [--set Section/name=value]... [--at NAME=VALUE]...
int main(int argc, char *argv[])
{
  int    n_words = 1; // MPI and what deal.II starts with it are given the name of the program only
  char  *word[]  = {argv[0], nullptr};
  char **words   = word;
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(n_words, words, 1);
  try
  {
    Timings    timings;
    const Case made(
      CommandLine::parse(argc, argv), timings, MPI_COMM_WORLD); // mesh, dies, process, objectives
    ForwardRun run(made, made.process, made.X_0, ForwardRun::Keep::increments, timings);
    run.check();
    run.forge([](const IncrementEvent &event) { std::cerr << "stroke " << event.state.stroke << " mm\n"; });
    const std::vector<double> values = made.combine(run.values());
    const AdjointSweep        sweep  = run.sweep(made.combinations); // one backward pass for all of them

    std::cout.precision(17);
    for (std::size_t j = 0; j < values.size(); ++j)
    {
      std::cout << made.combinations[j].name << ' ' << values[j] << '\n';
      const NodalVectors<double> &by_nodes = sweep.gradients[j].X_0; // d objective / d initial position of each node
      const std::vector<double> by_parameters = made.design.pull_back(made.mu, by_nodes, sweep.gradients[j].process);
      for (std::size_t i = 0; i < by_parameters.size(); ++i)
        std::cout << "  by " << made.design.parameters()[i].name << ' ' << by_parameters[i] << '\n';
      double wider = 0.;
      for (std::size_t k = 0; k < by_nodes.size(); ++k)
        wider += 0.01 * (by_nodes[k][0] * made.X_0[k][0] + by_nodes[k][1] * made.X_0[k][1]);
      std::cout << "  wider by 1 % " << wider << '\n';
    }
    return 0;
  }
  catch (...)
  {
    std::cerr << "nodal_gradient: " << message_of(std::current_exception()) << '\n';
    return 1;
  }
}
