// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/nearest_name.h>
#include <retroforge/core/number_checks.h>
#include <retroforge/core/text.h>

#include <cmath>

namespace retroforge
{
  void check_numbers(const std::vector<double>     &numbers,
                     const std::vector<NumberInfo> &info,
                     const std::string             &where,
                     const std::string             &owner)
  {
    std::vector<std::string> names;
    for (const NumberInfo &number : info)
      names.push_back(number.name + (number.unit.empty() ? "" : " [" + number.unit + "]"));
    if (info.size() != numbers.size())
      throw Error(where,
                  "there are " + std::to_string(numbers.size()) + " numbers",
                  names.empty() ? owner + " has none" : owner + " has these: " + join(names),
                  names.empty() ? "leave it empty" : "write one value for each, separated by commas");
    for (std::size_t i = 0; i < info.size(); ++i)
      if (const double x = numbers[i];
          !(x > 0. || (x == 0. && info[i].may_vanish) || info[i].any_sign) || x > info[i].largest)
        throw Error(where,
                    info[i].name + " = " + as_text(x),
                    info[i].name + (info[i].may_vanish ? " is not negative" : " is positive") +
                      (std::isfinite(info[i].largest) ? ", at most " + as_text(info[i].largest) : ""),
                    "give it such a value");
  }
} // namespace retroforge
