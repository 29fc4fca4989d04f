// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/output/history.h>
#include <retroforge/output/safe_file.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>

namespace retroforge
{
  namespace
  {
    const std::string header    = "increment,time,stroke,force,energy,volume,min_quality,depth,newton,krylov,"
                                  "whole_force,whole_energy,whole_volume,balance\n";
    constexpr int     n_columns = 14;

    std::string to_csv(const HistoryRow &row)
    {
      std::ostringstream line;
      line.precision(17);
      line << row.increment << ',' << row.time << ',' << row.stroke << ',' << row.force << ',' << row.energy
           << ',' << row.volume << ',' << row.min_quality << ',' << row.depth << ',' << row.newton << ','
           << row.krylov << ',' << row.whole_force << ',' << row.whole_energy << ',' << row.whole_volume
           << ',' << row.balance << '\n';
      return line.str();
    }

    [[noreturn]] void throw_not_a_history(const std::string &file, const unsigned int line)
    {
      throw Error(file + ", line " + std::to_string(line),
                  "is not a row of a history",
                  "the columns are " + header.substr(0, header.size() - 1) + ", increments ascend",
                  "read the table that a run wrote, as it wrote it");
    }

    HistoryRow from_csv(const std::string &line, const std::string &file, const unsigned int line_number)
    {
      std::array<double, n_columns> x;
      const char                   *begin = line.c_str();
      for (int column = 0; column < n_columns; ++column)
      {
        char *end; // strtod, as streams do not read nan
        x[column] = std::strtod(begin, &end);
        if (end == begin || *end != (column + 1 < n_columns ? ',' : '\0'))
          throw_not_a_history(file, line_number);
        begin = end + 1;
      }
      const auto count = [&](const double number) {
        if (!(number >= 0. && number <= std::numeric_limits<unsigned int>::max()) ||
            number != std::floor(number))
          throw_not_a_history(file, line_number);
        return static_cast<unsigned int>(number);
      };
      return {count(x[0]),
              x[1],
              x[2],
              x[3],
              x[4],
              x[5],
              x[6],
              x[7],
              count(x[8]),
              count(x[9]),
              x[10],
              x[11],
              x[12],
              x[13]};
    }
  } // namespace

  History::History(const std::string &file) : file_(file), stream_(std::fopen(file.c_str(), "w"))
  {
    if (!stream_)
      throw_write_error(file_, errno);
    write(header);
  }

  void History::add(const HistoryRow &row)
  {
    write(to_csv(row));
  }

  std::vector<HistoryRow> History::read(const std::string &file)
  {
    const std::string contents = read_file(file);
    if (contents.compare(0, header.size(), header) != 0)
      throw_not_a_history(file, 1);

    std::vector<HistoryRow> rows;
    std::istringstream      in(contents.substr(header.size()));
    unsigned int            line_number = 1;
    for (std::string line; std::getline(in, line);)
    {
      ++line_number;
      if (in.eof()) // no newline: the run was killed while it wrote this row
        break;
      rows.push_back(from_csv(line, file, line_number));
      if (rows.size() > 1 && rows.back().increment <= rows[rows.size() - 2].increment)
        throw_not_a_history(file, line_number);
    }
    return rows;
  }

  void History::write(const std::string &text)
  {
    if (std::fwrite(text.data(), 1, text.size(), stream_.get()) != text.size() ||
        std::fflush(stream_.get()) != 0)
      throw_write_error(file_, errno);
  }
} // namespace retroforge
