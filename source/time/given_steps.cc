// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/csv_table.h>
#include <retroforge/core/error.h>
#include <retroforge/time/given_steps.h>

#include <cmath>
#include <sstream>

namespace retroforge
{
  namespace
  {
    constexpr double      shortest = 1e-6; ///< step, over the last stroke
    constexpr std::size_t most     = 1000000;

    [[noreturn]] void throw_no_steps(const std::string &where, const std::string &what)
    {
      throw Error(
        where,
        what,
        "Press/steps names a table with commas between its cells, a first row of names, one of them "
        "`stroke', and in that column the strokes at which increments end, ascending, in mm",
        "name history.csv in the results of a run, or write a file with `stroke' and one number per "
        "line");
    }

    /// The stroke in a row. @param last  that of the row before
    double stroke_in(const std::string &text, const double last, const std::string &where)
    {
      const auto stroke = number_in(text);
      if (!stroke)
        throw_no_steps(where, text.empty() ? "has no stroke" : "has '" + legible(text) + "' for a stroke");
      if (!(*stroke > last))
        throw_no_steps(
          where,
          "has the stroke " + as_text(*stroke) +
            (last > 0. ? " after " + as_text(last) : std::string(", and the first increment ends after 0")));
      return *stroke;
    }
  } // namespace

  GivenSteps read_steps(const std::string &file, const double stroke)
  {
    const CsvTable table  = read_csv(file, "the file of Press/steps");
    const auto     column = table.column("stroke");
    if (!column)
      throw_no_steps(table.where(1), "names no column `stroke'");
    GivenSteps steps;
    for (const CsvTable::Row &row : table.rows)
    {
      const std::string where = table.where(row.first);
      steps.ends.push_back(stroke_in(cell(row, *column), steps.ends.empty() ? 0. : steps.ends.back(), where));
      if (steps.ends.size() > most)
        throw_no_steps(where, "has more than " + std::to_string(most) + " increments before it");
    }
    if (steps.empty())
      throw_no_steps(file, "has no increments");
    for (std::size_t i = 0; i < steps.ends.size(); ++i)
      if (const double step = steps.ends[i] - (i == 0 ? 0. : steps.ends[i - 1]);
          step < shortest * steps.ends.back())
        throw_no_steps(table.where(table.rows[i].first),
                       "has a step of " + as_text(step) + " mm, less than a millionth of the stroke");
    constexpr double rounding = 1e-12;
    if (std::abs(steps.ends.back() / stroke - 1.) > rounding)
    {
      steps.stretch = stroke / steps.ends.back();
      for (double &end : steps.ends)
        end *= steps.stretch;
    }
    return steps;
  }

  std::string table_of_steps(const std::vector<double> &ends)
  {
    std::ostringstream text;
    text.precision(17);
    text << "stroke\n";
    for (const double end : ends)
      text << end << '\n';
    return text.str();
  }
} // namespace retroforge
