// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/app/program.h>
#include <retroforge/scan/scan.h>

int main(int argc, char **argv)
{
  const auto environment = retroforge::environment_now(); // MPI adds to it

  // Of the command line, MPI and what deal.II starts with it are given only the name of the program: they
  // would take our options for theirs, and PETSc complains of those it does not know.
  char  *program[]   = {argv[0], nullptr};
  char **arguments   = program;
  int    n_arguments = 1;

  dealii::Utilities::MPI::MPI_InitFinalize mpi(n_arguments, arguments, 1);
  return retroforge::run_program(argc, argv, environment);
}
