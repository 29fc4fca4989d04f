// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/optimisation/minimise.h>

// The one file that knows ROL, whose headers take long to compile.
#include <ROL_Bounds.hpp>
#include <ROL_Objective.hpp>
#include <ROL_ParameterList.hpp>
#include <ROL_StatusTest.hpp>
#include <ROL_StdVector.hpp>
#include <ROL_Stream.hpp>
#include <ROL_TypeB_LinMoreAlgorithm.hpp>

#include <limits>

namespace retroforge
{
  namespace
  {
    using Vector = BoundedProblem::Vector;

    const Vector &numbers(const ROL::Vector<double> &x)
    {
      return *dynamic_cast<const ROL::StdVector<double> &>(x).getVector();
    }

    class ProblemForRol : public ROL::Objective<double>
    {
    public:
      explicit ProblemForRol(const BoundedProblem &problem) : problem_(problem) {}

      void update(const ROL::Vector<double> &x, const ROL::UpdateType type, const int /*iteration*/) override
      {
        if (type == ROL::UpdateType::Trial)
          tried_ = numbers(x);
        else if (type == ROL::UpdateType::Accept || type == ROL::UpdateType::Revert)
          problem_.decided(tried_, type == ROL::UpdateType::Accept);
      }

      double value(const ROL::Vector<double> &x, double & /*tolerance*/) override
      {
        return problem_.value(numbers(x));
      }

      void gradient(ROL::Vector<double> &g, const ROL::Vector<double> &x, double & /*tolerance*/) override
      {
        *dynamic_cast<ROL::StdVector<double> &>(g).getVector() = problem_.gradient(numbers(x));
      }

      void hessVec(ROL::Vector<double>       &hv,
                   const ROL::Vector<double> &v,
                   const ROL::Vector<double> & /*x*/,
                   double & /*tolerance*/) override
      {
        *dynamic_cast<ROL::StdVector<double> &>(hv).getVector() = problem_.hessian(numbers(v));
      }

    private:
      const BoundedProblem &problem_;
      Vector                tried_;
    };

    class AskedStatus : public ROL::StatusTest<double>
    {
    public:
      AskedStatus(ROL::ParameterList &list, const MinimiserSettings &settings)
          : ROL::StatusTest<double>(list), settings_(settings)
      {
      }

      bool check(ROL::AlgorithmState<double> &state) override
      {
        const auto &of_bounds = static_cast<const ROL::TypeB::AlgorithmState<double> &>(state);
        return settings_.go_on(
          {static_cast<unsigned int>(state.iter), state.value, state.gnorm, of_bounds.searchSize});
      }

    private:
      const MinimiserSettings &settings_;
    };

    ROL::Ptr<ROL::StdVector<double>> rol_vector(const Vector &x)
    {
      return ROL::makePtr<ROL::StdVector<double>>(ROL::makePtr<Vector>(x));
    }

    ROL::ParameterList rol_parameters(const MinimiserSettings &settings, const bool knows_hessian)
    {
      ROL::ParameterList list;
      auto              &region = list.sublist("Step").sublist("Trust Region");
      region.set("Initial Radius", settings.first_radius);
      region.set("Maximum Radius", settings.largest_radius);
      region.set("Use Radius Interpolation", false);
      // ROL adds this times the rounding of numbers to both reductions.
      region.set("Safeguard Size", std::max(100., settings.noise / std::numeric_limits<double>::epsilon()));
      region.sublist("Lin-More").sublist("Cauchy Point").set("Normalize Initial Step Size", true);
      auto &general = list.sublist("General");
      general.set("Output Level", 0);
      general.sublist("Krylov").set("Iteration Limit", 10);
      general.sublist("Secant").set("Type", "Limited-Memory BFGS");
      general.sublist("Secant").set("Maximum Storage", 10);
      general.sublist("Secant").set("Use as Hessian", !knows_hessian);
      return list;
    }
  } // namespace

  Vector minimise(const BoundedProblem &problem, const MinimiserSettings &settings)
  {
    ROL::ParameterList                   list = rol_parameters(settings, problem.hessian != nullptr);
    ROL::TypeB::LinMoreAlgorithm<double> algorithm(list);
    algorithm.setStatusTest(ROL::makePtr<AskedStatus>(list, settings));
    const auto          x = rol_vector(problem.start);
    ProblemForRol       objective(problem);
    ROL::Bounds<double> bounds(rol_vector(problem.lower), rol_vector(problem.upper));
    ROL::nullstream     silence;
    algorithm.run(*x, objective, bounds, silence);
    return *x->getVector();
  }
} // namespace retroforge
