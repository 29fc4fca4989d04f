// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/adjoint/check.h>
#include <retroforge/core/error.h>

#include <iomanip>
#include <iostream>
#include <random>

namespace retroforge
{
  void CheckParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    using namespace dealii::Patterns;
    prm.enter_subsection("Check");
    prm.add_parameter(
      "steps",
      steps,
      "Steps of the finite differences, relative to the parameter's value or the billet's size. "
      "Units: none.");
    prm.add_parameter(
      "free differences",
      free,
      "Also run with everything decided anew: shows the jumps that decisions make. Units: none.");
    prm.add_parameter("taylor start",
                      taylor_start,
                      "Largest relative step of the Taylor test. Units: none.",
                      Double(1e-12, 1.));
    prm.add_parameter("taylor halvings", taylor_halvings, "Units: none.", Integer(2));
    prm.add_parameter("replayed bar",
                      replayed_bar,
                      "Relative error that the best replayed central difference must reach. Units: none.",
                      Double(0.));
    prm.add_parameter("tangent bar",
                      tangent_bar,
                      "Relative difference allowed between adjoint and direct method. Units: none.",
                      Double(0.));
    prm.add_parameter(
      "taylor bar", taylor_bar, "Least order of the Taylor remainder. Units: none.", Double(0.));
    prm.leave_subsection();
  }

  namespace
  {
    double relative(const double a, const double b)
    {
      return std::abs(a - b) / std::max({std::abs(a), std::abs(b), 1e-300});
    }

    NodalVectors<double> times(const double s, NodalVectors<double> x)
    {
      for (Vec3 &v : x)
        v *= s;
      return x;
    }

    /// The objective along one direction: t -> Phi(mu + t mu_dot, shift_dot t).
    struct Line
    {
      const std::vector<double> &mu;
      std::vector<double>        mu_dot;
      NodalVectors<double>       shift_dot;

      double operator()(const decltype(ObjectiveOracle::free) &objective, const double t) const
      {
        std::vector<double> at = mu;
        for (std::size_t j = 0; j < mu.size(); ++j)
          at[j] += t * mu_dot[j];
        return objective(at, times(t, shift_dot));
      }
    };

    /// A run that decides everything anew may also fail anew: then there is no difference, and the rest of
    /// the check goes on.
    double free_difference(const Line &line, const ObjectiveOracle &oracle, const double h)
    {
      try
      {
        return (line(oracle.free, h) - line(oracle.free, -h)) / (2. * h);
      }
      catch (const Error &error)
      {
        std::cerr << "  free difference of step " << h << ": " << error.what() << std::endl;
        return NAN;
      }
    }

    CheckRow check_line(const CheckParameters &parameters,
                        const Line            &line,
                        const double           value,
                        const double           scale,
                        const ObjectiveOracle &oracle,
                        CheckRow               row)
    {
      row.tangent = oracle.tangent(line.mu_dot, line.shift_dot);
      for (const double step : parameters.steps)
      {
        const double  h    = step * scale;
        const double  plus = line(oracle.replayed, h), minus = line(oracle.replayed, -h);
        DifferenceRow d{step, (plus - minus) / (2. * h), (plus - value) / h, (value - minus) / h, NAN};
        if (parameters.free)
          d.free_central = free_difference(line, oracle, h);
        row.steps.push_back(d);
      }
      double last = 0.;
      for (unsigned int i = 0; i <= parameters.taylor_halvings; ++i)
      {
        const double h         = parameters.taylor_start * scale * std::pow(0.5, i);
        const double remainder = std::abs(line(oracle.replayed, h) - value - h * row.adjoint);
        if (i > 0)
          row.taylor_orders.push_back(std::log2(last / remainder));
        last = remainder;
      }
      // A remainder at rounding has no order: the objective is linear in this parameter.
      const bool linear = last <= 1e-9 * std::abs(parameters.taylor_start * scale * row.adjoint);
      row.passed        = row.tangent_error() <= parameters.tangent_bar &&
                   row.best_replayed_error() <= parameters.replayed_bar &&
                   (linear || row.taylor_orders.back() >= parameters.taylor_bar);
      return row;
    }
  } // namespace

  double CheckRow::tangent_error() const
  {
    return std::abs(adjoint - tangent) / std::max({std::abs(adjoint), std::abs(tangent), magnitude, 1e-300});
  }

  double CheckRow::best_replayed_error() const
  {
    double best = std::numeric_limits<double>::max();
    for (const auto &step : steps)
      best = std::min(best, relative(step.replayed_central, adjoint));
    return best;
  }

  double CheckRow::best_free_error() const
  {
    double best = std::numeric_limits<double>::max();
    for (const auto &step : steps)
      if (!std::isnan(step.free_central))
        best = std::min(best, relative(step.free_central, adjoint));
    return best;
  }

  std::vector<CheckRow> check_gradient(const CheckParameters      &parameters,
                                       const Design               &design,
                                       const std::vector<double>  &mu,
                                       const double                value,
                                       const std::vector<double>  &gradient,
                                       const NodalVectors<double> &X_0_bar,
                                       const double                length,
                                       const ObjectiveOracle      &oracle)
  {
    std::vector<CheckRow>      rows;
    const NodalVectors<double> still(X_0_bar.size());
    for (std::size_t j = 0; j < mu.size(); ++j)
    {
      std::vector<double> mu_dot(mu.size(), 0.);
      mu_dot[j]             = 1.;
      const auto &parameter = design.parameters()[j];
      rows.push_back(check_line(parameters,
                                {mu, mu_dot, still},
                                value,
                                parameter.scale,
                                oracle,
                                {parameter.name, parameter.unit, gradient[j], 0., {}, {}, false, 0.}));
    }
    std::mt19937                           generator(1);
    std::uniform_real_distribution<double> uniform(-1., 1.);
    NodalVectors<double>                   direction(X_0_bar.size());
    double                                 slope = 0., slope2 = 0.;
    for (std::size_t k = 0; k < direction.size(); ++k)
      for (unsigned int i = 0; i < 3; ++i)
      {
        direction[k][i]   = uniform(generator);
        const double term = direction[k][i] * X_0_bar[k][i];
        slope += term;
        slope2 += term * term;
      }
    CheckParameters small = parameters;
    for (double &step : small.steps)
      step *= 0.1;
    small.taylor_start *= 0.1;
    rows.push_back(check_line(small,
                              {mu, std::vector<double>(mu.size(), 0.), direction},
                              value,
                              length,
                              oracle,
                              {"X_0 (random direction)", "mm", slope, 0., {}, {}, false, std::sqrt(slope2)}));
    return rows;
  }

  void print(const std::vector<CheckRow> &rows, std::ostream &out)
  {
    out << "\n  derivative of the energy          adjoint        adjoint/tangent-1  step     replayed   "
           "forward    free       "
           "Taylor orders\n"
        << std::scientific;
    for (const CheckRow &row : rows)
      for (std::size_t i = 0; i < std::max<std::size_t>(1, row.steps.size()); ++i)
      {
        if (i == 0)
          out << "  " << std::left << std::setw(28) << row.parameter << std::right << std::setprecision(9)
              << std::setw(17) << row.adjoint << std::setprecision(1) << std::setw(15) << row.tangent_error()
              << "    ";
        else
          out << std::string(66, ' ');
        if (i < row.steps.size())
        {
          const auto &d = row.steps[i];
          out << std::setprecision(0) << std::setw(10) << d.step << std::setprecision(1) << std::setw(11)
              << relative(d.replayed_central, row.adjoint) << std::setw(11)
              << relative(d.replayed_forward, row.adjoint) << std::setw(11);
          if (std::isnan(d.free_central))
            out << "-";
          else
            out << relative(d.free_central, row.adjoint);
        }
        if (i == 0)
        {
          out << std::fixed << std::setprecision(2) << "  ";
          for (const double order : row.taylor_orders)
            out << ' ' << order;
          out << (row.passed ? "  passed" : "  FAILED") << std::scientific;
        }
        out << '\n';
      }
    out << std::defaultfloat << std::setprecision(6);
  }
} // namespace retroforge
