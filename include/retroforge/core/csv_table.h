// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace retroforge
{
  /// A table of comma-separated values whose first row has the names of its columns, as text.
  struct CsvTable
  {
    using Row = std::pair<std::size_t, std::vector<std::string>>; ///< line of the file, cells

    std::string              file;
    std::vector<std::string> names;
    std::vector<Row>         rows; ///< those that are not blank

    /// Returns `FILE, line N`, as messages begin.
    std::string where(std::size_t line) const;
    /// Returns the column with a name, if there is one.
    std::optional<std::size_t> column(const std::string &name) const;
  };

  /// Reads a table. @param meaning  what it is for: "the file of Press/steps"
  /// @throws Error  where the file cannot be read
  CsvTable read_csv(const std::string &file, const std::string &meaning);

  /// Returns the cell of a row, empty where the row ends before.
  inline std::string cell(const CsvTable::Row &row, const std::size_t column)
  {
    return column < row.second.size() ? row.second[column] : "";
  }

  /// Returns the finite number that a cell is, if it is one.
  std::optional<double> number_in(const std::string &cell);
} // namespace retroforge
