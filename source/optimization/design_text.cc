// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/optimization/design_text.h>

#include <cstdio>

namespace retroforge
{
  std::string exact(const double x)
  {
    char text[32];
    std::snprintf(text, sizeof text, "%.17g", x);
    return text;
  }

  std::string after_number(const std::string &unit)
  {
    return unit.empty() || unit == "none" ? "" : " " + unit;
  }

  std::string values_by_name(const std::vector<DesignParameter> &parameters, const std::vector<double> &mu)
  {
    std::string text;
    for (std::size_t j = 0; j < mu.size(); ++j)
      text += (j == 0 ? "" : ", ") + parameters[j].name + ": " + exact(mu[j]);
    return text;
  }

  std::string as_parameters(const std::string &design, const std::string &made_at)
  {
    return "# What the case is to include for this design.\nsubsection Design\n  set at = " + design + "\n" +
           (made_at.empty() ? "" : "  set meshed at = " + made_at + "\n") + "end\n";
  }
} // namespace retroforge
