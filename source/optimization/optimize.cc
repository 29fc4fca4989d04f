// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/interrupt_message.h>
#include <retroforge/optimization/noise_estimate.h>
#include <retroforge/optimization/optimize.h>

#include <cstdio>
#include <iostream>
#include <utility>

namespace retroforge
{
  namespace
  {
    using Decision = TrialRow::Decision;
    using Stop     = SearchStop;
  } // namespace

  Optimize::Optimize(const CommandLine &command, MPI_Comm comm)
      : problem_(command, comm)
      , results_{problem_.space, problem_.criteria, problem_.names(), problem_.units()}
      , reporter_(problem_, results_)
      , search_(problem_.space, problem_.criteria, problem_.parameters(), search_task())
  {
    results_.counted_as      = problem_.scatter.in_words();
    results_.limit_tolerance = problem_.parameters().limit_tolerance;
    for (std::size_t o = 1; o < problem_.scenarios.size(); ++o)
      results_.operations[problem_.scenarios.name(o)] = problem_.scenarios.common(o);
  }

  int Optimize::run()
  {
    reporter_.prepare_folder();
    reporter_.begin();
    if (problem_.is_root())
      set_interrupt_message(
        "stopped; the same command with --resume goes on with the designs that are forged");
    begin();
    if (problem_.main.command.check)
      reporter_.print(search_.check());
    measure_noise();
    search();
    confirm(problem_.resumes);
    for (unsigned int n_corrections = 0; results_.misses_there(); ++n_corrections)
    {
      results_.not_corrected = why_not_corrected(n_corrections);
      if (!results_.not_corrected.empty())
        break;
      const std::vector<Limit> before = problem_.criteria.limits;
      correct_limits();
      if (!search())
      {
        problem_.criteria.limits = before;
        results_.not_corrected   = "a search with it corrected was cut off, " + in_words(search_.stop()) +
                                 "; --resume with more goes on";
        break;
      }
      confirm(true);
    }
    if (problem_.is_root())
    {
      reporter_.write_results();
      results_.print(std::cout);
      std::cout << "  results in " << problem_.main.command.output_directory << std::endl;
    }
    return results_.exit_status();
  }

  SearchTask Optimize::search_task()
  {
    SearchTask task;
    task.evaluate      = [&](const std::vector<double> &mu) { return problem_.evaluate(mu); };
    task.differentiate = [&](const std::vector<double> &mu) { return problem_.differentiate(mu); };
    task.n_evaluated   = [&] { return problem_.evaluator.n_asked(); };
    task.mesh_is_bad   = [&](const Evaluation &now) { return mesh_is_bad(now); };
    task.renew_mesh    = [&](const Evaluation &now) { return renew_mesh(now); };
    task.decided       = [&](const Evaluation &evaluation, const bool accepted) {
      problem_.meshes.tell(evaluation.mu, accepted, evaluation.failed());
      if (accepted)
        reporter_.write_shapes(evaluation, "trial_" + std::to_string(results_.rows.size()));
      add_row(accepted ? Decision::accepted : Decision::refused, evaluation, search_.radius());
    };
    task.renewed = [&](const double excess) {
      if (!problem_.is_root())
        return;
      std::printf("  limits exceeded by %.2g at most; multipliers renewed:", excess);
      const std::vector<double> multipliers = search_.multipliers();
      for (std::size_t i = 0; i < multipliers.size(); ++i)
        std::printf("%s %s %.4g",
                    i == 0 ? "" : ",",
                    results_.objectives[problem_.criteria.limits[i].objective].c_str(),
                    multipliers[i]);
      std::printf("\n");
    };
    return task;
  }

  bool Optimize::mesh_is_bad(const Evaluation &now)
  {
    const bool is_due = problem_.meshes.due(now.mu);
    if (!is_due && !problem_.meshes.complaint().empty())
      reporter_.print_line("mesh not made anew: " + problem_.meshes.complaint());
    return is_due;
  }

  std::optional<Evaluation> Optimize::renew_mesh(const Evaluation &now)
  {
    DesignMeshManager &meshes = problem_.meshes;
    NewMesh            mesh;
    mesh.made_at        = meshes.candidate().made_at;
    mesh.quality_before = meshes.quality(now.mu);
    mesh.volume_before  = meshes.volume_at(now.mu);
    mesh.before         = now.values;
    problem_.forge_on_candidate();
    Evaluation again = problem_.evaluate(now.mu);
    if (again.failed())
    {
      reporter_.print_line("mesh not made anew: on it the same design fails: " + again.failure);
      problem_.forge_on_present();
      meshes.refuse_candidate(now.mu);
      return {};
    }
    meshes.use_candidate();
    again              = problem_.differentiate(now.mu);
    mesh.quality_after = meshes.quality(now.mu);
    mesh.volume_after  = meshes.volume_at(now.mu);
    mesh.after         = again.values;
    mesh.n_nodes       = meshes.now().billet.n_nodes();
    mesh.row           = results_.rows.size();
    results_.meshes.push_back(mesh);
    if (problem_.is_root())
      results_.print(results_.meshes.back(), std::cout);
    reporter_.write_shapes(again, "trial_" + std::to_string(mesh.row));
    add_row(Decision::renewed, again, search_.radius());
    return again;
  }

  void Optimize::begin()
  {
    const Evaluation start = problem_.evaluate(problem_.main.mu);
    if (start.failed())
      throw Error("optimize",
                  "cannot forge the design it begins with, in increment " +
                    std::to_string(start.increments + 1) + ": " + start.failure,
                  "the first design must succeed",
                  "begin elsewhere with --at, or cure what the message says");
    results_.start = results_.best = problem_.differentiate(problem_.main.mu);
    problem_.criteria.set_sizes(results_.start.values);
    search_.begin(results_.start);
    reporter_.note_flat_start();
    add_row(Decision::start, results_.start, search_.radius());
    reporter_.write_shapes(results_.start, "start");
  }

  bool Optimize::measure_noise()
  {
    const std::size_t n_rows = results_.rows.size();
    const Evaluation &at     = search_.now();
    const Noise       noise =
      retroforge::measure_noise(problem_, at, [&](const Evaluation &evaluation, const double radius) {
        add_row(Decision::noise, evaluation, radius);
      });
    if (noise.n_designs > 0)
    {
      results_.noise = noise;
      search_.set_noise(noise.objective, noise.values);
      reporter_.print_noise(at);
    }
    return results_.rows.size() - n_rows == problem_.parameters().noise_runs;
  }

  Optimize::SearchEnd Optimize::run_search()
  {
    const SearchEnd end{search_.run(), search_.stop()};
    if (results_.goes_on || end.stop != Stop::noise || problem_.parameters().noise_runs == 0 ||
        search_.now().mu == results_.start.mu)
      return end;
    // The noise of a sum of squares falls with it, and at the start a decision of the program may have been near.
    constexpr double much_less = 0.5;
    const double     before    = search_.noise();
    reporter_.print_line("no step promises more than the noise of the start; it is measured again here");
    if (!measure_noise())
      return {false, Stop::simulations}; // what hides the way is not known
    if (search_.noise() >= much_less * before)
      return end;
    reporter_.print_line("that is less than half as much as at the start: the search goes on");
    return {search_.run(), search_.stop()};
  }

  Evaluation Optimize::best_so_far() const
  {
    const double tolerance = problem_.parameters().limit_tolerance;
    const auto   is_better = [&](const Evaluation &a, const Evaluation &b) {
      const double excess_a = std::max(tolerance, problem_.criteria.largest_excess(a.values)),
                   excess_b = std::max(tolerance, problem_.criteria.largest_excess(b.values));
      return excess_a < excess_b || (excess_a == excess_b && results_.value(a) < results_.value(b));
    };
    std::optional<Evaluation> best;
    for (const TrialRow &row : results_.rows)
      if (row.mesh == problem_.meshes.number() && row.becomes_the_next() &&
          (!best || is_better(row.evaluation, *best)))
        best = row.evaluation;
    return *best;
  }

  bool Optimize::search()
  {
    results_.goes_on       = results_.confirmation.has_value();
    const SearchEnd end    = run_search();
    const bool      is_cut = end.stop == Stop::iterations || end.stop == Stop::simulations;
    if (std::exchange(results_.goes_on, false) && is_cut)
      return false;
    results_.confirmation.reset();
    results_.stop = end.stop;
    // A limit's optimum is the last design, not the least one within its tolerance.
    results_.best = end.settled ? search_.now() : best_so_far();
    report_best();
    if (problem_.is_root())
      reporter_.write_results(); // the confirmation is the longest forging, and may be stopped
    return true;
  }

  void Optimize::confirm(const bool goes_on)
  {
    results_.confirmation = retroforge::confirm(
      problem_, results_.start.mu, results_.best.mu, goes_on, [&](const std::string &line) {
        reporter_.print_line(line);
      });
  }

  std::string Optimize::why_not_corrected(const unsigned int n_corrections) const
  {
    // What misses limits by their noise only is as near to them as a search comes.
    const bool is_there   = results_.missed_only_by_noise() && results_.stop == Stop::limits;
    const bool is_cut_off = results_.stop == Stop::iterations || results_.stop == Stop::simulations;
    if (is_cut_off && !is_there)
      return "it was cut off, " + in_words(results_.stop) + "; --resume with more goes on";
    if (!results_.limits_are_kept() && !is_there)
      return "it did not keep its limits itself";
    if (!results_.has_converged() && !is_there)
      return "it had not come to its end, " + in_words(results_.stop);
    if (n_corrections == problem_.parameters().corrections)
      return "Optimisation/corrections is " + std::to_string(n_corrections);
    return "";
  }

  void Optimize::correct_limits()
  {
    std::string told;
    for (Limit &limit : problem_.criteria.limits)
      if (results_.misses_there(limit))
      {
        const unsigned int o = limit.objective;
        limit.correction     = results_.correction_there(limit);
        char text[32];
        std::snprintf(text, sizeof text, " %+.4g ", limit.correction);
        told += (told.empty() ? "" : ", ") + results_.objectives[o] + text + results_.units[o];
      }
    reporter_.print_line("limits are not kept on the finer mesh; from here on they count what it adds: " +
                         told);
  }

  void Optimize::report_best()
  {
    results_.best = problem_.differentiate(results_.best.mu);
    // Multipliers are those of the design accepted last, which the rounds ended with.
    results_.multipliers = search_.multipliers();
    if (!problem_.criteria.data.empty())
      results_.confidence = confidence_of(problem_.criteria, problem_.space, results_.best);
    results_.by_moving_relation = slopes_of_relations(
      problem_.space, results_.best.mu, problem_.lagrangian_slopes(results_.best, results_.multipliers));
    reporter_.write_shapes(results_.best, "best");
    results_.n_simulations = problem_.evaluator.n_asked();
    results_.n_sweeps      = problem_.evaluator.n_swept();
  }

  void Optimize::add_row(const Decision decision, const Evaluation &evaluation, const double radius)
  {
    results_.n_failed += evaluation.failed() ? 1 : 0;
    results_.rows.push_back(
      {decision, evaluation, search_.merit_of(evaluation), radius, problem_.meshes.number()});
    if (results_.stop == Stop::running)
      results_.best = best_so_far();
    results_.n_simulations = problem_.evaluator.n_asked();
    results_.n_sweeps      = problem_.evaluator.n_swept();
    reporter_.add_row(search_.n_iterations());
  }
} // namespace retroforge
