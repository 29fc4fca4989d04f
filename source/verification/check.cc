// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/nearest_name.h>
#include <retroforge/verification/check.h>

#include <iomanip>
#include <iostream>
#include <random>

namespace retroforge
{
  namespace
  {
    double relative(const double a, const double b)
    {
      return std::abs(a - b) / std::max({std::abs(a), std::abs(b), 1e-300});
    }

    ShapePerturbation times(const double s, ShapePerturbation x)
    {
      for (Vec3 &v : x.X_0)
        v *= s;
      for (NodalVectors<double> &die : x.dies)
        for (Vec3 &v : die)
          v *= s;
      return x;
    }

    using Values = DifferenceEvaluator::Values;

    /// The objectives along one direction: t -> Phi(mu + t mu_dot, shift_dot t).
    struct Line
    {
      const std::vector<double> &mu;
      std::vector<double>        mu_dot;
      ShapePerturbation          shift_dot;

      Values operator()(const decltype(DifferenceEvaluator::free) &objectives, const double t) const
      {
        std::vector<double> at = mu;
        for (std::size_t j = 0; j < mu.size(); ++j)
          at[j] += t * mu_dot[j];
        return objectives(at, times(t, shift_dot));
      }
    };

    /// A forging beside the nominal one may fail, most of all one that decides anew: then it has no values, no difference is
    /// made of it, and the rest of the check goes on.
    Values values_at(const Line                                &line,
                     const decltype(DifferenceEvaluator::free) &objectives,
                     const std::string                         &what,
                     const double                               h,
                     const std::size_t                          n)
    {
      try
      {
        return line(objectives, h);
      }
      catch (const Error &error)
      {
        if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
          std::cerr << "  " << what << " at a step of " << h << ": " << error.what() << std::endl;
        return Values(n, NAN);
      }
    }

    /// What a derivative that did not pass fails by, in words.
    std::string reason_of_failure(const CheckRow        &row,
                                  const CheckParameters &parameters,
                                  const bool             same,
                                  const bool             is_linear)
    {
      std::vector<std::string> reasons;
      if (!same)
        reasons.push_back("direct method");
      if (!(row.best_replayed_error() <= parameters.replayed_bar))
        reasons.push_back("replayed differences");
      if (!is_linear && !(row.taylor_orders.back() >= parameters.taylor_bar))
        reasons.push_back(std::isnan(row.taylor_orders.back()) ? "Taylor, whose forgings fail"
                                                               : "Taylor: a kink within Check/taylor start?");
      return join(reasons);
    }

    /// Completes the rows of one line, one per objective.
    void check_line(const CheckParameters                   &parameters,
                    const Line                              &line,
                    const std::vector<ObjectiveSensitivity> &sensitivities,
                    const double                             scale,
                    const DifferenceEvaluator               &evaluator,
                    std::vector<CheckRow>                   &rows)
    {
      const Values tangents = evaluator.tangent(line.mu_dot, line.shift_dot);
      for (std::size_t o = 0; o < rows.size(); ++o)
        rows[o].tangent = tangents[o];
      for (const double step : parameters.steps)
      {
        const double      h    = step * scale;
        const std::size_t n    = rows.size();
        const Values      plus = values_at(line, evaluator.replayed, "replayed", h, n),
                     minus     = values_at(line, evaluator.replayed, "replayed", -h, n);
        Values free(n, NAN);
        if (parameters.free)
        {
          const Values above = values_at(line, evaluator.free, "decided anew", h, n),
                       below = values_at(line, evaluator.free, "decided anew", -h, n);
          for (std::size_t o = 0; o < n; ++o)
            free[o] = (above[o] - below[o]) / (2. * h);
        }
        for (std::size_t o = 0; o < rows.size(); ++o)
        {
          const double value = sensitivities[o].value;
          rows[o].steps.push_back(
            {step, (plus[o] - minus[o]) / (2. * h), (plus[o] - value) / h, (value - minus[o]) / h, free[o]});
        }
      }
      std::vector<double> last(rows.size(), 0.);
      for (unsigned int i = 0; i <= parameters.taylor_halvings; ++i)
      {
        const double h  = parameters.taylor_start * scale * std::pow(0.5, i);
        const Values at = values_at(line, evaluator.replayed, "replayed", h, rows.size());
        for (std::size_t o = 0; o < rows.size(); ++o)
        {
          const double remainder = std::abs(at[o] - sensitivities[o].value - h * rows[o].adjoint);
          if (i > 0)
            rows[o].taylor_orders.push_back(std::log2(last[o] / remainder));
          last[o] = remainder;
        }
      }
      for (std::size_t o = 0; o < rows.size(); ++o)
      {
        CheckRow &row = rows[o];
        // What moves the objective by less than 1e-7 of itself while the parameter moves by all of its size
        // is rounding. So is 1e-13 of that in a derivative, 1e-11 of it in a difference, and 1e-10 of the
        // value in a remainder.
        const double whole = std::abs(sensitivities[o].value) / scale;
        row.is_zero        = std::max(std::abs(row.adjoint), std::abs(row.tangent)) <= 1e-7 * whole &&
                      row.smallest_difference() <= 2e-7 * whole;
        row.least_difference = 1e-5 * whole;
        if (row.is_zero)
        {
          row.passed = true;
          continue;
        }
        // A remainder at rounding has no order: the objective is linear in this parameter.
        const bool linear =
          last[o] <= std::max(1e-9 * std::abs(parameters.taylor_start * scale * row.adjoint),
                              1e-10 * std::abs(sensitivities[o].value));
        const bool same = row.tangent_error() <= parameters.tangent_bar ||
                          std::abs(row.adjoint - row.tangent) <= 1e-13 * whole;
        row.failed_by = reason_of_failure(row, parameters, same, linear);
        row.passed    = row.failed_by.empty();
      }
    }
  } // namespace

  double CheckRow::tangent_error() const
  {
    return std::abs(adjoint - tangent) / std::max({std::abs(adjoint), std::abs(tangent), magnitude, 1e-300});
  }

  double CheckRow::smallest_difference() const
  {
    double smallest = std::numeric_limits<double>::max();
    for (const auto &step : steps)
      smallest = std::min(smallest, std::abs(step.replayed_central));
    return smallest;
  }

  double CheckRow::best_replayed_error() const
  {
    const auto error = [&](const double difference) {
      return std::abs(difference - adjoint) /
             std::max({std::abs(difference), std::abs(adjoint), least_difference, 1e-300});
    };
    double best = std::numeric_limits<double>::max();
    for (std::size_t i = 0; i < steps.size(); ++i)
    {
      best = std::min(best, error(steps[i].replayed_central));
      if (i == 0 || steps[i].step == steps[i - 1].step)
        continue;
      const double ratio2 = std::pow(steps[i - 1].step / steps[i].step, 2);
      best                = std::min(
        best, error((ratio2 * steps[i].replayed_central - steps[i - 1].replayed_central) / (ratio2 - 1.)));
    }
    return best;
  }

  namespace
  {
    DifferenceFit fit_of(const CheckRow &row, double DifferenceRow::*difference)
    {
      const double whole = 1e5 * row.least_difference; // the value over the parameter's scale
      if (row.is_zero || !(whole > 0.))
        return {};
      std::vector<double> steps, d;
      for (const DifferenceRow &of_step : row.steps)
      {
        steps.push_back(of_step.step);
        d.push_back(of_step.*difference / whole);
      }
      DifferenceFit fit = DifferenceFit::of(steps, d, 1.);
      fit.slope *= whole;
      fit.uncertainty *= whole;
      return fit;
    }
  } // namespace

  DifferenceFit CheckRow::free_fit() const
  {
    return fit_of(*this, &DifferenceRow::free_central);
  }

  DifferenceFit CheckRow::replayed_fit() const
  {
    return fit_of(*this, &DifferenceRow::replayed_central);
  }

  bool CheckRow::is_doubtful() const
  {
    constexpr double    doubtful = 0.5;
    const DifferenceFit free     = free_fit();
    return !std::isnan(free.slope) &&
           std::abs(free.slope - adjoint) >
             std::max(doubtful * std::max({std::abs(adjoint), std::abs(free.slope), magnitude}),
                      3. * free.uncertainty);
  }

  namespace
  {
    NodalVectors<double> random_vectors(const std::size_t n, std::mt19937 &generator)
    {
      std::uniform_real_distribution<double> uniform(-1., 1.);
      NodalVectors<double>                   vectors(n);
      for (Vec3 &v : vectors)
        for (unsigned int i = 0; i < 3; ++i)
          v[i] = uniform(generator);
      return vectors;
    }

    /// The derivative along a direction, and the root of the squares of its terms.
    std::pair<double, double> along(const ShapePerturbation &direction, const ShapePerturbation &derivative)
    {
      double     slope = 0., slope2 = 0.;
      const auto add = [&](const NodalVectors<double> &a, const NodalVectors<double> &b) {
        for (std::size_t k = 0; k < a.size(); ++k)
          for (unsigned int i = 0; i < 3; ++i)
          {
            const double term = a[k][i] * b[k][i];
            slope += term;
            slope2 += term * term;
          }
      };
      add(direction.X_0, derivative.X_0);
      for (std::size_t d = 0; d < direction.dies.size(); ++d)
        add(direction.dies[d], derivative.dies[d]);
      return {slope, std::sqrt(slope2)};
    }

    /// A line in the space of designs along which derivatives are checked.
    struct Direction
    {
      std::string         name, unit;
      std::vector<double> mu_dot;
      ShapePerturbation   shift_dot;
      double              scale;       ///< of the steps, in its unit
      bool                is_of_shape; ///< all nodes move at once: steps are ten times smaller
    };

    std::vector<Direction>
    directions(const Design &design, const ShapePerturbation &shape, const double length)
    {
      const std::size_t      n_nodes = shape.X_0.size(), n = design.parameters().size();
      std::vector<Direction> directions;
      for (std::size_t j = 0; j < n; ++j)
      {
        const auto &parameter = design.parameters()[j];
        directions.push_back({parameter.name,
                              parameter.unit,
                              std::vector<double>(n, 0.),
                              {NodalVectors<double>(n_nodes), {}},
                              parameter.scale,
                              false});
        directions.back().mu_dot[j] = 1.;
      }
      std::mt19937      generator(1);
      ShapePerturbation moved;
      const auto        append = [&](const std::string &name) {
        directions.push_back(
          {name + " (random direction)", "mm", std::vector<double>(n, 0.), moved, length, true});
      };
      moved.X_0 = random_vectors(n_nodes, generator);
      moved.dies.resize(shape.dies.size());
      append("X_0");
      moved.X_0 = NodalVectors<double>(n_nodes);
      for (unsigned int d = 0; d < moved.dies.size(); ++d)
        if (const std::size_t n_vertices = shape.dies[d].size(); n_vertices > 0)
        {
          moved.dies[d] = random_vectors(n_vertices, generator);
          append(design.die_name(d));
          moved.dies[d].clear();
        }
      return directions;
    }

    /// Rows of a direction before the runs: what the backward sweep says.
    std::vector<CheckRow> rows_of(const Direction                         &direction,
                                  const std::vector<ObjectiveSensitivity> &sensitivities)
    {
      std::vector<CheckRow> rows;
      for (const ObjectiveSensitivity &objective : sensitivities)
      {
        auto [slope, magnitude] = along(direction.shift_dot, objective.shape);
        for (std::size_t j = 0; j < direction.mu_dot.size(); ++j)
          slope += direction.mu_dot[j] * objective.gradient[j];
        rows.push_back({objective.name, direction.name, direction.unit, slope, 0., {}, {}, false, magnitude});
      }
      return rows;
    }

    /// Rows of a direction that an earlier check has done, or none.
    std::vector<CheckRow> done_rows(const Direction                         &direction,
                                    const std::vector<ObjectiveSensitivity> &sensitivities,
                                    const std::vector<CheckRow>             &done)
    {
      std::vector<CheckRow> rows;
      for (const ObjectiveSensitivity &objective : sensitivities)
        for (const CheckRow &row : done)
          if (row.objective == objective.name && row.parameter == direction.name)
            rows.push_back(row);
      return rows.size() == sensitivities.size() ? rows : std::vector<CheckRow>();
    }

    std::vector<CheckRow> by_objective(const std::vector<std::vector<CheckRow>> &of_directions)
    {
      std::vector<CheckRow> rows;
      for (std::size_t o = 0; !of_directions.empty() && o < of_directions[0].size(); ++o)
        for (const auto &direction : of_directions)
          rows.push_back(direction[o]);
      return rows;
    }
  } // namespace

  std::vector<CheckRow> check_gradient(const CheckParameters                   &parameters,
                                       const Design                            &design,
                                       const std::vector<double>               &mu,
                                       const std::vector<ObjectiveSensitivity> &sensitivities,
                                       const double                             length,
                                       const DifferenceEvaluator               &evaluator,
                                       const std::vector<CheckRow>             &done,
                                       const CheckWatch                        &watch)
  {
    CheckParameters small = parameters;
    for (double &step : small.steps)
      step *= 0.1;
    small.taylor_start *= 0.1;
    std::vector<std::vector<CheckRow>> of_directions;
    const auto                         all = directions(design, sensitivities[0].shape, length);
    for (const Direction &direction : all)
      if (const auto rows = done_rows(direction, sensitivities, done); rows.empty())
        break;
      else
        of_directions.push_back(rows);
    watch(by_objective(of_directions), of_directions.size(), all.size());
    for (std::size_t i = of_directions.size(); i < all.size(); ++i)
    {
      const Direction &direction = all[i];
      of_directions.push_back(rows_of(direction, sensitivities));
      check_line(direction.is_of_shape ? small : parameters,
                 {mu, direction.mu_dot, direction.shift_dot},
                 sensitivities,
                 direction.scale,
                 evaluator,
                 of_directions.back());
      watch(by_objective(of_directions), of_directions.size(), all.size());
    }
    return by_objective(of_directions);
  }

  namespace
  {
    /// Says what of the differences that decide anew is a derivative that is left out, and what are jumps.
    void print_free(const CheckRow &row, std::ostream &out)
    {
      const DifferenceFit free = row.free_fit();
      if (std::isnan(free.slope))
        return;
      const double rounding = 3. * row.replayed_fit().jump;
      out << "    decided anew: slope " << std::showpos << 100. * (free.slope / row.adjoint - 1.)
          << std::noshowpos << " % beside the adjoint (+- " << 100. * std::abs(free.uncertainty / row.adjoint)
          << " %), " << (free.jump > rounding ? "jumps of " : "no jumps above rounding, ") << free.jump
          << " of the value" << (row.is_doubtful() ? ": DOUBTFUL, scan tells which slope holds" : "") << '\n';
    }
  } // namespace

  void print(const std::vector<CheckRow> &rows, std::ostream &out)
  {
    out << std::scientific;
    std::string objective;
    for (const CheckRow &row : rows)
    {
      if (row.objective != objective)
        out << "\n  " << std::left << std::setw(31) << "derivative of " + row.objective
            << "   adjoint        adjoint/tangent-1  step     replayed   forward    free       "
               "Taylor orders\n";
      objective = row.objective;
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
          out << std::setprecision(0) << std::setw(10) << d.step << std::setprecision(1);
          for (const double difference : {d.replayed_central, d.replayed_forward, d.free_central})
            if (out << std::setw(11); std::isnan(difference)) // its forgings failed, or it is not asked for
              out << "-";
            else
              out << relative(difference, row.adjoint);
        }
        if (i == 0)
        {
          out << std::fixed << std::setprecision(2) << "  ";
          for (const double order : row.taylor_orders)
            if (out << ' '; std::isfinite(order)) // remainders of nothing have none
              out << order;
            else
              out << '-';
          out << (row.is_zero  ? "  passed (zero)"
                  : row.passed ? "  passed"
                               : "  FAILED (" + row.failed_by + ")")
              << std::scientific;
        }
        out << '\n';
      }
      print_free(row, out);
    }
    out << std::defaultfloat << std::setprecision(6);
  }
} // namespace retroforge
