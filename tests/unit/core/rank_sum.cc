// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Sums over ranks, on 1 and 3 of them: of a number, dual numbers and an aggregate whose numbers are each
// rank's own; what all ranks know is added once; a part stays as it is when the sum is complete.

#include <retroforge/core/rank_sum.h>

#include <iostream>

using namespace retroforge;

namespace
{
  struct Aggregate
  {
    double               number;
    NodalVectors<double> vectors;
    unsigned int         decision;

    template <typename Self>
    static auto members(Self &self)
    {
      auto &[number, vectors, decision] = self;
      return std::tie(number, vectors, decision);
    }
  };

  const char *yes(const bool holds)
  {
    return holds ? "yes" : "no";
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const MPI_Comm                           comm = MPI_COMM_WORLD;
  const unsigned int                       n    = dealii::Utilities::MPI::n_mpi_processes(comm);
  const double rank = dealii::Utilities::MPI::this_mpi_process(comm), all = n * (n - 1) / 2.;

  RankSum<double> number(1. + rank, comm);
  const bool      summed = number.complete() == n + all, kept = number.part() == 1. + rank;
  number.add_once([](double &part) { part += 0.5; });
  const bool once = number.complete() == n + all + 0.5;

  RankSum<std::vector<Dual>> duals({Dual(1, 0, rank), Dual(2.)}, comm);
  duals.part()[0].fastAccessDx(0) = 10. + rank;
  const auto dual_sum             = duals.complete();
  const bool dual                 = dual_sum[0].val() == all && dual_sum[0].dx(0) == 10. * n + all &&
                    dual_sum[1].val() == 2. * n && dual_sum[1].dx(0) == 0.;

  RankSum<Aggregate> aggregate({rank, {Vec3({1., 2., rank})}, 7}, comm);
  const Aggregate    sum = aggregate.complete();
  const bool         together =
    sum.number == all && sum.vectors[0] == Vec3({1. * n, 2. * n, all}) && sum.decision == 7;

  const bool right =
    dealii::Utilities::MPI::min(summed && kept && once && dual && together ? 1 : 0, comm) == 1;
  if (rank == 0.)
    std::cout << "a number: " << yes(summed) << ", its part stays: " << yes(kept)
              << "\nwhat all know, once: " << yes(once) << "\ndual numbers: " << yes(dual)
              << "\nan aggregate, whose decisions are no numbers: " << yes(together)
              << "\nthe same on every rank: " << yes(right) << "\n";
}
