// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/case/case_messages.h>
#include <retroforge/case/scene_checks.h>
#include <retroforge/case/scene_estimate.h>
#include <retroforge/core/error.h>
#include <retroforge/core/exception_message.h>
#include <retroforge/core/interrupt_message.h>
#include <retroforge/core/version.h>
#include <retroforge/geometry/stl_file.h>
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/output/console.h>
#include <retroforge/output/mesh_files.h>
#include <retroforge/output/nodal_gradients.h>
#include <retroforge/output/objective_map.h>
#include <retroforge/output/results_folder.h>
#include <retroforge/output/safe_file.h>
#include <retroforge/output/sensitivity.h>
#include <retroforge/output/warnings.h>
#include <retroforge/run/perturbed_design.h>
#include <retroforge/run/run_messages.h>
#include <retroforge/run/run_summary.h>
#include <retroforge/run/simulation.h>

#include <algorithm>
#include <iostream>
#include <numeric>
#include <utility>

namespace retroforge
{
  namespace
  {
    void require_finite(const double x, const std::string &where, const std::string &what)
    {
      if (!std::isfinite(x))
        throw Error(where,
                    what + " is " + as_text(x),
                    "results must be finite numbers",
                    "use values of the usual size, of exponents and sharpness in particular");
    }

    void check_finite(const ObjectiveSensitivity &objective, const Design &design)
    {
      for (std::size_t j = 0; j < objective.gradient.size(); ++j)
        require_finite(objective.gradient[j],
                       "Objective " + objective.name,
                       "its derivative by " + design.parameters()[j].name);
      const auto size = [](const NodalVectors<double> &x) {
        return std::accumulate(
          x.begin(), x.end(), 0., [](const double sum, const Vec3 &v) { return sum + v.norm(); });
      };
      require_finite(size(objective.shape.X_0),
                     "Objective " + objective.name,
                     "its derivative by the nodes of the billet");
      for (const NodalVectors<double> &vertices : objective.shape.dies)
        require_finite(
          size(vertices), "Objective " + objective.name, "its derivative by the vertices of a die");
    }

    /// A check reads the increments many times over; a gradient once, from the record where they are many.
    ForwardRun::Keep kept_of(const Case &forging_case)
    {
      const bool is_gradient = forging_case.command.command == Command::gradient;
      if (forging_case.command.command == Command::check ||
          (is_gradient && !forging_case.parameters.output.record))
        return ForwardRun::Keep::increments;
      return is_gradient ? ForwardRun::Keep::few : ForwardRun::Keep::nothing;
    }
  } // namespace

  Simulation::Simulation(const CommandLine &command, MPI_Comm comm)
      : case_(command, timings_, comm)
      , root_(dealii::Utilities::MPI::this_mpi_process(comm) == 0)
      , run_(case_, case_.process, case_.X_0, kept_of(case_), timings_, command.output_directory)
      , warnings_(run_.check())
  {
  }

  int Simulation::run()
  {
    const auto total = timings_.scope("total");
    prepare_folder();
    if (root_)
    {
      check_outputs();
      write_inputs();
      print_begin(case_);
      print_warnings(warnings_);
      print_warnings(
        estimate_scene(case_.parameters, run_.first_epoch().scene, run_.process(), case_.X_0).warnings);
      summary_.volume_of_shape = shape_volume(case_);
      print_chords(case_, summary_.volume_of_shape);
    }
    try
    {
      return forge_and_judge() ? 0 : 1;
    }
    catch (...)
    {
      keep_failure();
      throw;
    }
  }

  void Simulation::prepare_folder() const
  {
    const CommandLine &command = case_.command;
    if (case_.resumption)
      case_.resumption->check_start(case_.billet, case_.X_0, case_.model.dies);
    if (case_.resumption && root_)
      case_.resumption->check_increments();
    MPI_Barrier(case_.comm); // all have read before anything changes
    if (root_ && command.resume)
      remove_all_but_record(command.output_directory, command.command == Command::check);
    else if (root_)
      make_results_folder(command.output_directory, command.overwrite, case_.echo);
  }

  void Simulation::check_outputs() const
  {
    std::vector<std::string> files          = {"parameters.prm",
                                               "history.csv",
                                               "objectives.csv",
                                               "fields.pvd",
                                               "summary.json",
                                               "billet.msh",
                                               "forged.msh",
                                               "forged.stl"};
    const bool               differentiates = case_.command.command != Command::simulate;
    if (differentiates)
      files.insert(files.end(), {"sensitivity.vtu", "sensitivity_nodes.csv"});
    if (case_.command.command == Command::check)
      files.push_back("check.json");
    if (case_.parameters.output.record)
      files.push_back("record.h5");
    for (const NamedObjective &objective : case_.objectives)
      if (objective.path && !objective.path->map({}).places.empty())
        files.push_back(map_file(objective.name));
    for (const Die &die : case_.model.dies)
      if (die.surface())
      {
        files.push_back("die_" + die.name + ".stl");
        if (differentiates)
          for (const char *kind : {".vtu", "_nodes.csv"})
            files.push_back("sensitivity_die_" + die.name + kind);
      }
    for (const std::string &file : files)
      check_writable(path_of(file));
  }

  void Simulation::write_inputs() const
  {
    write_file(path_of("parameters.prm"), case_.echo);
    write_msh(path_of("billet.msh"), case_.billet, case_.X_0);
    for (const Die &die : case_.model.dies)
      if (die.surface())
        write_stl(path_of("die_" + die.name + ".stl"), *die.surface(), StlFormat::binary);
  }

  bool Simulation::forge_and_judge()
  {
    const double begin = timings_.seconds("total");
    summary_.whole     = whole_part(case_.billet, case_.nominal.leading_velocity());
    forge();
    if (!case_.command.resume)
      forging_seconds_ = timings_.seconds("total") - begin;
    if (case_.command.command != Command::simulate)
      differentiate();
    summarise_run(case_, run_.process(), run_.state(), summary_);
    summarise_objectives(case_,
                         run_.trace(),
                         run_.state(),
                         values_,
                         spans_of(run_.objectives(), run_.trace(), output_->decisions()),
                         summary_);
    summarise_gradients(case_, sensitivities_, summary_);
    summary_.deepest      = output_->deepest();
    summary_.spanned      = output_->spanned();
    summary_.balance      = output_->balance();
    summary_.record_bytes = run_.recording().bytes();
    summary_.warnings =
      warnings_of(summary_, case_.parameters.contact.largest_depth, output_->untouched_dies());
    for (const std::string &beyond : beyond_law(case_, case_.process, run_.state()))
      summary_.warnings.push_back(beyond);
    const bool passed = verify();
    write_summary();
    if (root_)
      write_forged();
    if (root_)
      print_results(summary_, case_.command.output_directory);
    return passed;
  }

  void Simulation::write_forged() const
  {
    const TetMesh              &mesh = run_.state().epoch->scene.mesh;
    const NodalVectors<double> &X    = run_.state().workpiece.X;
    write_msh(path_of("forged.msh"), mesh, X);
    write_boundary_stl(path_of("forged.stl"), mesh, X);
    for (std::size_t o = 0; o < case_.objectives.size(); ++o)
      if (const NamedObjective &objective = case_.objectives[o]; objective.path)
        if (const ObjectiveMap map = objective.path->map(run_.trace().recorded().rows[o]);
            !map.places.empty())
          write_objective_map(path_of(map_file(objective.name)), objective.name, objective.unit(), map);
  }

  void Simulation::keep_failure()
  {
    if (!root_)
      return;
    const std::string message = message_of(std::current_exception());
    try
    {
      write_file(path_of("failure.txt"), message + "\n");
      if (output_ && values_.empty())
        output_->add_failed(run_.state());
    }
    catch (const Error &)
    {
      // What failed first is what the user must know.
    }
  }

  void Simulation::forge()
  {
    output_ = std::make_unique<RunOutput>(case_, run_.process(), summary_.whole, run_.trace(), timings_);
    if (case_.command.resume)
      resume();
    else if (root_ && case_.parameters.output.record)
      run_.recording().write_to(RecordWriter(case_.command.output_directory, run_.record_header(case_.echo)));
    if (root_)
      set_interrupt_message(resume_hint(case_));
    forge_on();
    values_ = run_.values();
    {
      const auto timing = timings_.scope("record");
      run_.recording().finish();
    }
    MPI_Barrier(case_.comm); // the record is complete before any rank reads it
    const ForgingState &end = run_.state();
    require_finite(end.energy.total(), "Workpiece", "its energy");
    require_finite(volume(end.epoch->scene.mesh.cells, end.workpiece.X), "Workpiece", "its volume");
  }

  void Simulation::forge_on()
  {
    bool writes = false;
    output_->begin();
    try
    {
      run_.forge([&](const IncrementEvent &event) {
        writes = true;
        {
          const auto timing = timings_.scope("record");
          run_.recording().write(event.record);
        }
        output_->add(event);
        writes = false;
      });
    }
    catch (const NoRoom &)
    {
      throw;
    }
    catch (const Error &error)
    {
      // Other numerics do not cure a full disk.
      if (writes || run_.state().increments == 0 || !case_.has_record())
        throw;
      throw error.or_else(resume_hint_after_failure(case_, run_.state().stroke, run_.remeshes()));
    }
  }

  void Simulation::resume()
  {
    const std::string &folder  = case_.command.output_directory;
    const auto        &changes = case_.resumption->changes;
    const RecordReader record(folder);
    IncrementRecord    increment;
    run_.restore(
      record.n_increments(),
      [&](const unsigned int i) -> const IncrementRecord & {
        increment = record.read(i);
        return increment;
      },
      [&](const IncrementEvent &event) { output_->add(event); });
    MPI_Barrier(case_.comm); // all have read before the writer removes what is torn
    const ForgingState &state   = run_.state();
    const bool          is_left = run_.is_left();
    if (is_left && !changes.empty())
    {
      case_.segments.push_back(
        {{state.increments, state.stroke, case_.echo, state.operation}, case_.parameters});
      run_.change_numerics(case_.segments.back());
    }
    if (!root_)
      return;
    if (record.finished() && is_left)
      RecordWriter::reopen(folder);
    if (record.finished() && !is_left)
      RecordWriter::tidy(folder);
    else
      run_.recording().write_to(RecordWriter::resume(folder));
    print_resumed(state.increments, is_left, changes);
  }

  void Simulation::differentiate()
  {
    const auto timing = timings_.scope("adjoint");
    const auto values = case_.combine(values_);
    for (std::size_t j = 0; j < case_.combinations.size(); ++j)
      sensitivities_.push_back({case_.combinations[j].name,
                                case_.combinations[j].unit,
                                values[j],
                                std::vector<double>(case_.mu.size()),
                                {}});
    // A check compares the two methods.
    if (case_.parameters.adjoint.method == AdjointParameters::Method::direct &&
        case_.command.command == Command::gradient)
      differentiate_directly();
    else
      sweep_back();
    auto       spans = spans_of(run_.objectives(), run_.trace(), output_->decisions());
    const bool in_die =
      is_in_die(output_->deepest(), output_->spanned(), case_.parameters.contact.largest_depth);
    for (auto &span : spans)
      if (span)
        span->in_die = in_die;
    for (std::size_t j = 0; j < sensitivities_.size(); ++j)
    {
      check_finite(sensitivities_[j], case_.design);
      judge_slopes(
        case_.combinations[j], spans, output_->decisions(), case_.design, case_.mu, sensitivities_[j]);
      if (root_)
        print_gradient(sensitivities_[j], case_.design, case_.mu);
    }
  }

  void Simulation::sweep_back()
  {
    const AdjointSweep sweep       = run_.sweep(case_.combinations);
    summary_.linear_solves_adjoint = sweep.linear_solves;
    for (std::size_t j = 0; j < sensitivities_.size(); ++j)
    {
      const auto timing = timings_.scope("design");
      sensitivities_[j].gradient =
        case_.design.pull_back(case_.mu, sweep.gradients[j].X_0, sweep.gradients[j].process);
      sensitivities_[j].shape = {sweep.gradients[j].X_0, {}};
      for (const auto &die : sweep.gradients[j].process.dies)
        sensitivities_[j].shape.dies.push_back(die.vertices);
    }
    const auto timing = timings_.scope("sensitivity");
    if (root_)
    {
      const std::string &folder = case_.command.output_directory;
      write_sensitivity(folder, case_.billet, case_.X_0, case_.model.dies, sensitivities_);
      write_nodal_gradients(
        folder, case_.billet, case_.X_0, case_.model.dies, run_.process(), sensitivities_);
    }
  }

  void Simulation::differentiate_directly()
  {
    for (std::size_t i = 0; i < case_.mu.size(); ++i)
    {
      std::vector<double> mu_dot(case_.mu.size(), 0.);
      mu_dot[i] = 1.;
      const auto derivatives =
        directional_derivatives(case_, run_, mu_dot, {NodalVectors<double>(case_.X_0.size()), {}});
      for (std::size_t j = 0; j < sensitivities_.size(); ++j)
        sensitivities_[j].gradient[i] = derivatives[j];
    }
  }

  void Simulation::write_summary()
  {
    summary_.wall_seconds = timings_.all();
    if (root_)
      summary_.write(path_of("summary.json"));
  }
} // namespace retroforge
