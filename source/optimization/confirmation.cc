// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/text.h>
#include <retroforge/optimization/confirmation.h>
#include <retroforge/optimization/design_text.h>
#include <retroforge/optimization/journal_rules.h>

#include <cmath>
#include <cstdio>

namespace retroforge
{
  namespace
  {
    /// With elements and increments a part as large.
    CommandLine finer(const Case &forging_case, const double part)
    {
      CommandLine command = forging_case.command;
      command.case_text   = forging_case.echo;
      const auto set      = [&](const std::string &path, const double value) {
        command.overrides.emplace_back(path, exact(value));
      };
      set("Billet/element size", part * forging_case.parameters.billet.element_size);
      if (forging_case.parameters.remeshing.element_size > 0.)
        set("Remeshing/element size", part * forging_case.parameters.remeshing.element_size);
      command.overrides.emplace_back("Press/steps", ""); // they belong to the coarser mesh
      const PressParameters &press = forging_case.parameters.press;
      if (press.largest_strain)
        set("Press/accuracy", std::max(press.accuracy * part * part, 1e-6));
      else
        set("Press/increments", std::ceil(press.increments / part - 1e-9));
      return command;
    }

    /// Why the optimum is not forged on finer meshes; empty where it is.
    std::string no_finer_mesh(const Scenarios &scenarios)
    {
      const std::string mode = "billet/free form ";
      for (std::size_t o = 0; o < scenarios.size(); ++o)
      {
        if (scenarios.at(o).parameters.billet.is_from_file())
          return "a billet from a file has no finer mesh";
        for (const DesignParameter &parameter : scenarios.at(o).design.parameters())
          if (parameter.name.rfind(mode, 0) == 0)
            return "the modes of a free form belong to their mesh";
      }
      return "";
    }

    /// The scenarios with smaller elements and increments.
    struct FinerScenarios
    {
      FinerScenarios(const OptimizationProblem &problem, const double part)
      {
        const CommandLine command = finer(problem.main, part);
        at_start                  = make_case(command, "", problem.main.comm);
        // The best design on a mesh made where that of the search was.
        if (problem.meshes.number() > 0)
          at_best = make_case(command, problem.meshes.made_at(), problem.main.comm);
        std::vector<CommandLine> others;
        for (std::size_t o = 1; o < problem.scenarios.size(); ++o)
          others.push_back(finer(problem.scenarios.at(o), part));
        scenarios = std::make_unique<Scenarios>(*at_start, others, timings);
      }

      Timings                     timings;
      std::unique_ptr<const Case> at_start, at_best; ///< null: the same mesh
      std::unique_ptr<Scenarios>  scenarios;
    };
  } // namespace

  std::optional<Confirmation> confirm(const OptimizationProblem                      &problem,
                                      const std::vector<double>                      &start,
                                      const std::vector<double>                      &best,
                                      const bool                                      goes_on,
                                      const std::function<void(const std::string &)> &tell)
  {
    const double part = problem.parameters().confirmation;
    if (part == 0.)
      return {};
    if (const std::string reason = no_finer_mesh(problem.scenarios); !reason.empty())
    {
      tell("not confirmed: " + reason);
      return {};
    }
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", part);
    tell("confirming with elements and increments " + std::string(text) + " times as large ...");
    const std::string             file = problem.path_of("confirmation.jsonl");
    std::optional<FinerScenarios> fine;
    std::optional<Journal>        journal;
    try
    {
      fine.emplace(problem, part);
      journal = confirmation_journal(*fine->scenarios, file, goes_on);
    }
    catch (const Error &error)
    {
      // What was found must not be lost with it.
      tell(std::string("not confirmed: ") + error.what());
      return {};
    }
    MPI_Barrier(problem.groups.all());
    if (problem.is_root())
      journal->write_to(file);
    const auto evaluate = [&](const std::vector<double> &mu) {
      Evaluator evaluator(*fine->scenarios, *journal, problem.scatter, problem.groups);
      return problem.with_held(fine->scenarios->at(0).design, evaluator.evaluate(mu));
    };
    const Evaluation at_start = evaluate(start);
    if (fine->at_best)
    {
      fine->scenarios->use_main(*fine->at_best);
      journal->use_mesh(problem.meshes.made_at());
    }
    return Confirmation{at_start, evaluate(best), fine->scenarios->at(0).billet.n_nodes()};
  }
} // namespace retroforge
