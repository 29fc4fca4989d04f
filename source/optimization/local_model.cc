// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/optimization/local_model.h>
#include <retroforge/optimization/small_vectors.h>

// The one file that knows ROL, whose headers take long to compile.
#include <ROL_Bounds.hpp>
#include <ROL_Objective.hpp>
#include <ROL_ParameterList.hpp>
#include <ROL_Problem.hpp>
#include <ROL_StatusTest.hpp>
#include <ROL_StdVector.hpp>
#include <ROL_Stream.hpp>
#include <ROL_TypeB_LinMoreAlgorithm.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace retroforge
{
  namespace
  {
    using Vector = BoundedProblem::Vector;

    const Vector &numbers(const ROL::Vector<double> &x)
    {
      return *dynamic_cast<const ROL::StdVector<double> &>(x).getVector();
    }

    Vector &numbers(ROL::Vector<double> &x)
    {
      return *dynamic_cast<ROL::StdVector<double> &>(x).getVector();
    }

    ROL::Ptr<ROL::StdVector<double>> rol_vector(const Vector &x)
    {
      return ROL::makePtr<ROL::StdVector<double>>(ROL::makePtr<Vector>(x));
    }

    double c_at(const PenaltyTerm &term, const Vector &step)
    {
      return term.c + dot(term.gradient, step);
    }
  } // namespace

  double PenaltyTerm::value(const double at_c) const
  {
    if (!is_limit)
      return (multiplier + 0.5 * curvature * at_c) * at_c;
    return (std::pow(std::max(multiplier + curvature * at_c, 0.), 2) - multiplier * multiplier) /
           (2. * curvature);
  }

  double PenaltyTerm::slope(const double at_c) const
  {
    const double pressed = multiplier + curvature * at_c;
    return is_limit ? std::max(pressed, 0.) : pressed;
  }

  double PenaltyTerm::bend(const double at_c) const
  {
    return !is_limit || multiplier + curvature * at_c > 0. ? curvature : 0.;
  }

  Vector Linearization::whole_gradient() const
  {
    Vector whole = gradient;
    for (const PenaltyTerm &term : terms)
      add(term.slope(term.c), term.gradient, whole);
    return whole;
  }

  LocalModel::LocalModel(const Vector &origin, Linearization known, Hessian hessian)
      : origin_(origin), known_(std::move(known)), hessian_(std::move(hessian))
  {
  }

  LocalModel LocalModel::with(const std::vector<PenaltyTerm> &terms) const
  {
    LocalModel more = *this;
    more.known_.terms.insert(more.known_.terms.end(), terms.begin(), terms.end());
    return more;
  }

  double LocalModel::change(const Vector &x) const
  {
    const Vector step = difference(x, origin_);
    double       sum  = dot(known_.gradient, step);
    if (hessian_)
      sum += 0.5 * dot(step, hessian_(step));
    for (const PenaltyTerm &term : known_.terms)
      sum += term.value(c_at(term, step)) - term.value(term.c);
    return sum;
  }

  Vector LocalModel::gradient(const Vector &x) const
  {
    const Vector step = difference(x, origin_);
    Vector       sum  = known_.gradient;
    if (hessian_)
      add(1., hessian_(step), sum);
    for (const PenaltyTerm &term : known_.terms)
      add(term.slope(c_at(term, step)), term.gradient, sum);
    return sum;
  }

  Vector LocalModel::bend(const Vector &x, const Vector &v) const
  {
    const Vector step = difference(x, origin_);
    Vector       sum  = hessian_ ? hessian_(v) : Vector(v.size(), 0.);
    for (const PenaltyTerm &term : known_.terms)
      add(term.bend(c_at(term, step)) * dot(term.gradient, v), term.gradient, sum);
    return sum;
  }

  double LocalModel::stiff_against(const Vector &direction) const
  {
    constexpr double stiff = 1e3;
    return stiff * (1. + length(bend(origin_, direction)));
  }

  namespace
  {
    class ModelForRol : public ROL::Objective<double>
    {
    public:
      explicit ModelForRol(const LocalModel &model) : model_(model) {}

      double value(const ROL::Vector<double> &x, double & /*tolerance*/) override
      {
        return model_.change(numbers(x));
      }

      void gradient(ROL::Vector<double> &g, const ROL::Vector<double> &x, double & /*tolerance*/) override
      {
        numbers(g) = model_.gradient(numbers(x));
      }

      void hessVec(ROL::Vector<double>       &hv,
                   const ROL::Vector<double> &v,
                   const ROL::Vector<double> &x,
                   double & /*tolerance*/) override
      {
        numbers(hv) = model_.bend(numbers(x), numbers(v));
      }

    private:
      const LocalModel &model_;
    };

    /// For a check of derivatives.
    class FunctionForRol : public ROL::Objective<double>
    {
    public:
      explicit FunctionForRol(const BoundedProblem &problem) : problem_(problem) {}

      double value(const ROL::Vector<double> &x, double & /*tolerance*/) override
      {
        return problem_.value(numbers(x));
      }

      void gradient(ROL::Vector<double> &g, const ROL::Vector<double> &x, double & /*tolerance*/) override
      {
        numbers(g) = problem_.linearize(numbers(x)).whole_gradient();
      }

    private:
      const BoundedProblem &problem_;
    };

    class NearEnough : public ROL::StatusTest<double>
    {
    public:
      NearEnough(ROL::ParameterList &list, const double tolerance)
          : ROL::StatusTest<double>(list), tolerance_(tolerance)
      {
      }

      bool check(ROL::AlgorithmState<double> &state) override
      {
        const auto      &of_bounds = static_cast<const ROL::TypeB::AlgorithmState<double> &>(state);
        constexpr double shortest  = 1e-12; // by rounding
        constexpr int    most      = 100;
        return state.gnorm > tolerance_ && state.iter < most && of_bounds.searchSize > shortest;
      }

    private:
      const double tolerance_;
    };

    ROL::ParameterList rol_parameters(const double first_radius)
    {
      ROL::ParameterList list;
      auto              &region = list.sublist("Step").sublist("Trust Region");
      region.set("Initial Radius", first_radius);
      region.set("Maximum Radius", 1e10);
      region.sublist("Lin-More").sublist("Cauchy Point").set("Normalize Initial Step Size", true);
      list.sublist("General").set("Output Level", 0);
      list.sublist("General").sublist("Krylov").set("Iteration Limit", 50);
      return list;
    }
  } // namespace

  namespace
  {
    /// Where a model is least in a box. @param from  where the way there begins
    Vector least_in_box(const LocalModel &model,
                        const Vector     &lower,
                        const Vector     &upper,
                        const Vector     &from,
                        const double      tolerance)
    {
      const double                         slope = length(model.gradient(from));
      ROL::ParameterList                   list  = rol_parameters(slope > 0. ? slope : 1.);
      ROL::TypeB::LinMoreAlgorithm<double> algorithm(list);
      algorithm.setStatusTest(ROL::makePtr<NearEnough>(list, tolerance));
      const auto           x = rol_vector(from);
      ROL::Problem<double> posed(ROL::makePtr<ModelForRol>(model), x);
      posed.addBoundConstraint(ROL::makePtr<ROL::Bounds<double>>(rol_vector(lower), rol_vector(upper)));
      ROL::nullstream silence;
      posed.finalize(false, false, silence);
      algorithm.run(posed, silence);
      return *x->getVector();
    }

    /// Relations as terms, stiff against what the model bends along them.
    std::vector<PenaltyTerm> terms_of_relations(const LocalModel &model, const BoundedProblem &problem)
    {
      std::vector<PenaltyTerm> terms;
      for (const LinearRelation &relation : problem.relations)
      {
        const double at_origin = relation.value(model.origin());
        const double stiff     = model.stiff_against(relation.weights);
        Vector       reversed(relation.weights.size(), 0.);
        add(-1., relation.weights, reversed);
        if (relation.is_equation())
          terms.push_back({at_origin - relation.lower, relation.weights, stiff});
        else
        {
          if (std::isfinite(relation.upper))
            terms.push_back({at_origin - relation.upper, relation.weights, stiff, true});
          if (std::isfinite(relation.lower))
            terms.push_back({relation.lower - at_origin, reversed, stiff, true});
        }
      }
      return terms;
    }
  } // namespace

  Vector least_of(const LocalModel     &model,
                  const BoundedProblem &problem,
                  const double          radius,
                  const double          tolerance)
  {
    const Vector &origin = model.origin();
    Vector        lower = problem.lower, upper = problem.upper;
    for (std::size_t j = 0; j < lower.size(); ++j)
    {
      lower[j] = std::max(lower[j], origin[j] - radius);
      upper[j] = std::min(upper[j], origin[j] + radius);
    }
    std::vector<PenaltyTerm> relations = terms_of_relations(model, problem);
    Vector                   x         = origin;
    // Rounds of an augmented Lagrangian: relations are linear and there are few, so some of them keep all.
    constexpr unsigned int most_rounds = 100;
    constexpr double       kept        = 1e-12; // in scales
    double                 worst       = std::numeric_limits<double>::infinity();
    for (unsigned int round = 0; round < most_rounds; ++round)
    {
      x                   = least_in_box(model.with(relations), lower, upper, x, tolerance);
      const Vector step   = difference(x, origin);
      const double before = std::exchange(worst, 0.);
      for (PenaltyTerm &relation : relations)
      {
        const double c      = c_at(relation, step);
        const double slope  = relation.slope(c);
        worst               = std::max(worst, std::abs(slope - relation.multiplier) / relation.curvature);
        relation.multiplier = slope;
      }
      if (worst <= kept)
        break;
      if (worst > 0.1 * before)
        for (PenaltyTerm &relation : relations)
          relation.curvature *= 4.;
    }
    return x;
  }

  std::vector<DifferenceCheck>
  check_derivative(const BoundedProblem &problem, const Vector &direction, const std::vector<double> &steps)
  {
    FunctionForRol               objective(problem);
    ROL::nullstream              silence;
    constexpr int                central = 2;
    std::vector<DifferenceCheck> rows;
    for (const std::vector<double> &row : objective.checkGradient(
           *rol_vector(problem.start), *rol_vector(direction), steps, false, silence, central))
      rows.push_back({row[0], row[1], row[2], row[3]});
    return rows;
  }
} // namespace retroforge
