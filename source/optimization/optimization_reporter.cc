// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/case/case_messages.h>
#include <retroforge/case/scene_estimate.h>
#include <retroforge/core/nearest_name.h>
#include <retroforge/geometry/stl_file.h>
#include <retroforge/mesh/whole_part.h>
#include <retroforge/optimization/design_text.h>
#include <retroforge/optimization/local_model.h>
#include <retroforge/optimization/optimization_reporter.h>
#include <retroforge/output/console.h>
#include <retroforge/output/mesh_files.h>
#include <retroforge/output/results_folder.h>
#include <retroforge/output/safe_file.h>
#include <retroforge/run/run_messages.h>
#include <retroforge/run/run_summary.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numeric>
#include <set>

namespace retroforge
{
  namespace
  {
    using Decision = TrialRow::Decision;

    /// Of a search that went on, whose designs may have had other numbers before.
    bool has_shapes(const std::string &base, const std::string &design, const bool with_record)
    {
      const std::string file = base + "_design.prm";
      return std::filesystem::exists(file) && read_file(file) == design &&
             (!with_record || std::filesystem::exists(base + "/header.h5"));
    }

    bool varies_billet(const DesignSpace &space)
    {
      for (std::size_t j = 0; j < space.size(); ++j)
        if (space.parameters()[j].kind == DesignParameter::Kind::billet &&
            space.lower()[j] < space.upper()[j])
          return true;
      return false;
    }

    /// A case's, at another design. @param mu  parameters of that case
    std::string parameters_at(const Case &forging_case, const std::vector<double> &mu)
    {
      CommandLine there = forging_case.command;
      there.case_text   = forging_case.echo;
      there.at.clear();
      there.overrides.emplace_back("Design/at", values_by_name(forging_case.design.parameters(), mu));
      std::string parameters;
      Parameters::read(there, parameters);
      return parameters;
    }
  } // namespace

  OptimizationReporter::OptimizationReporter(OptimizationProblem &problem, OptimizationResults &results)
      : problem_(problem), results_(results)
  {
  }

  void OptimizationReporter::prepare_folder()
  {
    MPI_Barrier(problem_.groups.all()); // all have read the journal before anything changes
    if (!problem_.is_root())
      return;
    const std::string &folder = problem_.main.command.output_directory;
    if (!problem_.resumes)
      make_results_folder(folder, problem_.main.command.overwrite, problem_.main.echo);
    make_directory(folder + "/designs");
    for (const char *file : {"optimisation.csv", "optimisation.json"})
      check_writable(problem_.path_of(file));
    for (std::size_t o = 0; o < problem_.scenarios.size(); ++o)
    {
      const std::string parameters = problem_.path_of(problem_.scenarios.titled("parameters", o) + ".prm");
      for (const std::string &file :
           {parameters, problem_.path_of(problem_.scenarios.titled("best", o) + ".prm")})
        check_writable(file);
      write_file(parameters, problem_.scenarios.at(o).echo);
    }
    problem_.journal.write_to(problem_.path_of("journal.jsonl"));
  }

  void OptimizationReporter::begin() const
  {
    std::set<std::string> warnings; // of scenarios that share a setting, once
    for (std::size_t o = 0; o < problem_.scenarios.size(); ++o)
      for (const std::string &warning : estimate_scene(problem_.scenarios.at(o)).warnings)
        warnings.insert(warning);
    if (!problem_.is_root())
      return;
    print_begin(problem_.main);
    print_warnings({warnings.begin(), warnings.end()});
    print_search();
  }

  void OptimizationReporter::print_search() const
  {
    std::printf("optimisation of %s by %zu parameter(s), %zu limit(s)\n",
                problem_.criteria.objective.name.c_str(),
                varied_parameters(problem_.main).size(),
                problem_.criteria.limits.size());
    print_part(whole_part(problem_.main.billet, problem_.main.nominal.leading_velocity()));
    if (problem_.criteria.objective.unit == "mixed")
      std::printf("  note: it adds objectives of different units, by their weights\n");
    if (const auto &held = problem_.space.held(); held && varies_billet(problem_.space))
      std::printf("  %s follows from the volume%s\n",
                  held->name.c_str(),
                  std::isinf(held->lower) && std::isinf(held->upper)
                    ? "; it has no bounds (Optimisation/lower bounds, upper bounds)"
                    : "");
    for (const LinearRelation &relation : problem_.space.relations())
      std::printf("  every design keeps %s\n", relation.text.c_str());
    if (!problem_.scatter.empty())
      std::printf("  each design is forged %zu times, with %s from %.6g to %.6g\n",
                  problem_.scatter.n_samples(),
                  problem_.parameters().scattered.c_str(),
                  problem_.parameters().scatter_range[0],
                  problem_.parameters().scatter_range[1]);
    print_unscattered();
    for (const auto &[name, parameters] : results_.operations)
      std::printf("  each design is forged in operation %s, too, which has its %s\n",
                  name.c_str(),
                  join(parameters).c_str());
    if (problem_.groups.n() > 1)
      std::printf("  by %u groups of ranks side by side\n", problem_.groups.n());
    if (problem_.journal.size() > 0)
      std::printf("  %zu designs are forged already, and taken from the journal\n", problem_.journal.size());
    for (std::size_t o = 0; o < problem_.objectives.size(); ++o)
      if (problem_.criteria.objective.weights[o] == 0. && !problem_.criteria.uses(o))
        std::printf("  note: %s is only watched\n", problem_.objectives[o].name.c_str());
    std::fflush(stdout);
  }

  void OptimizationReporter::print_unscattered() const
  {
    const OptimizationParameters &optimization = problem_.parameters();
    for (std::size_t j = 0; j < problem_.space.size() && !problem_.scatter.empty(); ++j)
      if (problem_.space.parameters()[j].name == optimization.scattered &&
          !(problem_.main.mu[j] >= optimization.scatter_range[0] &&
            problem_.main.mu[j] <= optimization.scatter_range[1]))
        std::printf("  note: the case itself has %s = %.6g, outside of that range; best.prm has it, too\n",
                    optimization.scattered.c_str(),
                    problem_.main.mu[j]);
  }

  void OptimizationReporter::note_flat_start() const
  {
    const std::vector<double> slopes = problem_.criteria.slopes(results_.start.values);
    for (std::size_t o = 0; o < slopes.size(); ++o)
      for (std::size_t j = 0; j < problem_.space.size(); ++j)
        if (problem_.space.at(results_.start.mu, j) != DesignSpace::At::fixed &&
            slopes[o] * results_.start.gradients[o][j] != 0.)
          return;
    if (problem_.is_root())
      std::printf("  note: at the start %s does not depend on any parameter that is varied\n",
                  problem_.criteria.objective.name.c_str());
  }

  void OptimizationReporter::print(const std::vector<DifferenceCheck> &rows) const
  {
    if (!problem_.is_root())
      return;
    std::printf("  gradient along a direction, against differences of forgings that decide all but their "
                "increments anew:\n"
                "  step [scales]    derivative    difference    relative error\n");
    for (const DifferenceCheck &row : rows)
      std::printf("  %-12.3g %14.7g %13.7g %12.2g\n",
                  row.step,
                  row.derivative,
                  row.difference,
                  row.error / std::abs(row.derivative));
    std::fflush(stdout);
  }

  void OptimizationReporter::print_noise(const Evaluation &at) const
  {
    if (!problem_.is_root())
      return;
    const double value = problem_.criteria.value(at.values);
    std::printf("  noise: %.3g%s%s",
                results_.noise.objective,
                problem_.criteria.objective.unit.empty() ? "" : " ",
                problem_.criteria.objective.unit.c_str());
    // A misfit that begins near 0 has nothing to be compared with.
    if (value != 0. && problem_.criteria.data.empty())
      std::printf(", %.2g of the value", results_.noise.objective / std::abs(value));
    std::printf("\n");
    // Of a limit in it, steps that bring it nearer cannot be told from those that do not.
    for (const Limit &limit : problem_.criteria.limits)
    {
      const std::vector<double> slope = problem_.space.pull_back(at.gradients[limit.objective]);
      const double change = std::sqrt(std::inner_product(slope.begin(), slope.end(), slope.begin(), 0.)) *
                            problem_.parameters().first_step;
      const double      noise = results_.noise.values[limit.objective];
      const std::string unit  = after_number(results_.units[limit.objective]);
      if (noise > change && limit.excess(at.values) * limit.size > -noise)
        std::printf(
          "  noise of %s: %.3g%s, more than a first step changes it by (%.2g%s): finer elements have less, "
          "and a longer Optimisation/first step sees more\n",
          results_.objectives[limit.objective].c_str(),
          noise,
          unit.c_str(),
          change,
          unit.c_str());
    }
  }

  void OptimizationReporter::print_line(const std::string &line) const
  {
    if (!problem_.is_root())
      return;
    std::printf("  %s\n", line.c_str());
    std::fflush(stdout);
  }

  void OptimizationReporter::add_row(const unsigned int n_iterations) const
  {
    if (!problem_.is_root())
      return;
    print_row(results_.rows.back(), n_iterations);
    write_results();
  }

  void OptimizationReporter::print_row(const TrialRow &row, const unsigned int n_iterations) const
  {
    const Evaluation &evaluation = row.evaluation;
    std::printf("%5zu  %-9s", results_.rows.size() - 1, in_words(row.decision, evaluation.failed()).c_str());
    if (evaluation.failed())
      std::printf("in increment %u: %s", evaluation.increments + 1, evaluation.failure.c_str());
    else
    {
      std::printf("%.7g %s", results_.value(evaluation), problem_.criteria.objective.unit.c_str());
      for (const Limit &limit : problem_.criteria.limits)
        std::printf(", %s %.6g (%s %.6g)",
                    results_.objectives[limit.objective].c_str(),
                    evaluation.values[limit.objective],
                    limit.at_least ? "at least" : "at most",
                    limit.bound - limit.correction);
    }
    if (row.decision == Decision::accepted || row.decision == Decision::refused)
      std::printf("  radius %.3g", row.radius);
    if (!evaluation.steps.empty())
      std::printf("  %u increments, which others repeat", evaluation.increments);
    std::printf("  %.1f s", evaluation.seconds);
    if (problem_.evaluator.seconds_each() > 0.)
      std::printf(", at most %.0f s left",
                  problem_.evaluator.seconds_each() * most_forgings_left(n_iterations));
    std::printf("\n");
    std::fflush(stdout);
  }

  unsigned int OptimizationReporter::most_forgings_left(const unsigned int n_iterations) const
  {
    const auto left = [](const unsigned int most, const unsigned int done) {
      return most > done ? most - done : 0;
    };
    const OptimizationParameters &most = problem_.parameters();
    const auto n_noisy = std::count_if(results_.rows.begin(), results_.rows.end(), [](const TrialRow &row) {
      return row.decision == TrialRow::Decision::noise;
    });
    // At the start, and where the search ends.
    const unsigned int designs = left(most.iterations, n_iterations) + left(2 * most.noise_runs, n_noisy);
    return std::min(left(most.simulations, problem_.evaluator.n_asked()),
                    designs * problem_.evaluator.n_forgings(problem_.main.mu));
  }

  void OptimizationReporter::write_shapes(const Evaluation &evaluation, const std::string &name)
  {
    for (std::size_t o = 0; o < problem_.scenarios.size(); ++o)
      write_shapes_of(o, evaluation.mu, name);
  }

  void OptimizationReporter::write_shapes_of(const std::size_t          scenario,
                                             const std::vector<double> &mu,
                                             const std::string         &name)
  {
    // The group that has the middle sample in memory writes it.
    const Case       &forging_case = problem_.scenarios.at(scenario);
    const std::string base         = problem_.path_of("designs/" + problem_.scenarios.titled(name, scenario));
    const bool        writes       = dealii::Utilities::MPI::this_mpi_process(problem_.main.comm) == 0;
    const std::string design       = as_parameters(values_by_name(forging_case.design.parameters(), mu),
                                             scenario == 0 ? problem_.meshes.made_at() : "");
    const bool        there        = dealii::Utilities::MPI::broadcast(
      problem_.main.comm,
      writes && name != "best" && has_shapes(base, design, problem_.parameters().keep_records),
      0);
    const ForwardRun *forged = there ? nullptr : problem_.evaluator.forged(mu, scenario);
    if (forged == nullptr)
      return;
    const ForwardRun &run = *forged;
    if (name == "best")
    {
      if (scenario == 0)
        results_.warnings.clear();
      const std::string of = scenario == 0 ? "" : problem_.scenarios.name(scenario) + ": ";
      for (const auto &told : {run.check(), warnings_at_end(forging_case, run)})
        for (const std::string &warning : told)
          results_.warnings.push_back(of + warning);
    }
    if (name == "best" && scenario == 0)
    {
      results_.details.clear();
      for (const ObjectiveTrace::Evaluation &evaluation : run.evaluations()) // by all ranks of the group
        results_.details.push_back(evaluation.details);
    }
    if (!writes)
      return;
    if (problem_.parameters().keep_records)
      run.write_record(base, parameters_at(forging_case, problem_.evaluator.middle_sample(mu, scenario)));
    write_msh(base + "_billet.msh", forging_case.billet, run.X_0());
    write_boundary_stl(base + "_billet.stl", forging_case.billet, run.X_0());
    write_boundary_stl(base + "_forged.stl", run.state().epoch->scene.mesh, run.state().workpiece.X);
    for (const Die &die : run.dies())
      if (die.surface())
        write_stl(base + "_die_" + die.name + ".stl", *die.surface(), StlFormat::binary);
    write_file(base + "_design.prm", design); // when all of it is there
  }

  void OptimizationReporter::write_results() const
  {
    results_.write_csv(problem_.path_of("optimisation.csv"));
    results_.write_json(problem_.path_of("optimisation.json"));
    for (std::size_t o = 0; o < problem_.scenarios.size(); ++o)
    {
      const Case                                      &forging_case = problem_.scenarios.at(o);
      const std::vector<double>                        mu = problem_.scenarios.values(o, results_.best.mu);
      std::vector<std::pair<std::string, std::string>> repeated;
      // With them it is forged to the same bits.
      if (const Evaluation *steps = problem_.journal.find_steps(problem_.scenarios.name(o));
          steps && steps->mu != mu)
      {
        const std::string file = problem_.scenarios.titled("steps", o) + ".csv";
        write_file(problem_.path_of(file), table_of_steps(steps->steps));
        repeated.emplace_back("Press/steps", file);
      }
      write_file(problem_.path_of(problem_.scenarios.titled("best", o) + ".prm"),
                 Parameters::seen_from(
                   problem_.main.command.output_directory, parameters_at(forging_case, mu), repeated));
    }
  }
} // namespace retroforge
