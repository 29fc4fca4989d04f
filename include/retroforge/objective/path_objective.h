// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/rank_sum.h>
#include <retroforge/solver/equilibrium.h>

#include <map>
#include <string>

/// @file
/// Objectives of what happens during a forging, in two levels:
///   a_ik = integrals of increment i over the workpiece, the mean of its stages as the time scheme weighs
///   them, Phi  = F( sum_i g(a_i, dt_i, t_i, s_i) ),  s_i its stroke and step.
/// The integrals are all that touches the mesh: each objective writes their reverse in closed form. g and F
/// are functions of a few numbers, and their derivatives come from dual numbers. A run keeps the rows a_i
/// (some doubles per increment), so that nothing is evaluated twice and smooth maxima can be scaled by the
/// largest value before they are summed.
///
/// Backwards:  reverse_value() gives dPhi/d(a_i, dt_i, t_i, s_i) for all increments at once;  at increment i
/// reverse_integrals() adds what follows from a_i; what follows from the others the sweep adds once.
namespace retroforge
{
  /// One increment as objectives see it, the same on every rank.
  template <typename Number>
  struct PathRow
  {
    std::vector<Number> integrals; ///< completed over ranks
    Number              dt;        ///< [s]
    Number              time;      ///< at the increment's start, from that of the first stroke [s]
    Number              stroke;    ///< at the increment's start, those of operations before included [mm]
    Number              step;      ///< [mm]
    /// The middle of the increment and its length in the recorded run [mm], fixed by decision: stroke and step are
    /// others where ends of increments follow the state (steps/moved_ends.h).
    double       place, length;
    unsigned int operation = 0;
  };

  template <typename Number>
  using PathRows = std::vector<PathRow<Number>>;

  /// Returns that of an increment as it was recorded.
  /// @param time, stroke  at its start, from that of the run [s, mm]
  template <typename Number>
  PathRow<Number> recorded_row(std::vector<Number> integrals,
                               const Number       &dt,
                               const Number       &time,
                               const double        stroke,
                               const double        step,
                               const unsigned int  operation = 0)
  {
    return {
      std::move(integrals), dt, time, Number(stroke), Number(step), stroke + 0.5 * step, step, operation};
  }

  /// Values at places, of which an objective makes its own.
  struct ObjectiveMap
  {
    NodalVectors<double> places; ///< [mm]
    std::vector<double>  values; ///< in the objective's unit
  };

  class PathObjective
  {
  public:
    virtual ~PathObjective() = default;

    virtual std::string name() const = 0;
    virtual std::string unit() const = 0;

    /// Returns what one stage of increment i gives to a_i.
    virtual RankSum<std::vector<double>> integrals(const EquilibriumView<double> &view) const = 0;
    virtual RankSum<std::vector<Dual>>   integrals(const EquilibriumView<Dual> &view) const   = 0;

    /// Adds the derivatives of weights·integrals, this rank's part.
    virtual void reverse_integrals(const EquilibriumView<double> &view,
                                   const std::vector<double>     &weights,
                                   EquilibriumBar                &bar) const = 0;

    /// Returns whether Phi is a mean, a sum or a maximum of forces along the path, of which it is known how far slopes
    /// hold (run/slope_trust.h).
    virtual bool is_of_forces() const { return false; }

    /// Returns Phi.
    /// @throws Error  when it is not defined for these increments (an empty window)
    virtual double value(const PathRows<double> &rows) const = 0;
    virtual Dual   value(const PathRows<Dual> &rows) const   = 0;

    /// Returns the summands of the value.
    virtual std::map<std::string, double> parts(const PathRows<double> &) const { return {}; }

    /// Returns other numbers told beside it: the true maximum beside a smooth one.
    virtual std::map<std::string, double> details(const PathRows<double> &) const { return {}; }

    /// Returns what shows where the value comes from; empty for an objective without places.
    virtual ObjectiveMap map(const PathRows<double> &) const { return {}; }

    /// Returns dPhi/d(a_i, dt_i, t_i, s_i) of each increment.
    virtual PathRows<double> reverse_value(const PathRows<double> &rows) const = 0;
  };

  /// Adds to a row what one stage of its increment gives to its integrals.
  template <typename Number>
  void
  add_integrals(const PathObjective &objective, const EquilibriumView<Number> &view, PathRow<Number> &row)
  {
    const auto whole = objective.integrals(view).complete();
    row.integrals.resize(whole.size(), Number(0.));
    for (std::size_t k = 0; k < whole.size(); ++k)
      row.integrals[k] += view.weight * whole[k];
  }

  PathRow<double>  values_of(const PathRow<Dual> &row);
  PathRows<double> values_of(const PathRows<Dual> &rows);
  PathRow<Dual>    constant(const PathRow<double> &row);

  /// Returns the derivatives of a function of one row.
  /// @param f  of a PathRow<Dual>, a Dual
  template <typename Function>
  PathRow<double> derivatives_of(const Function &f, const PathRow<double> &row)
  {
    PathRow<Dual> at         = constant(row);
    const auto    derivative = [&](Dual &input) {
      input.fastAccessDx(0) = 1.;
      const double slope    = f(at).dx(0);
      input.fastAccessDx(0) = 0.;
      return slope;
    };
    PathRow<double> bar{{},
                        derivative(at.dt),
                        derivative(at.time),
                        derivative(at.stroke),
                        derivative(at.step),
                        row.place,
                        row.length,
                        row.operation};
    for (Dual &integral : at.integrals)
      bar.integrals.push_back(derivative(integral));
    return bar;
  }

  /// A PathObjective whose integrals are those of class T, for any Number
  ///   std::vector<Number> compute_integrals(const EquilibriumView<Number> &) const;                of this rank
  template <typename T>
  class PathIntegralsOf : public PathObjective
  {
  public:
    RankSum<std::vector<double>> integrals(const EquilibriumView<double> &view) const override
    {
      return sum_integrals(view);
    }
    RankSum<std::vector<Dual>> integrals(const EquilibriumView<Dual> &view) const override
    {
      return sum_integrals(view);
    }

  private:
    template <typename Number>
    RankSum<std::vector<Number>> sum_integrals(const EquilibriumView<Number> &view) const
    {
      const auto &discretization = view.stage.scene.discretization;
      Assert(view.W.belongs_to(discretization),
             dealii::ExcMessage("the unknowns are of another discretisation than the stage"));
      return {static_cast<const T &>(*this).template compute_integrals<Number>(view), discretization.comm()};
    }
  };

  /// One whose value is made from class T as well, which has the number of its terms and for any Number
  ///   static constexpr unsigned int n_terms;
  ///   std::vector<Number> terms(const PathRow<Number> &, double scale) const;                g
  ///   Number              combine(const std::vector<Number> &sums, double scale) const;      F
  /// and, if it needs one,  double scale(const PathRows<double> &) const:  a number that g and F use to avoid
  /// overflow and on which Phi does not depend; it is not differentiated.
  template <typename T>
  class PathObjectiveOf : public PathIntegralsOf<T>
  {
  public:
    double value(const PathRows<double> &rows) const override { return evaluate(rows, self().scale(rows)); }
    Dual   value(const PathRows<Dual> &rows) const override
    {
      return evaluate(rows, self().scale(values_of(rows)));
    }

    PathRows<double> reverse_value(const PathRows<double> &rows) const override
    {
      const double              scale = self().scale(rows);
      const std::vector<double> bar   = sums_bar(sum_terms(rows, scale), scale);
      PathRows<double>          rows_bar;
      for (const PathRow<double> &row : rows)
        rows_bar.push_back(row_bar(row, bar, scale));
      return rows_bar;
    }

    double scale(const PathRows<double> &) const { return 1.; }

  private:
    const T &self() const { return static_cast<const T &>(*this); }

    template <typename Number>
    std::vector<Number> sum_terms(const PathRows<Number> &rows, const double scale) const
    {
      std::vector<Number> sums(T::n_terms, Number(0.));
      for (const PathRow<Number> &row : rows)
      {
        const std::vector<Number> terms = self().template terms<Number>(row, scale);
        AssertDimension(terms.size(), T::n_terms);
        for (unsigned int j = 0; j < T::n_terms; ++j)
          sums[j] += terms[j];
      }
      return sums;
    }

    template <typename Number>
    Number evaluate(const PathRows<Number> &rows, const double scale) const
    {
      return self().template combine<Number>(sum_terms(rows, scale), scale);
    }

    std::vector<double> sums_bar(const std::vector<double> &sums, const double scale) const
    {
      std::vector<double> bar;
      std::vector<Dual>   at(sums.begin(), sums.end());
      for (Dual &sum : at)
      {
        sum.fastAccessDx(0) = 1.;
        bar.push_back(self().template combine<Dual>(at, scale).dx(0));
        sum.fastAccessDx(0) = 0.;
      }
      return bar;
    }

    PathRow<double>
    row_bar(const PathRow<double> &row, const std::vector<double> &bar, const double scale) const
    {
      return derivatives_of(
        [&](const PathRow<Dual> &at) {
          const std::vector<Dual> terms = self().template terms<Dual>(at, scale);
          Dual                    sum(0.);
          for (unsigned int j = 0; j < T::n_terms; ++j)
            sum += bar[j] * terms[j];
          return sum;
        },
        row);
    }
  };
} // namespace retroforge
