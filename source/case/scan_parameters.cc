// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/case/scan_parameters.h>
#include <retroforge/core/error.h>
#include <retroforge/core/setting_tags.h>

namespace retroforge
{
  void ScanParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    using namespace dealii::Patterns;
    prm.enter_subsection("Scan");
    prm.add_parameter(
      "parameter",
      parameter,
      "The design parameter that `scan' varies, any that the scene offers; empty for those of "
      "Design/parameters, one after the other. Units: none.");
    prm.add_parameter(
      "range",
      range,
      "Half of the range, relative to the nominal value; where that is 0, to the size that "
      "steps of this parameter are relative to (for offsets, the billet's width). Units: none.",
      Double(1e-12));
    prm.add_parameter("points",
                      points,
                      "Designs per parameter, equally spaced over the range. Units: none.",
                      Integer(2, 9999));
    prm.add_parameter("fit degree",
                      degree,
                      "Of the polynomial that is fitted to the objectives and stands for what is smooth in "
                      "them. Units: none.",
                      Integer(1, 20));
    prm.add_parameter(
      "gradients",
      gradients,
      "Differentiate each point too, to compare local slopes with that of the fit. Units: none.");
    prm.add_parameter(
      "processes", processes, "Runs at a time; 0 for one per core. Units: none.", Integer(0, 4096));
    prm.leave_subsection();
    tag(prm, "Scan", SettingRole::report);
  }

  void ScanParameters::check() const
  {
    if (points < degree + 2)
      throw Error("Scan/points",
                  "is " + std::to_string(points) + " with a fit of degree " + std::to_string(degree),
                  "a fit says something only about more points than it has coefficients",
                  "use at least " + std::to_string(degree + 2) + " points, or a lower degree");
  }

  std::vector<double> ScanParameters::values(const double nominal, const double scale) const
  {
    const double        half = range * std::abs(nominal != 0. ? nominal : scale);
    std::vector<double> values;
    for (unsigned int i = 0; i < points; ++i)
      values.push_back(nominal + half * (2. * i - (points - 1.)) / (points - 1.));
    return values;
  }
} // namespace retroforge
