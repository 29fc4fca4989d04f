// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/input_file.h>
#include <retroforge/time/given_steps.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

namespace retroforge
{
  namespace
  {
    constexpr double      shortest = 1e-6; ///< step, over the last stroke
    constexpr std::size_t most     = 1000000;

    std::vector<std::string> cells_of(const std::string &line)
    {
      std::vector<std::string> cells;
      std::istringstream       in(line);
      for (std::string cell; std::getline(in, cell, ',');)
      {
        const auto first = cell.find_first_not_of(" \t\r\"");
        cells.push_back(
          first == std::string::npos ? "" : cell.substr(first, cell.find_last_not_of(" \t\r\"") + 1 - first));
      }
      return cells;
    }

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
    double stroke_in(const std::vector<std::string> &cells,
                     const std::size_t               column,
                     const double                    last,
                     const std::string              &where)
    {
      const std::string text   = column < cells.size() ? cells[column] : "";
      char             *end    = nullptr;
      const double      stroke = std::strtod(text.c_str(), &end);
      if (text.empty() || *end != '\0' || !std::isfinite(stroke))
        throw_no_steps(where, text.empty() ? "has no stroke" : "has '" + legible(text) + "' for a stroke");
      if (!(stroke > last))
        throw_no_steps(
          where,
          "has the stroke " + as_text(stroke) +
            (last > 0. ? " after " + as_text(last) : std::string(", and the first increment ends after 0")));
      return stroke;
    }
  } // namespace

  GivenSteps read_steps(const std::string &file, const double stroke)
  {
    std::istringstream in(as_plain_lines(read_input_file(file, "the file of Press/steps")));
    std::string        line;
    std::getline(in, line);
    const std::vector<std::string> names  = cells_of(line);
    const std::size_t              column = std::find(names.begin(), names.end(), "stroke") - names.begin();
    if (column == names.size())
      throw_no_steps(file + ", line 1", "names no column `stroke'");
    GivenSteps steps;
    const auto where = [&](const std::size_t line_number) {
      return file + ", line " + std::to_string(line_number);
    };
    std::vector<std::size_t> lines;
    for (std::size_t n = 2; std::getline(in, line); ++n)
    {
      if (const auto cells = cells_of(line); !cells.empty() && (cells.size() > 1 || !cells[0].empty()))
      {
        steps.ends.push_back(stroke_in(cells, column, steps.ends.empty() ? 0. : steps.ends.back(), where(n)));
        lines.push_back(n);
      }
      if (steps.ends.size() > most)
        throw_no_steps(where(n), "has more than " + std::to_string(most) + " increments before it");
    }
    if (steps.empty())
      throw_no_steps(file, "has no increments");
    for (std::size_t i = 0; i < steps.ends.size(); ++i)
      if (const double step = steps.ends[i] - (i == 0 ? 0. : steps.ends[i - 1]);
          step < shortest * steps.ends.back())
        throw_no_steps(where(lines[i]),
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
