// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/case/case_messages.h>
#include <retroforge/case/resume.h>
#include <retroforge/case/scene_estimate.h>
#include <retroforge/core/error.h>
#include <retroforge/core/fingerprint.h>
#include <retroforge/core/nearest_name.h>
#include <retroforge/core/stop_notice.h>
#include <retroforge/core/version.h>
#include <retroforge/geometry/stl_file.h>
#include <retroforge/mesh/whole_part.h>
#include <retroforge/optimization/optimize.h>
#include <retroforge/output/console.h>
#include <retroforge/output/mesh_files.h>
#include <retroforge/output/results_folder.h>
#include <retroforge/output/safe_file.h>
#include <retroforge/run/run_messages.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <random>
#include <set>

namespace retroforge
{
  namespace
  {
    using Decision = TrialRow::Decision;
    using Stop     = SearchStop;

    unsigned int n_groups(const CommandLine &command)
    {
      std::string ignored;
      return Parameters::read(command, ignored).optimization.side_by_side;
    }

    /// What gives the same bits for the same design. @param comm  that it is forged on
    std::string program_on(MPI_Comm comm)
    {
      return std::string(version) + " " + commit + ", " +
             std::to_string(dealii::Utilities::MPI::n_mpi_processes(comm)) + " rank(s)";
    }

    /// Of all values of a design.
    std::vector<std::string> names_of(const Objectives &objectives, const DesignSpace &space)
    {
      std::vector<std::string> names;
      for (const NamedObjective &objective : objectives)
        names.push_back(objective.name);
      if (space.held())
        names.push_back(space.held()->name);
      return names;
    }

    std::vector<std::string> units_of(const Objectives &objectives, const DesignSpace &space)
    {
      std::vector<std::string> units;
      for (const NamedObjective &objective : objectives)
        units.push_back(objective.unit());
      if (space.held())
        units.push_back(space.held()->unit);
      return units;
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

    std::string exact(const double x)
    {
      char text[32];
      std::snprintf(text, sizeof text, "%.17g", x);
      return text;
    }

    std::string values_by_name(const std::vector<DesignParameter> &parameters, const std::vector<double> &mu)
    {
      std::string text;
      for (std::size_t j = 0; j < mu.size(); ++j)
        text += (j == 0 ? "" : ", ") + parameters[j].name + ": " + exact(mu[j]);
      return text;
    }

    /// @param made_at  where the mesh was made, as in Design/meshed at; empty for that of the case
    std::string as_parameters(const std::string &design, const std::string &made_at)
    {
      return "# What the case is to include for this design.\nsubsection Design\n  set at = " + design +
             "\n" + (made_at.empty() ? "" : "  set meshed at = " + made_at + "\n") + "end\n";
    }

    /// Of a search that went on, whose designs may have had other numbers before.
    bool has_shapes(const std::string &base, const std::string &design, const bool with_record)
    {
      const std::string file = base + "_design.prm";
      return std::filesystem::exists(file) && read_file(file) == design &&
             (!with_record || std::filesystem::exists(base + "/header.h5"));
    }

    std::map<std::string, std::string> parameters_of(const Operations &operations)
    {
      std::map<std::string, std::string> parameters;
      for (std::size_t o = 1; o < operations.size(); ++o)
        parameters[operations.name(o)] = operations.at(o).echo;
      return parameters;
    }

    /// What the parameters of all operations name, but do not tell.
    std::map<std::string, std::uint64_t> surfaces_of(const Operations &operations)
    {
      std::map<std::string, std::uint64_t> surfaces;
      for (std::size_t o = 0; o < operations.size(); ++o)
      {
        const Case       &at  = operations.at(o);
        const std::string tag = o == 0 ? "" : " of operation " + operations.name(o);
        Fingerprint       billet;
        billet.add(at.billet.cells.data(), at.billet.cells.size() * sizeof(at.billet.cells[0]));
        billet.add(at.billet.X.data(), at.billet.X.size() * sizeof(Vec3));
        surfaces["mesh of the billet" + tag] = billet.value;
        const auto of_dies                   = fingerprints(at.model.dies);
        for (std::size_t d = 0; d < of_dies.size(); ++d)
          surfaces["surface of die " + at.model.dies[d].name + tag] = of_dies[d];
        const auto values = parameter_values(parameter_lines_of(at.echo, "case"));
        for (const ObjectiveParameters &objective : at.parameters.objectives.all)
          if (const auto target = values.find("Objective " + objective.name + "/target");
              target != values.end() && std::filesystem::is_regular_file(target->second))
          {
            const std::string contents = read_file(target->second);
            Fingerprint       of_file;
            of_file.add(contents.data(), contents.size());
            surfaces["target of objective " + objective.name + tag] = of_file.value;
          }
      }
      return surfaces;
    }

    /// With elements and increments a part as large.
    CommandLine finer(const Case &at, const double part)
    {
      CommandLine command = at.command;
      command.case_text   = at.echo;
      const auto set      = [&](const std::string &path, const double value) {
        command.overrides.emplace_back(path, exact(value));
      };
      set("Billet/element size", part * at.parameters.billet.element_size);
      if (at.parameters.remeshing.element_size > 0.)
        set("Remeshing/element size", part * at.parameters.remeshing.element_size);
      set("Press/increments", std::ceil(at.parameters.press.increments / part - 1e-9));
      return command;
    }

    std::vector<std::string> varied(const Case &at)
    {
      std::vector<std::string> names;
      for (const std::string &name : at.design.expanded(at.parameters.design.names))
        if (name != at.parameters.optimization.scattered)
          names.push_back(name);
      return names;
    }

    bool varies_billet(const DesignSpace &space)
    {
      for (std::size_t j = 0; j < space.size(); ++j)
        if (space.parameters()[j].kind == DesignParameter::Kind::billet &&
            space.lower()[j] < space.upper()[j])
          return true;
      return false;
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

  Optimize::Optimize(const CommandLine &command, MPI_Comm comm)
      : resume_(command.resume)
      , groups_(comm, n_groups(command), "Optimisation/side by side")
      , case_(
          [&] {
            // A journal, not a record, is what it goes on with.
            CommandLine anew = command;
            anew.resume      = false;
            return anew;
          }(),
          timings_,
          groups_.comm())
      , operations_(case_, commands_of_operations(case_), timings_)
      , objectives_(operations_.objectives())
      , root_(groups_.is_first_rank())
      , space_(case_.design.parameters(),
               varied(case_),
               case_.mu,
               case_.parameters.optimization,
               case_.design.held())
      , criteria_(criteria_of(objectives_, case_.parameters.optimization, space_))
      , scatter_(case_.design.parameters(),
                 case_.parameters.optimization,
                 from_below(criteria_,
                            names_of(objectives_, space_),
                            !case_.parameters.optimization.scattered.empty()))
      , journal_(make_journal())
      , meshes_(case_, case_.parameters.optimization.mesh_quality)
      , trials_(operations_, journal_, scatter_, groups_)
      , search_(space_, criteria_, case_.parameters.optimization, search_task())
      , results_{space_, criteria_, names_of(objectives_, space_), units_of(objectives_, space_)}
  {
    results_.counted_as      = scatter_.in_words();
    results_.limit_tolerance = case_.parameters.optimization.limit_tolerance;
    for (std::size_t o = 0; o < operations_.size(); ++o)
    {
      // A start of which nothing can come is refused before anything is written.
      const Case               &at = operations_.at(o);
      const std::vector<double> mu = operations_.values(o, case_.mu);
      for (std::size_t i = 0; i < scatter_.n_samples(); ++i)
        at.design.check_values(operations_.values(o, scatter_.sample(case_.mu, i)));
      Trial(at, at.design.process(mu), at.design.positions(mu), Trial::Keep::nothing).check();
      if (o > 0)
        results_.operations[operations_.name(o)] = operations_.common(o);
    }
  }

  SearchTask Optimize::search_task()
  {
    SearchTask task;
    task.evaluate      = [&](const std::vector<double> &mu) { return evaluate(mu); };
    task.differentiate = [&](const std::vector<double> &mu) { return differentiate(mu); };
    task.n_evaluated   = [&] { return trials_.n_asked(); };
    task.mesh_is_bad   = [&](const Evaluation &now) { return mesh_is_bad(now); };
    task.renew_mesh    = [&](const Evaluation &now) { return renew_mesh(now); };
    task.decided       = [&](const Evaluation &evaluation, const bool accepted) {
      meshes_.tell(evaluation.mu, accepted, evaluation.failed());
      if (accepted)
        write_shapes(evaluation, "trial_" + std::to_string(results_.rows.size()));
      add_row(accepted ? Decision::accepted : Decision::refused, evaluation, search_.radius());
    };
    task.renewed = [&](const double excess) {
      if (!root_)
        return;
      std::printf("  limits exceeded by %.2g at most; multipliers renewed:", excess);
      for (const double multiplier : search_.multipliers())
        std::printf(" %.4g", multiplier);
      std::printf("\n");
    };
    return task;
  }

  Evaluation Optimize::with_held(const Design &design, Evaluation evaluation) const
  {
    if (!space_.held() || evaluation.failed())
      return evaluation;
    evaluation.values.push_back(design.held_value(evaluation.mu));
    if (!evaluation.gradients.empty())
      evaluation.gradients.push_back(design.held_gradient(evaluation.mu));
    return evaluation;
  }

  Evaluation Optimize::evaluate(const std::vector<double> &mu)
  {
    return with_held(operations_.at(0).design, trials_.evaluate(mu));
  }

  Evaluation Optimize::differentiate(const std::vector<double> &mu)
  {
    return with_held(operations_.at(0).design, trials_.differentiate(mu));
  }

  bool Optimize::mesh_is_bad(const Evaluation &now)
  {
    const bool is_due = meshes_.due(now.mu);
    if (root_ && !is_due && !meshes_.complaint().empty())
      std::printf("  mesh not made anew: %s\n", meshes_.complaint().c_str());
    return is_due;
  }

  void Optimize::forge_on(const Case &at, const std::string &made_at)
  {
    journal_.use_mesh(made_at);
    operations_.use_main(at);
    trials_.renew_main();
  }

  std::optional<Evaluation> Optimize::renew_mesh(const Evaluation &now)
  {
    NewMesh mesh;
    mesh.made_at        = meshes_.candidate().made_at;
    mesh.quality_before = meshes_.quality(now.mu);
    mesh.volume_before  = meshes_.volume_at(now.mu);
    mesh.before         = now.values;
    forge_on(*meshes_.candidate().made, mesh.made_at);
    Evaluation again = evaluate(now.mu);
    if (again.failed())
    {
      if (root_)
        std::printf("  mesh not made anew: on it the same design fails: %s\n", again.failure.c_str());
      forge_on(meshes_.now(), meshes_.made_at());
      meshes_.refuse_candidate(now.mu);
      return {};
    }
    meshes_.use_candidate();
    again              = differentiate(now.mu);
    mesh.quality_after = meshes_.quality(now.mu);
    mesh.volume_after  = meshes_.volume_at(now.mu);
    mesh.after         = again.values;
    mesh.n_nodes       = meshes_.now().billet.n_nodes();
    mesh.row           = results_.rows.size();
    results_.meshes.push_back(mesh);
    if (root_)
      results_.print(results_.meshes.back(), std::cout);
    write_shapes(again, "trial_" + std::to_string(mesh.row));
    add_row(Decision::renewed, again, search_.radius());
    return again;
  }

  Journal Optimize::make_journal() const
  {
    const std::string program = program_on(case_.comm), file = path_of("journal.jsonl");
    if (!resume_)
      return Journal({program, case_.echo, parameters_of(operations_), surfaces_of(operations_)});
    if (!std::filesystem::exists(file))
      throw Error(case_.command.output_directory,
                  "holds no journal of an optimisation",
                  "--resume goes on with one",
                  "leave --resume out to begin, or name the folder with --output DIR");
    Journal         journal = Journal::read(file);
    Journal::Header header  = journal.header();
    if (header.program != program)
      throw Error(
        file,
        "was written by Retroforge " + journal.header().program + ", and this is " + program,
        "another version, or another number of ranks of a group, may give other values for the same design",
        "go on with that one, or begin anew with --overwrite");
    if (!make_same_results(journal.header().parameters, case_.echo))
      throw Error(
        file,
        "belongs to a case with other parameters",
        "an optimisation goes on with the case it began with; only the sections Optimisation, Check, "
        "Output and Scan may differ",
        "restore the parameters (" + path_of("parameters.prm") +
          " has them), or begin anew with --overwrite");
    for (const auto &[name, parameters] : parameters_of(operations_))
      if (!make_same_results(header.operations.emplace(name, parameters).first->second, parameters))
        throw Error(file,
                    "has forgings of another operation " + name,
                    "an optimisation goes on with the operations it began with, and may get more of them",
                    "restore its parameters (" + path_of("parameters_" + name + ".prm") +
                      " has them), or begin anew with --overwrite");
    for (const auto &[name, fingerprint] : surfaces_of(operations_))
      if (header.surfaces.emplace(name, fingerprint).first->second != fingerprint)
        throw Error(file,
                    "has forgings with another " + name,
                    "an optimisation goes on with the billet, dies and targets it began with",
                    "restore its file, or the version of the mesher, or begin anew with --overwrite");
    journal.set_header(std::move(header));
    return journal;
  }

  void Optimize::prepare_folder()
  {
    MPI_Barrier(groups_.all()); // all have read the journal before anything changes
    if (!root_)
      return;
    const std::string &folder = case_.command.output_directory;
    if (!resume_)
      make_results_folder(folder, case_.command.overwrite, case_.echo);
    make_directory(folder + "/designs");
    for (const char *file : {"optimisation.csv", "optimisation.json"})
      check_writable(path_of(file));
    for (std::size_t o = 0; o < operations_.size(); ++o)
    {
      const std::string parameters = path_of(operations_.titled("parameters", o) + ".prm");
      for (const std::string &file : {parameters, path_of(operations_.titled("best", o) + ".prm")})
        check_writable(file);
      write_file(parameters, operations_.at(o).echo);
    }
    journal_.write_to(path_of("journal.jsonl"));
  }

  int Optimize::run()
  {
    prepare_folder();
    std::set<std::string> warnings; // of operations that share a setting, once
    for (std::size_t o = 0; o < operations_.size(); ++o)
      for (const std::string &warning : estimate_scene(operations_.at(o)).warnings)
        warnings.insert(warning);
    if (root_)
    {
      print_begin(case_);
      print_warnings({warnings.begin(), warnings.end()});
      print_search();
      say_when_stopped("stopped; the same command with --resume goes on with the designs that are forged");
    }
    begin();
    if (case_.command.check)
      check();
    measure_noise();
    // A limit's optimum is the last design, not the least one within its tolerance.
    const bool settled = search_.run(results_.noise);
    results_.stop      = search_.stop();
    results_.best      = settled ? search_.now() : best_so_far();
    report_best();
    if (root_)
      write_results(); // the confirmation is the longest forging, and may be stopped
    confirm();
    if (root_)
    {
      write_results();
      results_.print(std::cout);
      std::cout << "  results in " << case_.command.output_directory << std::endl;
    }
    return results_.exit_status();
  }

  void Optimize::print_search() const
  {
    std::printf("optimisation of %s by %zu parameter(s), %zu limit(s)\n",
                criteria_.objective.name.c_str(),
                varied(case_).size(),
                criteria_.limits.size());
    print_part(whole_part(case_.billet, case_.nominal.dies[case_.nominal.leading_die].velocity));
    if (criteria_.objective.unit == "mixed")
      std::printf("  note: it adds objectives of different units, by their weights\n");
    if (const auto &held = space_.held(); held && varies_billet(space_))
      std::printf("  %s follows from the volume%s\n",
                  held->name.c_str(),
                  std::isinf(held->lower) && std::isinf(held->upper)
                    ? "; it has no bounds (Optimisation/lower bounds, upper bounds)"
                    : "");
    for (const LinearRelation &relation : space_.relations())
      std::printf("  every design keeps %s\n", relation.text.c_str());
    if (!scatter_.empty())
      std::printf("  each design is forged %zu times, with %s from %.6g to %.6g\n",
                  scatter_.n_samples(),
                  case_.parameters.optimization.scattered.c_str(),
                  case_.parameters.optimization.scatter_range[0],
                  case_.parameters.optimization.scatter_range[1]);
    print_unscattered();
    for (const auto &[name, parameters] : results_.operations)
      std::printf("  each design is forged in operation %s, too, which has its %s\n",
                  name.c_str(),
                  join(parameters).c_str());
    if (groups_.n() > 1)
      std::printf("  by %u groups of ranks side by side\n", groups_.n());
    if (journal_.size() > 0)
      std::printf("  %zu designs are forged already, and taken from the journal\n", journal_.size());
    for (std::size_t o = 0; o < objectives_.size(); ++o)
      if (criteria_.objective.weights[o] == 0. && !criteria_.uses(o))
        std::printf("  note: %s is only watched\n", objectives_[o].name.c_str());
    std::fflush(stdout);
  }

  void Optimize::print_unscattered() const
  {
    const OptimizationParameters &optimization = case_.parameters.optimization;
    for (std::size_t j = 0; j < space_.size() && !scatter_.empty(); ++j)
      if (space_.parameters()[j].name == optimization.scattered &&
          !(case_.mu[j] >= optimization.scatter_range[0] && case_.mu[j] <= optimization.scatter_range[1]))
        std::printf("  note: the case itself has %s = %.6g, outside of that range; best.prm has it, too\n",
                    optimization.scattered.c_str(),
                    case_.mu[j]);
  }

  void Optimize::begin()
  {
    const Evaluation start = evaluate(case_.mu);
    if (start.failed())
      throw Error("optimize",
                  "cannot forge the design it begins with, in increment " +
                    std::to_string(start.increments + 1) + ": " + start.failure,
                  "the first design must succeed",
                  "begin elsewhere with --at, or cure what the message says");
    results_.start = results_.best = differentiate(case_.mu);
    criteria_.set_sizes(results_.start.values);
    search_.begin(results_.start);
    note_flat_start();
    add_row(Decision::start, results_.start, search_.radius());
    write_shapes(results_.start, "start");
  }

  void Optimize::note_flat_start() const
  {
    const std::vector<double> slopes = criteria_.slopes(results_.start.values);
    for (std::size_t o = 0; o < slopes.size(); ++o)
      for (std::size_t j = 0; j < space_.size(); ++j)
        if (space_.at(results_.start.mu, j) != DesignSpace::At::fixed &&
            slopes[o] * results_.start.gradients[o][j] != 0.)
          return;
    if (root_)
      std::printf("  note: at the start %s does not depend on any parameter that is varied\n",
                  criteria_.objective.name.c_str());
  }

  void Optimize::check()
  {
    const std::vector<DifferenceCheck> rows = search_.check();
    if (!root_)
      return;
    std::printf("  gradient along a direction, against differences of forgings that decide everything anew:\n"
                "  step [scales]    derivative    difference    relative error\n");
    for (const DifferenceCheck &row : rows)
      std::printf("  %-12.3g %14.7g %13.7g %12.2g\n",
                  row.step,
                  row.derivative,
                  row.difference,
                  row.error / std::abs(row.derivative));
    std::fflush(stdout);
  }

  void Optimize::measure_noise()
  {
    const unsigned int n = case_.parameters.optimization.noise_runs;
    if (n == 0)
      return;
    constexpr double part = 1e-3; // of the scales: what bends over it is no noise
    std::mt19937     generator(1);
    double           sum      = 0.;
    unsigned int     n_values = 0;
    for (unsigned int i = 0; i < n && trials_.n_asked() < case_.parameters.optimization.simulations; ++i)
    {
      std::vector<double> x(space_.size());
      for (double &entry : x)
        entry = part * (2. * (generator() / 4294967295.) - 1.);
      const std::vector<double> mu         = space_.values(space_.projected(x));
      const Evaluation          evaluation = evaluate(mu);
      add_row(Decision::noise, evaluation, part);
      if (evaluation.failed())
        continue;
      // Values are linear over so short a step; their misfit against data need not be.
      const Evaluation   &start     = results_.start;
      std::vector<double> predicted = start.values;
      for (std::size_t o = 0; o < start.gradients.size(); ++o)
        for (std::size_t j = 0; j < mu.size(); ++j)
          predicted[o] += start.gradients[o][j] * (mu[j] - start.mu[j]);
      sum += std::pow(criteria_.value(evaluation.values) - criteria_.value(predicted), 2);
      ++n_values;
    }
    results_.noise = n_values > 0 ? std::sqrt(sum / n_values) : 0.;
    if (!root_)
      return;
    const double value = criteria_.value(results_.start.values);
    std::printf("  noise: %.3g%s%s",
                results_.noise,
                criteria_.objective.unit.empty() ? "" : " ",
                criteria_.objective.unit.c_str());
    // A misfit that begins near 0 has nothing to be compared with.
    if (value != 0. && criteria_.data.empty())
      std::printf(", %.2g of the value", results_.noise / std::abs(value));
    std::printf("\n");
  }

  Evaluation Optimize::best_so_far() const
  {
    const double tolerance = case_.parameters.optimization.limit_tolerance;
    const auto   is_better = [&](const Evaluation &a, const Evaluation &b) {
      const double excess_a = std::max(tolerance, criteria_.largest_excess(a.values)),
                   excess_b = std::max(tolerance, criteria_.largest_excess(b.values));
      return excess_a < excess_b || (excess_a == excess_b && results_.value(a) < results_.value(b));
    };
    std::optional<Evaluation> best;
    for (const TrialRow &row : results_.rows)
      if (row.mesh == meshes_.number() && row.becomes_the_next() &&
          (!best || is_better(row.evaluation, *best)))
        best = row.evaluation;
    return *best;
  }

  void Optimize::report_best()
  {
    results_.best = differentiate(results_.best.mu);
    // Multipliers are those of the design accepted last, which the rounds ended with.
    results_.multipliers = search_.multipliers();
    if (!criteria_.data.empty())
      results_.confidence = confidence_of(criteria_, space_, results_.best);
    results_.by_moving_relation =
      slopes_of_relations(space_, results_.best.mu, lagrangian_slopes(results_.best));
    write_shapes(results_.best, "best");
    results_.n_simulations = trials_.n_asked();
    results_.n_sweeps      = trials_.n_swept();
  }

  void Optimize::confirm()
  {
    const double part = case_.parameters.optimization.confirmation;
    if (part == 0.)
      return;
    if (const std::string reason = no_finer_mesh(); !reason.empty())
    {
      if (root_)
        std::printf("  not confirmed: %s\n", reason.c_str());
      return;
    }
    if (root_)
      std::printf("  confirming with elements and increments %.3g times as large ...\n", part);
    std::fflush(stdout);
    Timings                     timings;
    std::unique_ptr<const Case> fine, there;
    std::unique_ptr<Operations> operations;
    std::optional<Journal>      journal;
    try
    {
      const CommandLine command = finer(case_, part);
      fine                      = make_case(command, "", case_.comm);
      // The best design on a mesh made where that of the search was.
      if (meshes_.number() > 0)
        there = make_case(command, meshes_.made_at(), case_.comm);
      std::vector<CommandLine> others;
      for (std::size_t o = 1; o < operations_.size(); ++o)
        others.push_back(finer(operations_.at(o), part));
      operations = std::make_unique<Operations>(*fine, others, timings);
      journal    = confirmation_journal(*operations);
    }
    catch (const Error &error)
    {
      // What was found must not be lost with it.
      if (root_)
        std::printf("  not confirmed: %s\n", error.what());
      return;
    }
    MPI_Barrier(groups_.all());
    if (root_)
      journal->write_to(path_of("confirmation.jsonl"));
    const auto evaluate = [&](const std::vector<double> &mu) {
      return with_held(operations->at(0).design,
                       Trials(*operations, *journal, scatter_, groups_).evaluate(mu));
    };
    const Evaluation start = evaluate(results_.start.mu);
    if (there)
    {
      operations->use_main(*there);
      journal->use_mesh(meshes_.made_at());
    }
    results_.confirmation = Confirmation{start,
                                         evaluate(results_.best.mu),
                                         operations->at(0).billet.n_nodes(),
                                         operations->at(0).parameters.press.increments};
  }

  std::string Optimize::no_finer_mesh() const
  {
    const std::string mode = "billet/free form ";
    for (std::size_t o = 0; o < operations_.size(); ++o)
    {
      if (operations_.at(o).parameters.billet.shape == "file")
        return "a billet from a file has no finer mesh";
      for (const DesignParameter &parameter : operations_.at(o).design.parameters())
        if (parameter.name.rfind(mode, 0) == 0)
          return "the modes of a free form belong to their mesh";
    }
    return "";
  }

  Journal Optimize::confirmation_journal(const Operations &fine) const
  {
    const std::string file = path_of("confirmation.jsonl");
    Journal begun({program_on(case_.comm), fine.at(0).echo, parameters_of(fine), surfaces_of(fine)});
    if (resume_ && std::filesystem::exists(file))
      if (Journal kept = Journal::read(file);
          make_same_results(kept.header().parameters, begun.header().parameters) &&
          kept.header().operations == begun.header().operations &&
          kept.header().surfaces == begun.header().surfaces)
        return kept;
    return begun;
  }

  void Optimize::add_row(const Decision decision, const Evaluation &evaluation, const double radius)
  {
    results_.n_failed += evaluation.failed() ? 1 : 0;
    results_.rows.push_back({decision, evaluation, search_.merit_of(evaluation), radius, meshes_.number()});
    if (results_.stop == Stop::running)
      results_.best = best_so_far();
    results_.n_simulations = trials_.n_asked();
    if (!root_)
      return;
    print_row(results_.rows.back());
    write_results();
  }

  void Optimize::print_row(const TrialRow &row) const
  {
    const Evaluation &evaluation = row.evaluation;
    std::printf("%5zu  %-9s", results_.rows.size() - 1, in_words(row.decision, evaluation.failed()).c_str());
    if (evaluation.failed())
      std::printf("in increment %u: %s", evaluation.increments + 1, evaluation.failure.c_str());
    else
    {
      std::printf("%.7g %s", results_.value(evaluation), criteria_.objective.unit.c_str());
      for (const Limit &limit : criteria_.limits)
        std::printf(", %s %.6g (%s %.6g)",
                    results_.objectives[limit.objective].c_str(),
                    evaluation.values[limit.objective],
                    limit.at_least ? "at least" : "at most",
                    limit.bound);
    }
    if (row.decision == Decision::accepted || row.decision == Decision::refused)
      std::printf("  step %.3g", row.radius);
    std::printf("  %.1f s", evaluation.seconds);
    if (trials_.seconds_each() > 0.)
      std::printf(", at most %.0f s left", trials_.seconds_each() * most_forgings_left());
    std::printf("\n");
    std::fflush(stdout);
  }

  unsigned int Optimize::most_forgings_left() const
  {
    const auto left = [](const unsigned int most, const unsigned int done) {
      return most > done ? most - done : 0;
    };
    const OptimizationParameters &most = case_.parameters.optimization;
    return std::min(left(most.simulations, trials_.n_asked()),
                    left(most.iterations, search_.n_iterations()) * trials_.n_forgings(case_.mu));
  }

  std::vector<double> Optimize::lagrangian_slopes(const Evaluation &at) const
  {
    std::vector<double> by_objective = criteria_.slopes(at.values), by_mu(space_.size(), 0.);
    for (std::size_t i = 0; i < criteria_.limits.size(); ++i)
      by_objective[criteria_.limits[i].objective] += results_.multipliers[i] * criteria_.limits[i].slope();
    for (std::size_t o = 0; o < by_objective.size(); ++o)
      for (std::size_t j = 0; j < by_mu.size(); ++j)
        by_mu[j] += by_objective[o] * at.gradients[o][j];
    return by_mu;
  }

  void Optimize::write_shapes(const Evaluation &evaluation, const std::string &name)
  {
    for (std::size_t o = 0; o < operations_.size(); ++o)
      write_shapes_of(o, evaluation.mu, name);
  }

  void Optimize::write_shapes_of(const std::size_t          operation,
                                 const std::vector<double> &mu,
                                 const std::string         &name)
  {
    // The group that has the middle sample in memory writes it.
    const Case       &at     = operations_.at(operation);
    const std::string base   = path_of("designs/" + operations_.titled(name, operation));
    const bool        writes = dealii::Utilities::MPI::this_mpi_process(case_.comm) == 0;
    const std::string design =
      as_parameters(values_by_name(at.design.parameters(), mu), operation == 0 ? meshes_.made_at() : "");
    const bool there = dealii::Utilities::MPI::broadcast(
      case_.comm,
      writes && name != "best" && has_shapes(base, design, case_.parameters.optimization.keep_records),
      0);
    const Trial *forged = there ? nullptr : trials_.forged(mu, operation);
    if (forged == nullptr)
      return;
    const Trial &trial = *forged;
    if (name == "best" && operation == 0)
    {
      results_.details.clear();
      for (const ObjectiveTrace::Beside &beside : trial.beside()) // by all ranks of the group
        results_.details.push_back(beside.details);
    }
    if (!writes)
      return;
    if (case_.parameters.optimization.keep_records)
      trial.write_record(base, parameters_at(at, trials_.middle_sample(mu, operation)));
    write_msh(base + "_billet.msh", at.billet, trial.X_0());
    write_boundary_stl(base + "_billet.stl", at.billet, trial.X_0());
    write_boundary_stl(base + "_forged.stl", trial.end().leg->scene.mesh, trial.end().X);
    for (const Die &die : trial.dies())
      if (die.surface())
        write_stl(base + "_die_" + die.name + ".stl", *die.surface(), StlFormat::binary);
    write_file(base + "_design.prm", design); // when all of it is there
  }

  void Optimize::write_results() const
  {
    results_.write_csv(path_of("optimisation.csv"));
    results_.write_json(path_of("optimisation.json"));
    for (std::size_t o = 0; o < operations_.size(); ++o)
      write_file(path_of(operations_.titled("best", o) + ".prm"),
                 parameters_at(operations_.at(o),
                               operations_.values(o, results_.best.mu),
                               operations_.at(o).parameters.files_seen_from(case_.command.output_directory,
                                                                            operations_.at(o).echo)));
  }

  std::string Optimize::parameters_at(const Case                                             &at,
                                      const std::vector<double>                              &mu,
                                      const std::vector<std::pair<std::string, std::string>> &files) const
  {
    CommandLine there = at.command;
    there.case_text   = at.echo;
    there.at.clear();
    there.overrides.emplace_back("Design/at", values_by_name(at.design.parameters(), mu));
    there.overrides.insert(there.overrides.end(), files.begin(), files.end());
    std::string parameters;
    Parameters::read(there, parameters);
    return parameters;
  }
} // namespace retroforge
