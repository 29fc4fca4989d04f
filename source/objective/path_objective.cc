// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/objective/path_objective.h>

namespace retroforge
{
  PathRow<double> values_of(const PathRow<Dual> &row)
  {
    PathRow<double> values{{},
                           row.dt.val(),
                           row.time.val(),
                           row.stroke.val(),
                           row.step.val(),
                           row.place,
                           row.length,
                           row.operation};
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
            Dual(row.stroke),
            Dual(row.step),
            row.place,
            row.length,
            row.operation};
  }
} // namespace retroforge
