// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/exception_message.h>
#include <retroforge/core/version.h>
#include <retroforge/optimize.h>
#include <retroforge/program.h>
#include <retroforge/scan.h>
#include <retroforge/scene_view.h>
#include <retroforge/simulation.h>

#include <chrono>
#include <iostream>
#include <thread>

namespace retroforge
{
  namespace
  {
    int answer(const CommandLine &command)
    {
      if (command.help)
        std::cout << help_text();
      else if (command.version)
        std::cout << "Retroforge " << version << ' ' << commit << '\n';
      else
        Parameters::print_template(std::cout);
      return 0;
    }
  } // namespace

  int run_program(const int argc, char *argv[], const std::vector<std::string> &environment)
  {
    try
    {
      const auto command = CommandLine::parse(argc, argv);
      if (command.help || command.version || command.print_parameters)
        return dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0 ? answer(command) : 0;
      if (command.command == "scan")
        return Scan(command, environment, MPI_COMM_WORLD).run();
      if (command.command == "optimize")
        return Optimize(command, MPI_COMM_WORLD).run();
      if (command.command == "scene")
        return SceneView(command, MPI_COMM_WORLD).run();
      return Simulation(command, MPI_COMM_WORLD).run();
    }
    catch (...)
    {
      const std::string problem = message_of(std::current_exception());
      // An error of all ranks is told once: the first speaks at once and ends the others. One that only
      // another rank met is told by that rank, a moment later.
      const bool alone = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) == 1;
      if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) > 0)
        std::this_thread::sleep_for(std::chrono::seconds(2));
      std::cerr << "retroforge: " << problem << std::endl;
      if (!alone)
        MPI_Abort(MPI_COMM_WORLD, 1);
      return 1;
    }
  }
} // namespace retroforge
