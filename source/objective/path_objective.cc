// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/mpi.h>

#include <retroforge/objective/path_objective.h>

namespace retroforge
{
  std::vector<double> sum_over_ranks(std::vector<double> parts, MPI_Comm comm)
  {
    dealii::Utilities::MPI::sum(parts, comm, parts);
    return parts;
  }

  std::vector<Dual> sum_over_ranks(std::vector<Dual> parts, MPI_Comm comm)
  {
    std::vector<double> numbers;
    for (const Dual &part : parts)
      numbers.insert(numbers.end(), {part.val(), part.dx(0)});
    numbers = sum_over_ranks(std::move(numbers), comm);
    for (std::size_t j = 0; j < parts.size(); ++j)
    {
      parts[j]                 = Dual(numbers[2 * j]);
      parts[j].fastAccessDx(0) = numbers[2 * j + 1];
    }
    return parts;
  }

  PathRow<double> values_of(const PathRow<Dual> &row)
  {
    PathRow<double> values{{}, row.dt.val(), row.time.val(), row.stroke, row.step};
    for (const Dual &integral : row.integrals)
      values.integrals.push_back(integral.val());
    return values;
  }

  PathRows<double> values_of(const PathRows<Dual> &rows)
  {
    PathRows<double> values;
    for (const PathRow<Dual> &row : rows)
      values.push_back(values_of(row));
    return values;
  }

  PathRow<Dual> constant(const PathRow<double> &row)
  {
    return {std::vector<Dual>(row.integrals.begin(), row.integrals.end()),
            Dual(row.dt),
            Dual(row.time),
            row.stroke,
            row.step};
  }
} // namespace retroforge
