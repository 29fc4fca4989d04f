// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/app/program.h>
#include <retroforge/case/scene_view.h>
#include <retroforge/core/exception_message.h>
#include <retroforge/core/version.h>
#include <retroforge/optimization/optimize.h>
#include <retroforge/run/simulation.h>
#include <retroforge/scan/scan.h>
#include <retroforge/verification/derivative_check.h>

#include <deal.II/base/mpi.h>

#include <chrono>
#include <iostream>
#include <set>
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

    int run_command(const CommandLine &command, const std::vector<std::string> &environment)
    {
      if (command.command == Command::scan)
        return Scan(command, environment, MPI_COMM_WORLD).run();
      if (command.command == Command::optimize)
        return Optimize(command, MPI_COMM_WORLD).run();
      if (command.command == Command::scene)
        return SceneView(command, MPI_COMM_WORLD).run();
      if (command.command == Command::check)
        return DerivativeCheck(command, MPI_COMM_WORLD).run();
      return Simulation(command, MPI_COMM_WORLD).run();
    }

    /// Where ranks that have met an error wait for each other. It has a communicator of its own, since those
    /// without an error may be in the middle of anything on the others.
    class LastMeeting
    {
    public:
      LastMeeting() { MPI_Comm_dup(MPI_COMM_WORLD, &comm_); }
      ~LastMeeting() { MPI_Comm_free(&comm_); }
      LastMeeting(const LastMeeting &)            = delete;
      LastMeeting &operator=(const LastMeeting &) = delete;

      /// Tells the problem, or those of all ranks, each once. Where only some ranks met one, the others would
      /// wait for them for ever, and are ended.  @return the exit status
      int end_with(const std::string &problem) const
      {
        const bool is_first = dealii::Utilities::MPI::this_mpi_process(comm_) == 0;
        if (is_first)
          tell(problem);
        // What all ranks find, they do not find at quite the same time.
        constexpr double patience = 5.;
        if (!all_come(is_first ? 2. * patience : patience))
        {
          if (!is_first)
            tell(problem);
          MPI_Abort(MPI_COMM_WORLD, 1);
        }
        std::set<std::string> told = {problem};
        for (const std::string &other : dealii::Utilities::MPI::gather(comm_, problem))
          if (told.insert(other).second)
            tell(other);
        return 1;
      }

    private:
      MPI_Comm comm_ = MPI_COMM_NULL;

      static void tell(const std::string &problem) { std::cerr << "retroforge: " << problem << std::endl; }

      bool all_come(const double seconds) const
      {
        using Clock           = std::chrono::steady_clock;
        const auto  end       = Clock::now() + std::chrono::duration<double>(seconds);
        int         are_there = 0;
        MPI_Request request;
        MPI_Ibarrier(comm_, &request);
        for (;;)
        {
          MPI_Test(&request, &are_there, MPI_STATUS_IGNORE);
          if (are_there != 0 || Clock::now() > end)
            return are_there != 0;
          std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
      }
    };
  } // namespace

  int run_program(const int argc, char *argv[], const std::vector<std::string> &environment)
  {
    const LastMeeting meeting;
    try
    {
      const auto command = CommandLine::parse(argc, argv);
      if (command.help || command.version || command.print_parameters)
        return dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0 ? answer(command) : 0;
      return run_command(command, environment);
    }
    catch (...)
    {
      return meeting.end_with(message_of(std::current_exception()));
    }
  }
} // namespace retroforge
