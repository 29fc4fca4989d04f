// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Increments given by a table: read from a history, from a list of a user's, however his program ends its lines,
// and stretched to another stroke; the strokes of a run tell its steps to the bit; what is no such table is
// refused, with the line.

#include <retroforge/core/error.h>
#include <retroforge/output/safe_file.h>
#include <retroforge/time/given_steps.h>

#include <cmath>
#include <cstdio>
#include <iostream>

using namespace retroforge;

namespace
{
  const std::string file = "steps_of_the_test.csv";

  void read(const std::string &what, const std::string &text, const double stroke)
  {
    write_file(file, text);
    try
    {
      const GivenSteps steps = read_steps(file, stroke);
      std::cout << what << ':';
      for (const double end : steps.ends)
        std::cout << ' ' << end;
      std::cout << ", stretched by " << steps.stretch << '\n';
    }
    catch (const Error &error)
    {
      const std::string message = error.what();
      std::cout << what << ": " << message.substr(0, message.find(';')) << '\n';
    }
    std::remove(file.c_str());
  }

  /// Steps as a run chooses them: halves of a whole one that is no binary fraction, longer again where a whole
  /// number of them fits.
  void same_bits()
  {
    const double        whole = 9.7 / 13.;
    std::vector<double> ends, steps;
    double              stroke   = 0.;
    const unsigned int  depths[] = {3, 3, 2, 2, 2, 0, 0, 1, 2, 2, 4, 4, 4, 5, 7, 7, 6};
    for (const unsigned int depth : depths)
    {
      steps.push_back(told_by_strokes(stroke, std::ldexp(whole, -int(depth))));
      stroke += steps.back();
      ends.push_back(stroke);
    }
    write_file(file, table_of_steps(ends));
    const GivenSteps again = read_steps(file, stroke);
    std::remove(file.c_str());
    bool same = again.ends == ends && again.stretch == 1.;
    stroke    = 0.;
    for (std::size_t i = 0; i < steps.size(); ++i)
    {
      const double step = told_by_strokes(stroke, again.ends[i] - stroke);
      same              = same && step == steps[i];
      stroke += step;
    }
    std::cout << "strokes tell steps to the bit: " << (same ? "yes" : "NO") << '\n';
  }
} // namespace

int main()
{
  same_bits();
  read("history", "increment,time,stroke,force\n1,0.1,0.5,7\n2,0.2,1.5,8\n3,0.3,2,9\n", 2.);
  read("to another stroke", "stroke\n0.5\n1.5\n2\n", 4.);
  read("of another program", "\xef\xbb\xbf\"stroke\"\r\n0.5\r\n\r\n2", 2.);

  read("no table", "", 2.);
  read("no column", "increment,time\n1,0.1\n", 2.);
  read("without names", "0.5\n1.5\n", 2.);
  read("no rows", "stroke\n\n", 2.);
  read("no number", "stroke\n0.5\nfar\n", 2.);
  read("a number and more", "stroke\n0.5 mm\n", 2.);
  read("not finite", "stroke\n0.5\nnan\n", 2.);
  read("a short row", "time,stroke\n0.1,0.5\n0.2\n", 2.);
  read("back", "stroke\n0.5\n1.5\n1.5\n", 2.);
  read("from nothing", "stroke\n0\n1.5\n", 2.);
  read("a tiny step", "stroke\n1\n1.0000001\n2\n", 2.);
}
