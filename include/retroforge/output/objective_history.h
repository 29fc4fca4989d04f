// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace retroforge
{
  /// A column's title and its number.
  using NamedValue = std::pair<std::string, double>;

  /// The objectives of the run so far over the stroke, as a table (.csv): columns `stroke [mm]` and those of
  /// the first row. Each row is on the disk when add() returns.
  class ObjectiveHistory
  {
  public:
    /// @throws Error  if the file cannot be written
    explicit ObjectiveHistory(const std::string &file);

    /// Writes a row. What is not known yet, which is NaN or is not among the columns, is left empty.
    /// @throws Error  if the row cannot be written
    void add(double stroke, const std::vector<NamedValue> &columns);

  private:
    struct Close
    {
      void operator()(std::FILE *stream) const { std::fclose(stream); }
    };

    std::string                       file_;
    std::unique_ptr<std::FILE, Close> stream_;
    std::vector<std::string>          titles_; ///< of the first row's columns

    void write(const std::string &text);
  };
} // namespace retroforge
