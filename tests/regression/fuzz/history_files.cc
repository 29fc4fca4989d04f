// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
// Proves: a damaged history is refused with an Error, or read as rows of ascending increments.
#include "mutate.h"

#include <retroforge/output/history.h>

#include <cmath>

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

int main()
{
  const std::string history = whole_history();
  fuzz::run("history", "history.csv", [&](fuzz::Random &random) {
    fuzz::write_bytes("history.csv", fuzz::mutate(history, random));
    const auto rows = History::read("history.csv");
    for (std::size_t i = 1; i < rows.size(); ++i)
      fuzz::require(rows[i - 1].increment < rows[i].increment, "increments do not ascend");
  });
}
