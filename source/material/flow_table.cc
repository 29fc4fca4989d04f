// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/exceptions.h>

#include <retroforge/core/csv_table.h>
#include <retroforge/core/error.h>
#include <retroforge/core/text.h>
#include <retroforge/material/flow_table.h>
#include <retroforge/material/temperature_range.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace retroforge
{
  namespace
  {
    /// Slopes at the knots of an interpolation that stays between neighbouring values: the harmonic mean of the
    /// slopes beside a knot, weighted by lengths, 0 at an extremum; one-sided at the ends, where a curve goes on
    /// as the line between the last two.
    std::vector<double> monotone_slopes(const std::vector<double> &x, const std::vector<double> &y)
    {
      const std::size_t   n = x.size();
      std::vector<double> slopes(n, 0.);
      if (n == 1)
        return slopes;
      const auto secant = [&](const std::size_t i) { return (y[i + 1] - y[i]) / (x[i + 1] - x[i]); };
      slopes.front()    = secant(0);
      slopes.back()     = secant(n - 2);
      for (std::size_t i = 1; i + 1 < n; ++i)
      {
        const double before = secant(i - 1), after = secant(i);
        if (before * after <= 0.)
          continue;
        const double h = x[i] - x[i - 1], h_next = x[i + 1] - x[i], w = 2. * h_next + h,
                     w_next = h_next + 2. * h;
        slopes[i]           = (w + w_next) / (w / before + w_next / after);
      }
      return slopes;
    }

    /// Hermite's polynomials of two values and two slopes times the length, at t in [0, 1].
    template <typename Number>
    std::array<Number, 4> hermite(const Number &t)
    {
      const Number s = 1. - t;
      return {{(1. + 2. * t) * s * s, t * t * (3. - 2. * t), t * s * s, -t * t * s}};
    }

    /// The interval of x and the place in it; x beyond the knots is at the nearest one.
    template <typename Number>
    struct Place
    {
      std::size_t i      = 0;
      double      length = 0.;
      Number      t      = Number(0.);

      Place(const std::vector<double> &knots, const Number &x)
      {
        if (knots.size() == 1 || value_of(x) <= knots.front())
          return;
        i = std::min<std::size_t>(std::upper_bound(knots.begin(), knots.end(), value_of(x)) - knots.begin(),
                                  knots.size() - 1) -
            1;
        length = knots[i + 1] - knots[i];
        t      = value_of(x) >= knots.back() ? Number(1.) : Number((x - knots[i]) / length);
      }
    };
  } // namespace

  FlowTable::FlowTable(std::vector<double> strain,
                       std::vector<double> temperature,
                       std::vector<double> log_sigma,
                       std::vector<double> m,
                       const double        misfit)
      : strain_(std::move(strain))
      , temperature_(std::move(temperature))
      , log_sigma_(surface(std::move(log_sigma)))
      , m_(surface(std::move(m)))
      , misfit_(misfit)
  {
  }

  FlowTable::Surface FlowTable::surface(std::vector<double> values) const
  {
    const std::size_t n = strain_.size(), n_T = temperature_.size();
    AssertDimension(values.size(), n * n_T);
    Surface made{std::move(values), std::vector<double>(n * n_T), std::vector<double>(n * n_T)};
    for (std::size_t j = 0; j < n_T; ++j)
    {
      std::vector<double> along;
      for (std::size_t i = 0; i < n; ++i)
        along.push_back(made.value[i * n_T + j]);
      const auto slopes = monotone_slopes(strain_, along);
      for (std::size_t i = 0; i < n; ++i)
        made.by_strain[i * n_T + j] = slopes[i];
    }
    for (std::size_t i = 0; i < n; ++i)
    {
      const auto first  = made.value.begin() + i * n_T;
      const auto slopes = monotone_slopes(temperature_, {first, first + n_T});
      std::copy(slopes.begin(), slopes.end(), made.by_temperature.begin() + i * n_T);
    }
    return made;
  }

  template <typename Number>
  Number FlowTable::interpolate(const Surface &of, const Number &strain, const Number &temperature) const
  {
    const Place<Number> q(strain_, strain), T(temperature_, temperature);
    const auto          a = hermite(q.t), b = hermite(T.t);
    Number              sum(0.);
    for (std::size_t i = 0; i < 2; ++i)
      for (std::size_t j = 0; j < 2; ++j)
      {
        if ((i == 1 && q.length == 0.) || (j == 1 && T.length == 0.))
          continue;
        const std::size_t k = (q.i + i) * temperature_.size() + T.i + j;
        sum += a[i] * b[j] * of.value[k] + a[2 + i] * b[j] * (q.length * of.by_strain[k]) +
               a[i] * b[2 + j] * (T.length * of.by_temperature[k]);
      }
    return sum;
  }

  template <typename Number>
  std::pair<Number, Number> FlowTable::at(const Number &strain, const Number &temperature) const
  {
    return {interpolate(log_sigma_, strain, temperature), interpolate(m_, strain, temperature)};
  }

  template std::pair<double, double> FlowTable::at(const double &, const double &) const;
  template std::pair<Dual, Dual>     FlowTable::at(const Dual &, const Dual &) const;

  namespace
  {
    constexpr double largest_stress = 5000.; // [MPa]

    [[noreturn]] void throw_no_table(const std::string &where, const std::string &what)
    {
      throw Error(
        where,
        what,
        "Material/table names a table with commas between its cells, a first row with the names "
        "`strain', `strain rate' [1/s], `temperature' [C] and `flow stress' [MPa], and a row for each "
        "combination of the strains, rates and temperatures in it",
        "correct it, or leave out the strain, rate or temperature that is not complete");
    }

    struct Measured
    {
      double      rate, stress;
      std::size_t line;
    };

    /// Rates and stresses at each strain and temperature.
    using Curves = std::map<double, std::map<double, std::vector<Measured>>>;

    Curves curves_in(const CsvTable &table)
    {
      const std::array<std::string, 4> names{{"strain", "strain rate", "temperature", "flow stress"}};
      std::array<std::size_t, 4>       columns;
      for (std::size_t i = 0; i < names.size(); ++i)
      {
        const auto found = table.column(names[i]);
        if (!found)
          throw_no_table(table.where(1), "names no column `" + names[i] + "'");
        columns[i] = *found;
      }
      Curves curves;
      for (const CsvTable::Row &row : table.rows)
      {
        const std::string     where = table.where(row.first);
        std::array<double, 4> x;
        for (std::size_t i = 0; i < names.size(); ++i)
        {
          const std::string text   = cell(row, columns[i]);
          const auto        number = number_in(text);
          if (!number)
            throw_no_table(
              where, text.empty() ? "has no " + names[i] : "has '" + legible(text) + "' for a " + names[i]);
          x[i] = *number;
        }
        const auto [strain, rate, temperature, stress] = x;
        if (strain < 0.)
          throw Error(where, "has the strain " + as_text(strain), "strains are not negative", "correct it");
        if (!(rate > 0.))
          throw Error(where,
                      "has the strain rate " + as_text(rate),
                      "rates are positive",
                      "leave out the rows of a test at rest, and give two rates at least");
        if (temperature <= absolute_zero || temperature > hottest)
          throw Error(where,
                      "has the temperature " + as_text(temperature),
                      "temperatures are in C, above " + as_text(absolute_zero) + " and at most " +
                        as_text(hottest),
                      "subtract 273.15 from those in K");
        if (!(stress > 0.) || stress > largest_stress)
          throw Error(where,
                      "has the flow stress " + as_text(stress),
                      "stresses are positive, in MPa, at most " + as_text(largest_stress),
                      "divide those in Pa by 1e6");
        auto &curve = curves[strain][temperature];
        for (const Measured &earlier : curve)
          if (earlier.rate == rate)
            throw_no_table(where, "repeats line " + std::to_string(earlier.line));
        curve.push_back({rate, stress, row.first});
      }
      if (curves.empty())
        throw_no_table(table.file, "has no stresses");
      return curves;
    }

    /// What all combinations are to have.
    struct Axes
    {
      std::set<double> rates, temperatures;
    };

    Axes axes_of(const Curves &curves)
    {
      Axes axes;
      for (const auto &[strain, by_temperature] : curves)
        for (const auto &[temperature, curve] : by_temperature)
        {
          axes.temperatures.insert(temperature);
          for (const Measured &measured : curve)
            axes.rates.insert(measured.rate);
        }
      return axes;
    }

    void check_complete(const std::string &file, const Curves &curves, const Axes &axes)
    {
      if (axes.rates.size() < 2)
        throw_no_table(file, "has one strain rate only: how the stress follows the rate takes two");
      for (const auto &[strain, by_temperature] : curves)
        for (const double temperature : axes.temperatures)
          for (const double rate : axes.rates)
          {
            const auto found = by_temperature.find(temperature);
            if (found == by_temperature.end() ||
                std::none_of(found->second.begin(), found->second.end(), [&](const Measured &measured) {
                  return measured.rate == rate;
                }))
              throw_no_table(file,
                             "has no stress at strain " + as_text(strain) + ", strain rate " + as_text(rate) +
                               ", temperature " + as_text(temperature));
          }
    }

    /// The line  log(stress) = log_sigma + m log(rate)  of least squares.
    std::pair<double, double> power_law(const std::vector<Measured> &curve)
    {
      double x = 0., y = 0., xx = 0., xy = 0.;
      for (const Measured &measured : curve)
      {
        x += std::log(measured.rate) / curve.size();
        y += std::log(measured.stress) / curve.size();
      }
      for (const Measured &measured : curve)
      {
        const double dx = std::log(measured.rate) - x;
        xx += dx * dx;
        xy += dx * (std::log(measured.stress) - y);
      }
      const double m = xy / xx;
      return {y - m * x, m};
    }
  } // namespace

  FlowTable read_flow_table(const std::string &file)
  {
    const CsvTable table  = read_csv(file, "the file of Material/table");
    const Curves   curves = curves_in(table);
    const Axes     axes   = axes_of(curves);
    check_complete(file, curves, axes);
    std::vector<double> strain, log_sigma, m;
    double              misfit = 0.;
    for (const auto &[q, by_temperature] : curves)
    {
      strain.push_back(q);
      for (const auto &[temperature, curve] : by_temperature)
      {
        const auto [log_sigma_1, exponent] = power_law(curve);
        if (!(exponent > 0.) || exponent > 1.)
          throw Error(
            table.where(curve.front().line),
            "has a flow stress that follows the strain rate to the power " + as_text(exponent) +
              " at strain " + as_text(q) + " and temperature " + as_text(temperature),
            "it rises with the rate, to a power of at most 1: metal that softens as it flows faster has no "
            "one equilibrium",
            "correct it, or give tests of two rates that are farther apart");
        log_sigma.push_back(log_sigma_1);
        m.push_back(exponent);
        for (const Measured &measured : curve)
          misfit = std::max(
            misfit,
            std::abs(std::exp(log_sigma_1 + exponent * std::log(measured.rate)) / measured.stress - 1.));
      }
    }
    return {strain, {axes.temperatures.begin(), axes.temperatures.end()}, log_sigma, m, misfit};
  }
} // namespace retroforge
