// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
// Proves: damaged files of an earlier run's history and time series are refused with an Error, or read as
// rows and steps that the run may go on from.
#include "mutate.h"

#include <retroforge/output/history.h>
#include <retroforge/output/pvd_writer.h>

#include <filesystem>

using namespace retroforge;

std::string whole_history()
{
  {
    History history("history.csv");
    for (unsigned int i = 1; i < 6; ++i)
      history.add({i, 0.1 * i, 0.2 * i, 1e4 / i, 3e5 * i, 1000., i == 4 ? NAN : 0.3, i, 10 * i});
  }
  return fuzz::bytes_of("history.csv");
}

std::string whole_series()
{
  PvdWriter series("fields.pvd");
  for (unsigned int i = 1; i < 6; ++i)
    series.add(0.1 * i, "fields_" + std::to_string(i) + ".vtu");
  return fuzz::bytes_of("fields.pvd");
}

int main()
{
  const std::string history = whole_history(), series = whole_series();
  fuzz::run("history", "history.csv", [&](fuzz::Random &random) {
    fuzz::write_bytes("history.csv", fuzz::mutate(history, random));
    const auto rows = History::read("history.csv");
    History::continue_after("history.csv", 3);
    const auto kept = History::read("history.csv");
    fuzz::require(kept.size() <= rows.size(), "going on makes rows");
    for (const HistoryRow &row : kept)
      fuzz::require(row.increment <= 3, "a row is kept of an increment that is to come");
    for (std::size_t i = 1; i < rows.size(); ++i)
      fuzz::require(rows[i - 1].increment < rows[i].increment, "increments do not ascend");
  });
  fuzz::run("time series", "fields.pvd", [&](fuzz::Random &random) {
    fuzz::write_bytes("fields.pvd", fuzz::mutate(series, random));
    PvdWriter goes_on = PvdWriter::continue_after("fields.pvd", 0.35);
    goes_on.add(0.4, "fields_4.vtu");
    PvdWriter::continue_after("fields.pvd", 1.); // what was written can be read
  });
}
