// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include "directions.h"

#include <algorithm>
#include <functional>
#include <iostream>
#include <map>

namespace retroforge
{
  /// A direction, and numbers of the process.
  struct Way
  {
    Direction                              direction;
    std::function<void(Process<double> &)> dots =
      {}; ///< sets what the numbers move by, in a process of zeros

    Process<double> process_dot(const RecordedRun &run) const
    {
      Process<double> dot = run.process();
      for_each_number([](double &x) { x = 0.; }, dot);
      if (dots)
        dots(dot);
      return dot;
    }
  };

  template <typename Number>
  std::pair<Process<Number>, NodalVectors<Number>> at(const RecordedRun &run, const Way &way, const double t)
  {
    auto       there = along<Number>(run, way.direction, t);
    const auto dot   = way.process_dot(run);
    for_each_number(
      [t](Number &x, const double d) {
        if (d != 0.)
          x = number<Number>(value_of(x) + t * d, d);
      },
      there.first,
      dot);
    return there;
  }

  inline double slope(const RecordedRun &run, const AdjointResult &bar, const Way &way)
  {
    double     sum = slope(run, bar, way.direction);
    const auto dot = way.process_dot(run);
    for_each_number([&](const double x, const double x_bar) { sum += x * x_bar; }, dot, bar.process);
    return sum;
  }

  /// Values of the objectives at places along a way, replayed; each is computed once.
  class ValuesAlong
  {
  public:
    ValuesAlong(const RecordedRun &run, const Way &way) : run_(run), way_(way) {}

    double operator()(const std::size_t objective, const double t)
    {
      auto known = known_.find(t);
      if (known == known_.end())
      {
        const auto [process, X] = at<double>(run_, way_, t);
        known                   = known_.emplace(t, run_.replayed_values(process, X)).first;
      }
      return known->second[objective];
    }

  private:
    const RecordedRun                    &run_;
    const Way                            &way_;
    std::map<double, std::vector<double>> known_;
  };

  /// By how much the adjoint of an objective is off the direct method and replayed central differences, relative, and
  /// by how much the order of the remainder of Taylor's expansion falls short of 2 (where its second derivative is
  /// small it falls faster).
  struct SlopeErrors
  {
    double tangent = 0., difference = 0., order = 0.;
  };

  /// The largest of some, and where they were found.
  class WorstErrors
  {
  public:
    void take(const SlopeErrors &errors, const std::string &where)
    {
      take_larger(errors.tangent, where, tangent_);
      take_larger(errors.difference, where, difference_);
      take_larger(errors.order, where, order_);
    }

    /// Prints the verdict, and what is not as it should be.
    void print(const std::string &heading) const
    {
      const bool agrees = tangent_.first < 1e-10, differs = difference_.first < 1e-6,
                 quadratic = order_.first < 0.1;
      std::cout << heading << "direct method within 1e-10: " << yes(agrees)
                << ", differences within 1e-6: " << yes(differs)
                << ", remainder of second order: " << yes(quadratic) << "\n";
      for (const auto &[fails, of] : {std::make_pair(!agrees, &tangent_),
                                      std::make_pair(!differs, &difference_),
                                      std::make_pair(!quadratic, &order_)})
        if (fails)
          std::cout << "  " << of->first << ", " << of->second << "\n";
    }

    double difference() const { return difference_.first; }

  private:
    using Worst = std::pair<double, std::string>;

    static void take_larger(const double value, const std::string &where, Worst &worst)
    {
      if (!(value <= worst.first)) // so that a NaN counts as larger
        worst = {value, where};
    }

    Worst tangent_ = {0., ""}, difference_ = {0., ""}, order_ = {0., ""};
  };

  /// Those of each objective along a way.
  /// @param bars   of each objective
  /// @param floor   a slope that is less than this part of the value is rounding beside it, and measured by that
  /// @param tested  part of the value from which on a slope is tested for the order of the remainder
  inline std::vector<SlopeErrors> slope_errors(const RecordedRun                &run,
                                               const Way                        &way,
                                               const std::vector<AdjointResult> &bars,
                                               const double                      floor,
                                               const double                      tested)
  {
    const auto [process, X]           = at<Dual>(run, way, 0.);
    const auto               tangents = run.tangent(process, X);
    ValuesAlong              value(run, way);
    std::vector<SlopeErrors> errors;
    for (std::size_t o = 0; o < bars.size(); ++o)
    {
      const double adjoint = slope(run, bars[o], way);
      const double scale   = std::max(std::abs(adjoint), floor * std::abs(value(o, 0.)));
      double       best = 1e300, least = 2.;
      for (const double h : {1e-4, 1e-5, 1e-6})
        best = std::min(best, std::abs((value(o, h) - value(o, -h)) / (2. * h) - adjoint) / scale);
      const auto remainder = [&](const double t) {
        return std::abs(value(o, t) - value(o, 0.) - t * adjoint);
      };
      // Between steps over which the remainder is not of second order yet and those that leave rounding of it.
      for (const double h : {1e-2, 3e-3, 1e-3, 1e-4})
        if (const double missing = 2. - std::log2(remainder(h) / remainder(0.5 * h)); missing < least)
          least = std::max(0., missing);
      errors.push_back({std::abs(tangents[o].dx(0) - adjoint) / scale,
                        best,
                        std::abs(adjoint) >= tested * std::abs(value(o, 0.)) ? least : 0.});
    }
    return errors;
  }

  inline std::vector<SlopeErrors> slope_errors(const RecordedRun                &run,
                                               const Way                        &way,
                                               const std::vector<AdjointResult> &bars,
                                               const double                      floor = 0.)
  {
    return slope_errors(run, way, bars, floor, floor);
  }
} // namespace retroforge
