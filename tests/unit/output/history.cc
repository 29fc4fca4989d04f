// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
// Proves: each row of the history is in the file when add() returns and reads back to the same bits, numbers
// that are not finite included; a row cut short by a kill is passed over. Of the objectives, what is unknown
// is left empty under its title.
#include <retroforge/core/error.h>
#include <retroforge/output/history.h>
#include <retroforge/output/objective_history.h>
#include <retroforge/output/safe_file.h>

#include <cmath>
#include <iostream>
#include <limits>

using namespace retroforge;

bool equal(const HistoryRow &a, const HistoryRow &b)
{
  return a.increment == b.increment && a.time == b.time && a.stroke == b.stroke && a.force == b.force &&
         a.energy == b.energy && a.volume == b.volume && a.min_quality == b.min_quality &&
         a.depth == b.depth && a.newton == b.newton && a.krylov == b.krylov &&
         a.whole_force == b.whole_force && a.whole_energy == b.whole_energy &&
         a.whole_volume == b.whole_volume && a.balance == b.balance;
}

int main()
{
  const HistoryRow first{
    1, 0.1, 1. / 3., 1e6 / 7., 2.5, 1000., 0.3, 0.0125, 7, 120, 4e6 / 7., 10., 4000., 0.01 / 3.};
  const HistoryRow second{2,
                          0.2,
                          2. / 3.,
                          1e-300,
                          -0.,
                          std::numeric_limits<double>::max(),
                          0.1 + 0.2,
                          1. / 7.,
                          3,
                          4000000000u,
                          1. / 11.,
                          -1e-300,
                          0.,
                          -1. / 70.};
  {
    History history("history.csv");
    std::cout << read_file("history.csv");
    history.add(first);
    std::cout << "rows before the file is closed: " << History::read("history.csv").size() << '\n';
    history.add(second);
    history.add({3, std::nan(""), std::numeric_limits<double>::infinity(), 0, 0, 0, 0, 0, 0});
  }
  const auto rows = History::read("history.csv");
  std::cout << "same bits: " << equal(rows.at(0), first) << equal(rows.at(1), second)
            << ", not finite: " << std::isnan(rows.at(2).time) << std::isinf(rows.at(2).stroke) << '\n';

  write_file("history.csv", read_file("history.csv") + "4,0.4,1");
  for (const HistoryRow &row : History::read("history.csv"))
    std::cout << row.increment << ' ' << row.stroke << ' ' << row.krylov << '\n';

  for (const std::string &contents : {std::string("a,b\n1,2\n"), read_file("history.csv") + "4,x,1\n"})
    try
    {
      write_file("broken.csv", contents);
      History::read("broken.csv");
    }
    catch (const Error &error)
    {
      std::cout << error.what() << '\n';
    }

  {
    ObjectiveHistory objectives("objectives.csv");
    objectives.add(1., {{"energy", 2.}, {"filling", std::nan("")}, {"filling: part", 3.}, {"volume", 4.}});
    objectives.add(2., {{"energy", 5.}, {"filling", std::nan("")}, {"volume", 6.}});
  }
  std::cout << read_file("objectives.csv");
}
