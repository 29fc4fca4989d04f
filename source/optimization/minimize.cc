// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/optimization/minimize.h>

// The one file that knows ROL, whose headers take long to compile.
#include <ROL_Bounds.hpp>
#include <ROL_Constraint.hpp>
#include <ROL_Objective.hpp>
#include <ROL_ParameterList.hpp>
#include <ROL_Problem.hpp>
#include <ROL_StatusTest.hpp>
#include <ROL_StdVector.hpp>
#include <ROL_Stream.hpp>
#include <ROL_TypeB_LinMoreAlgorithm.hpp>
#include <ROL_lBFGS.hpp>

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

    Vector &numbers(ROL::Vector<double> &x)
    {
      return *dynamic_cast<ROL::StdVector<double> &>(x).getVector();
    }

    ROL::Ptr<ROL::StdVector<double>> rol_vector(const Vector &x)
    {
      return ROL::makePtr<ROL::StdVector<double>>(ROL::makePtr<Vector>(x));
    }
  } // namespace

  struct Minimizer::Learned
  {
    ROL::lBFGS<double> hessian{10};
    int                n_pairs = 0;
  };

  namespace
  {
    /// @param Learned  that of Minimizer
    template <typename Learned>
    class ProblemForRol : public ROL::Objective<double>
    {
    public:
      ProblemForRol(const BoundedProblem &problem, Learned &learned) : problem_(problem), learned_(learned) {}

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
        numbers(g) = problem_.gradient(numbers(x));
        if (!at_.empty() && !problem_.known_is_all)
          learn(numbers(x), numbers(g));
        at_       = numbers(x);
        gradient_ = numbers(g);
      }

      void hessVec(ROL::Vector<double>       &hv,
                   const ROL::Vector<double> &v,
                   const ROL::Vector<double> & /*x*/,
                   double & /*tolerance*/) override
      {
        hv.zero();
        if (!problem_.known_is_all)
          learned_.hessian.applyB(hv, v);
        if (problem_.known_hessian)
          hv.plus(*rol_vector(problem_.known_hessian(numbers(v))));
      }

    private:
      /// Of the change of the gradient over the last step, what the known part does not explain.
      void learn(const Vector &x, const Vector &g)
      {
        const auto step = rol_vector(x), change = rol_vector(g), none = rol_vector(x);
        step->axpy(-1., *rol_vector(at_));
        change->axpy(-1., *rol_vector(gradient_));
        if (problem_.known_hessian)
          change->axpy(-1., *rol_vector(problem_.known_hessian(*step->getVector())));
        none->zero();
        damp(*step, *change);
        if (step->norm() > 0.)
          learned_.hessian.updateStorage(
            *rol_vector(x), *change, *none, *step, step->norm(), ++learned_.n_pairs);
      }

      /// Powell's: the rest may bend downwards, and BFGS cannot; what nearly does would else be learned as
      /// the steepest of walls. @cite Nocedal and Wright 2006, procedure 18.2
      void damp(const ROL::StdVector<double> &step, ROL::StdVector<double> &change) const
      {
        const auto bent = rol_vector(*step.getVector());
        learned_.hessian.applyB(*bent, step);
        constexpr double least = 0.2;
        const double     sbs = step.dot(*bent), sy = step.dot(change);
        if (sy >= least * sbs)
          return;
        const double part = (1. - least) * sbs / (sbs - sy);
        change.scale(part);
        change.axpy(1. - part, *bent);
      }

      const BoundedProblem &problem_;
      Learned              &learned_;
      Vector                tried_, at_, gradient_;
    };

    /// The values  weights_i . x - origin_i  of some relations.
    class RelationsForRol : public ROL::Constraint<double>
    {
    public:
      explicit RelationsForRol(std::vector<LinearRelation> relations, const bool are_equations)
          : relations_(std::move(relations)), are_equations_(are_equations)
      {
      }

      void value(ROL::Vector<double> &c, const ROL::Vector<double> &x, double & /*tolerance*/) override
      {
        for (std::size_t i = 0; i < relations_.size(); ++i)
          numbers(c)[i] = relations_[i].value(numbers(x)) - (are_equations_ ? relations_[i].lower : 0.);
      }

      void applyJacobian(ROL::Vector<double>       &jv,
                         const ROL::Vector<double> &v,
                         const ROL::Vector<double> & /*x*/,
                         double & /*tolerance*/) override
      {
        for (std::size_t i = 0; i < relations_.size(); ++i)
          numbers(jv)[i] = relations_[i].value(numbers(v));
      }

      void applyAdjointJacobian(ROL::Vector<double>       &ajv,
                                const ROL::Vector<double> &v,
                                const ROL::Vector<double> & /*x*/,
                                double & /*tolerance*/) override
      {
        ajv.zero();
        for (std::size_t i = 0; i < relations_.size(); ++i)
          for (std::size_t j = 0; j < numbers(ajv).size(); ++j)
            numbers(ajv)[j] += numbers(v)[i] * relations_[i].weights[j];
      }

      void applyAdjointHessian(ROL::Vector<double> &ahuv,
                               const ROL::Vector<double> & /*u*/,
                               const ROL::Vector<double> & /*v*/,
                               const ROL::Vector<double> & /*x*/,
                               double & /*tolerance*/) override
      {
        ahuv.zero();
      }

    private:
      const std::vector<LinearRelation> relations_;
      const bool                        are_equations_;
    };

    /// Inequalities get a slack each, which ROL keeps between their bounds.
    void add_relations(const std::vector<LinearRelation> &relations, ROL::Problem<double> &problem)
    {
      std::vector<LinearRelation> equations, inequalities;
      Vector                      lower, upper;
      for (const LinearRelation &relation : relations)
      {
        (relation.is_equation() ? equations : inequalities).push_back(relation);
        if (relation.is_equation())
          continue;
        lower.push_back(relation.lower);
        upper.push_back(relation.upper);
      }
      if (!equations.empty())
        problem.addLinearConstraint("equations",
                                    ROL::makePtr<RelationsForRol>(equations, true),
                                    rol_vector(Vector(equations.size(), 0.)));
      if (!inequalities.empty())
        problem.addLinearConstraint("inequalities",
                                    ROL::makePtr<RelationsForRol>(inequalities, false),
                                    rol_vector(Vector(inequalities.size(), 0.)),
                                    ROL::Ptr<ROL::BoundConstraint<double>>(ROL::makePtr<ROL::Bounds<double>>(
                                      rol_vector(lower), rol_vector(upper))));
    }

    class AskedStatus : public ROL::StatusTest<double>
    {
    public:
      AskedStatus(ROL::ParameterList &list, const MinimizerSettings &settings)
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
      const MinimizerSettings &settings_;
    };

    /// For problems that are only looked at.
    struct NothingLearned
    {
      ROL::lBFGS<double> hessian{1};
      int                n_pairs = 0;
    };

    ROL::ParameterList rol_parameters(const MinimizerSettings &settings)
    {
      ROL::ParameterList list;
      auto              &region = list.sublist("Step").sublist("Trust Region");
      region.set("Initial Radius", settings.first_radius);
      region.set("Maximum Radius", settings.largest_radius);
      region.set("Use Radius Interpolation", false);
      // ROL adds this times the rounding of numbers to both reductions.
      region.set("Safeguard Size", std::max(100., settings.noise / std::numeric_limits<double>::epsilon()));
      region.sublist("Lin-More").sublist("Cauchy Point").set("Normalize Initial Step Size", true);
      auto &general    = list.sublist("General");
      auto &polyhedral = general.sublist("Polyhedral Projection");
      polyhedral.set("Type", "Dykstra");
      polyhedral.set("Absolute Tolerance", 1e-12);
      polyhedral.set("Relative Tolerance", 1e-12);
      general.set("Output Level", 0);
      general.sublist("Krylov").set("Iteration Limit", 10);
      return list;
    }
  } // namespace

  Minimizer::Minimizer() : learned_(std::make_unique<Learned>()) {}

  Minimizer::~Minimizer() = default;

  Vector Minimizer::minimize(const BoundedProblem &problem, const MinimizerSettings &settings)
  {
    ROL::ParameterList                   list = rol_parameters(settings);
    ROL::TypeB::LinMoreAlgorithm<double> algorithm(list);
    algorithm.setStatusTest(ROL::makePtr<AskedStatus>(list, settings));
    const auto           x = rol_vector(problem.start);
    ROL::Problem<double> posed(ROL::makePtr<ProblemForRol<Learned>>(problem, *learned_), x);
    posed.addBoundConstraint(
      ROL::makePtr<ROL::Bounds<double>>(rol_vector(problem.lower), rol_vector(problem.upper)));
    add_relations(problem.relations, posed);
    posed.setProjectionAlgorithm(list);
    ROL::nullstream silence;
    posed.finalize(false, false, silence);
    algorithm.run(posed, silence);
    return *x->getVector();
  }

  std::vector<DifferenceCheck>
  check_derivative(const BoundedProblem &problem, const Vector &direction, const std::vector<double> &steps)
  {
    NothingLearned               nothing;
    ProblemForRol                objective(problem, nothing);
    ROL::nullstream              silence;
    constexpr int                central = 2;
    std::vector<DifferenceCheck> rows;
    for (const std::vector<double> &row : objective.checkGradient(
           *rol_vector(problem.start), *rol_vector(direction), steps, false, silence, central))
      rows.push_back({row[0], row[1], row[2], row[3]});
    return rows;
  }
} // namespace retroforge
