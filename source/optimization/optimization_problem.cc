// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/optimization/journal_rules.h>
#include <retroforge/optimization/optimization_problem.h>

#include <algorithm>

namespace retroforge
{
  namespace
  {
    unsigned int n_groups(const CommandLine &command)
    {
      std::string ignored;
      return Parameters::read(command, ignored).optimization.side_by_side;
    }

    /// A journal, not a record, is what an optimisation goes on with.
    CommandLine without_resume(CommandLine command)
    {
      command.resume = false;
      return command;
    }

    /// That of the objectives; and where the parameter that follows from the volume may go.
    Criteria criteria_of(const Objectives             &objectives,
                         const OptimizationParameters &parameters,
                         const DesignSpace            &space)
    {
      Criteria criteria(objectives, parameters);
      if (const auto &held = space.held())
        criteria.add_value(held->lower, held->upper);
      return criteria;
    }

    /// Objectives that may not be smaller than a limit. @param names  of all
    std::vector<bool>
    from_below(const Criteria &criteria, const std::vector<std::string> &names, const bool is_scattered)
    {
      std::vector<bool> below(names.size(), false);
      for (const Limit &limit : criteria.limits)
        if (limit.at_least)
          below[limit.objective] = true;
      for (std::size_t o = 0; o < below.size() && is_scattered; ++o)
        if (below[o] && (criteria.objective.weights[o] != 0. ||
                         std::any_of(criteria.limits.begin(), criteria.limits.end(), [o](const Limit &limit) {
                           return limit.objective == o && !limit.at_least;
                         })))
          throw Error(
            "Optimisation/at least",
            "limits '" + names[o] + "', which is also made small or limited from above",
            "with a scattered parameter an objective counts as mean + lambda sigma, or under a lower "
            "limit as mean - lambda sigma, not as both",
            "name a second objective of the same type for the lower limit");
      return below;
    }
  } // namespace

  OptimizationProblem::OptimizationProblem(const CommandLine &command, MPI_Comm comm)
      : resumes(command.resume)
      , groups(comm, n_groups(command), "Optimisation/side by side")
      , main(without_resume(command), timings_, groups.comm())
      , scenarios(main, commands_of_scenarios(main), timings_)
      , objectives(scenarios.objectives())
      , space(main.design.parameters(), varied_parameters(main), main.mu, parameters(), main.design.held())
      , criteria(criteria_of(objectives, parameters(), space))
      , scatter(main.design.parameters(),
                parameters(),
                from_below(criteria, names(), !parameters().scattered.empty()))
      , journal(resumes ? resumed_journal(scenarios) : Journal(journal_header(scenarios)))
      , meshes(main, parameters().mesh_quality)
      , evaluator(scenarios, journal, scatter, groups)
  {
    check_start();
  }

  void OptimizationProblem::check_start() const
  {
    Timings timings;
    for (std::size_t o = 0; o < scenarios.size(); ++o)
    {
      const Case               &forging_case = scenarios.at(o);
      const std::vector<double> mu           = scenarios.values(o, main.mu);
      for (std::size_t i = 0; i < scatter.n_samples(); ++i)
        forging_case.design.check_values(scenarios.values(o, scatter.sample(main.mu, i)));
      ForwardRun(forging_case,
                 forging_case.design.process(mu),
                 forging_case.design.positions(mu),
                 ForwardRun::Keep::nothing,
                 timings)
        .check();
    }
  }

  std::vector<std::string> OptimizationProblem::names() const
  {
    std::vector<std::string> names;
    for (const NamedObjective &objective : objectives)
      names.push_back(objective.name);
    if (space.held())
      names.push_back(space.held()->name);
    return names;
  }

  std::vector<std::string> OptimizationProblem::units() const
  {
    std::vector<std::string> units;
    for (const NamedObjective &objective : objectives)
      units.push_back(objective.unit());
    if (space.held())
      units.push_back(space.held()->unit);
    return units;
  }

  Evaluation OptimizationProblem::evaluate(const std::vector<double> &mu)
  {
    return with_held(scenarios.at(0).design, evaluator.evaluate(mu));
  }

  Evaluation OptimizationProblem::differentiate(const std::vector<double> &mu)
  {
    return with_held(scenarios.at(0).design, evaluator.differentiate(mu));
  }

  Evaluation OptimizationProblem::with_held(const Design &design, Evaluation evaluation) const
  {
    if (!space.held() || evaluation.failed())
      return evaluation;
    evaluation.values.push_back(design.held_value(evaluation.mu));
    if (!evaluation.gradients.empty())
      evaluation.gradients.push_back(design.held_gradient(evaluation.mu));
    return evaluation;
  }

  void OptimizationProblem::forge_on(const Case &forging_case, const std::string &made_at)
  {
    journal.use_mesh(made_at);
    scenarios.use_main(forging_case);
    evaluator.renew_main();
  }

  std::vector<double> OptimizationProblem::lagrangian_slopes(const Evaluation          &at,
                                                             const std::vector<double> &multipliers) const
  {
    std::vector<double> by_objective = criteria.slopes(at.values), by_mu(space.size(), 0.);
    for (std::size_t i = 0; i < criteria.limits.size(); ++i)
      by_objective[criteria.limits[i].objective] += multipliers[i] * criteria.limits[i].slope();
    for (std::size_t o = 0; o < by_objective.size(); ++o)
      for (std::size_t j = 0; j < by_mu.size(); ++j)
        by_mu[j] += by_objective[o] * at.gradients[o][j];
    return by_mu;
  }

  std::vector<std::string> varied_parameters(const Case &main)
  {
    std::vector<std::string> names;
    for (const std::string &name : main.design.expanded(main.parameters.design.names))
      if (name != main.parameters.optimization.scattered)
        names.push_back(name);
    return names;
  }
} // namespace retroforge
