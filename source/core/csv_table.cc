// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/csv_table.h>
#include <retroforge/core/input_file.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

namespace retroforge
{
  namespace
  {
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
  } // namespace

  CsvTable read_csv(const std::string &file, const std::string &meaning)
  {
    std::istringstream in(as_plain_lines(read_input_file(file, meaning)));
    std::string        line;
    std::getline(in, line);
    CsvTable table{file, cells_of(line), {}};
    for (std::size_t n = 2; std::getline(in, line); ++n)
      if (auto cells = cells_of(line); !cells.empty() && (cells.size() > 1 || !cells[0].empty()))
        table.rows.emplace_back(n, std::move(cells));
    return table;
  }

  std::string CsvTable::where(const std::size_t line) const
  {
    return file + ", line " + std::to_string(line);
  }

  std::optional<std::size_t> CsvTable::column(const std::string &name) const
  {
    const auto found = std::find(names.begin(), names.end(), name);
    return found == names.end() ? std::optional<std::size_t>() : found - names.begin();
  }

  std::optional<double> number_in(const std::string &cell)
  {
    char        *end = nullptr;
    const double x   = std::strtod(cell.c_str(), &end);
    return cell.empty() || *end != '\0' || !std::isfinite(x) ? std::optional<double>() : x;
  }
} // namespace retroforge
