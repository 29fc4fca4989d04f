// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/app/program.h>
#include <retroforge/scan/scan.h>

#include <cstdlib>
#include <utility>

namespace
{
  /// Where no launcher started the program, Open MPI need not look for networks, nor start a daemon in case the program
  /// starts others by MPI: half a second of each command. What the user has set stays.
  void start_alone()
  {
    for (const char *of_launchers : {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"})
      if (std::getenv(of_launchers))
        return;
    for (const auto &[name, value] :
         {std::make_pair("OMPI_MCA_ess_singleton_isolated", "1"),
          // A folder in /tmp that all such programs would share, which one may remove where another makes it.
          std::make_pair("OMPI_MCA_orte_create_session_dirs", "0"),
          std::make_pair("OMPI_MCA_pml", "ob1"),
          std::make_pair("OMPI_MCA_btl", "self")})
      setenv(name, value, 0);
  }
} // namespace

int main(int argc, char **argv)
{
  const auto environment = retroforge::environment_now(); // MPI adds to it

  // Of the command line, MPI and what deal.II starts with it are given only the name of the program: they
  // would take our options for theirs, and PETSc complains of those it does not know.
  char  *program[]   = {argv[0], nullptr};
  char **arguments   = program;
  int    n_arguments = 1;

  start_alone();
  dealii::Utilities::MPI::MPI_InitFinalize mpi(n_arguments, arguments, 1);
  return retroforge::run_program(argc, argv, environment);
}
