// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/contact/penetration.h>
#include <retroforge/core/error.h>
#include <retroforge/core/exception_message.h>
#include <retroforge/core/stop_notice.h>
#include <retroforge/core/text.h>
#include <retroforge/core/version.h>
#include <retroforge/geometry/stl_file.h>
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/objective/surface_areas.h>
#include <retroforge/output/blas.h>
#include <retroforge/output/check_file.h>
#include <retroforge/output/console.h>
#include <retroforge/output/results_folder.h>
#include <retroforge/output/safe_file.h>
#include <retroforge/output/vtu_writer.h>
#include <retroforge/record/record_file.h>
#include <retroforge/scene_checks.h>
#include <retroforge/simulation.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <numeric>
#include <thread>
#include <utility>

namespace retroforge
{
  namespace
  {
    /// That makes a check's numbers.
    const std::string program = std::string(version) + " " + commit;

    std::vector<Die> make_dies(const std::vector<DieParameters> &parameters)
    {
      std::vector<Die> dies;
      for (const auto &die : parameters)
        dies.push_back(die.die());
      return dies;
    }

    /// Those of a changed design: what the run decides, it decides on them as they are there.
    std::vector<Die> make_dies(const Parameters &parameters, const Process<double> &process)
    {
      std::vector<Die> dies = make_dies(parameters.dies);
      if (!parameters.design.at.empty())
        for (std::size_t d = 0; d < dies.size(); ++d)
          if (!process.dies[d].vertices.empty())
            dies[d] = dies[d].moved(process.dies[d].vertices);
      return dies;
    }

    /// For names of fields.
    std::string as_identifier(std::string name)
    {
      for (char &c : name)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0)
          c = '_';
      return name;
    }

    NodalVectors<double> sum(NodalVectors<double> a, const NodalVectors<double> &b)
    {
      for (std::size_t k = 0; k < a.size(); ++k)
        a[k] += b[k];
      return a;
    }

    TetMesh make_first_mesh(const Parameters &parameters, Timings &timings, MPI_Comm comm)
    {
      const TetMesh mesh = make_billet(parameters.billet, comm);
      if (!parameters.remeshing.first_mesh)
        return mesh;
      const std::vector<Die>        dies = make_dies(parameters.dies);
      std::vector<DieState<double>> states;
      for (const DieParameters &die : parameters.dies)
        states.push_back(die.initial_state());
      return Remesher(parameters.remeshing, parameters.edge_length(mesh), dies, mesh.patches, comm)
        .remesh(mesh, mesh.X, states, timings)
        ->mesh;
    }

    Summary::Check as_summary(const CheckRow &row)
    {
      const char    *verdict = row.is_zero ? "zero" : row.passed ? "passed" : "failed";
      Summary::Check check{
        row.objective, row.parameter, row.adjoint, row.tangent, {}, row.taylor_orders, verdict};
      for (const DifferenceRow &d : row.steps)
        check.steps.push_back(
          {d.step, d.replayed_central, d.replayed_forward, d.replayed_backward, d.free_central});
      return check;
    }

    void require_finite(const double x, const std::string &where, const std::string &what)
    {
      if (!std::isfinite(x))
        throw Error(where,
                    what + " is " + as_text(x),
                    "results must be finite numbers",
                    "use values of the usual size: exponents and sharpness above all");
    }

    void check_finite(const Objectives &objectives, const std::vector<double> &values)
    {
      for (std::size_t j = 0; j < objectives.size(); ++j)
        require_finite(values[j], "Objective " + objectives[j].name, "its value");
    }

    void check_finite(const Judged &objective, const Design &design)
    {
      for (std::size_t j = 0; j < objective.gradient.size(); ++j)
        require_finite(objective.gradient[j],
                       "Objective " + objective.name,
                       "its derivative by " + design.parameters()[j].name);
      double size = 0.;
      for (const Vec3 &x : objective.shape.X_0)
        size += x.norm();
      require_finite(size, "Objective " + objective.name, "its derivative by the nodes of the billet");
    }

    /// "check" solves all systems as well as they can be, or differences would measure the solvers.
    Parameters as_solved(Parameters parameters, const CommandLine &command)
    {
      if (command.command == "check")
      {
        parameters.newton.tolerance  = std::min(parameters.newton.tolerance, 1e-12);
        parameters.adjoint.tolerance = std::min(parameters.adjoint.tolerance, 1e-14);
      }
      return parameters;
    }

    Parameters read(const CommandLine &command, std::string &echo)
    {
      return as_solved(Parameters::read(command.case_file, command.settings(), echo), command);
    }

    std::optional<Resumption>
    resumption(const CommandLine &command, const std::string &echo, const Parameters &parameters)
    {
      if (!command.resume)
        return {};
      return Resumption(command.output_directory, echo, parameters.press.stroke);
    }

    /// Those the run began with: what made the billet may have changed since.
    Parameters first_parameters(const Parameters &parameters, const std::optional<Resumption> &resumption)
    {
      return resumption ? Parameters::of_record(resumption->header.parameters) : parameters;
    }
  } // namespace

  Simulation::Simulation(const CommandLine &command, MPI_Comm comm)
      : command_(command)
      , comm_(comm)
      , root_(dealii::Utilities::MPI::this_mpi_process(comm) == 0)
      , parameters_(read(command, echo_))
      , resumption_(resumption(command, echo_, parameters_))
      , billet_(make_first_mesh(first_parameters(parameters_, resumption_), timings_, comm))
      , nominal_(parameters_.settle(parameters_.size_of(billet_)).process(parameters_.size_of(billet_)))
      , design_(parameters_.design.all_names(),
                parameters_.billet,
                parameters_.dies,
                nominal_,
                billet_,
                parameters_.press.stroke)
      , mu_(design_.at(parameters_.design.at))
      , process_(design_.process(mu_))
      , X_0_(design_.positions(mu_))
      , model_{make_dies(parameters_, process_),
               parameters_.step_model(),
               parameters_.newton,
               parameters_.linear_solver,
               comm}
      , objectives_(parameters_.make_objectives(model_.dies, billet_))
      , combinations_(parameters_.combinations(objectives_))
      , first_leg_(std::make_shared<Leg>(billet_, model_, timings_))
      , remesher_(parameters_.remeshing, parameters_.edge_length(billet_), model_.dies, billet_.patches, comm)
      , forging_(model_, parameters_.press, remesher_, timings_)
      , trace_(objectives_, model_, process_)
      , stretches_(make_stretches())
  {
    check_scene(parameters_, first_leg_->scene, process_, X_0_);
    if (!parameters_.scan.parameter.empty())
      design_.check_offered(parameters_.scan.parameter, "Scan/parameter");
  }

  Simulation::~Simulation() = default;

  void Simulation::check_outputs() const
  {
    const std::string       &folder = command_.output_directory;
    std::vector<std::string> files  = {
       "parameters.prm", "history.csv", "objectives.csv", "fields.pvd", "summary.json"};
    if (command_.command != "simulate")
      files.push_back("sensitivity.vtu");
    if (parameters_.output.record)
      files.push_back("record.h5");
    for (const Die &die : model_.dies)
      if (die.surface())
      {
        files.push_back("die_" + die.name + ".stl");
        files.push_back("sensitivity_die_" + die.name + ".vtu");
      }
    for (const std::string &file : files)
      check_writable(folder + "/" + file);
  }

  int Simulation::run()
  {
    const auto total = timings_.scope("total");
    prepare_folder();
    if (root_)
    {
      check_outputs();
      write_file(command_.output_directory + "/parameters.prm", echo_);
      const unsigned int ranks = dealii::Utilities::MPI::n_mpi_processes(comm_);
      double             load  = 0.;
      if (getloadavg(&load, 1) != 1)
        load = 0.;
      std::cout << "Retroforge " << version << ' ' << commit << ", " << billet_.n_nodes() << " nodes, "
                << billet_.n_cells() << " tetrahedra, " << ranks << " rank(s), BLAS: " << blas_in_use()
                << '\n'
                << note_on_load(ranks, load, std::thread::hardware_concurrency());
      for (const std::string &sentence : parameters_.without_effect)
        std::cout << "  note: " << sentence << '\n';
      if (process_.stretch != 1.)
        std::cout << "  note: die " << parameters_.dies[process_.leading_die].name
                  << " follows the billet: its path is " << process_.stretch * parameters_.press.stroke
                  << " mm, told as the nominal design's " << parameters_.press.stroke << " mm\n";
      std::cout << std::flush;
    }
    write_dies();
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

  bool Simulation::forge_and_judge()
  {
    bool         passed = true;
    const double begin  = timings_.seconds("total");
    summary_.whole      = whole_part(billet_, nominal_.dies[nominal_.leading_die].velocity);
    forge();
    if (!command_.resume)
      forging_seconds_ = timings_.seconds("total") - begin;
    if (command_.command != "simulate")
      differentiate();
    summarise();
    if (command_.command == "check")
      passed = check();
    write_summary();
    if (root_)
      print_results(summary_, parameters_.contact.largest_depth, untouched_dies(), command_.output_directory);
    return passed;
  }

  std::vector<std::string> Simulation::untouched_dies() const
  {
    std::vector<std::string> names;
    for (unsigned int d = 0; d < model_.dies.size(); ++d)
      if (touched_.count(d) == 0)
        names.push_back(model_.dies[d].name);
    return names;
  }

  void Simulation::prepare_folder() const
  {
    const std::string &folder = command_.output_directory;
    if (resumption_)
      resumption_->check_start(billet_, X_0_, model_.dies);
    MPI_Barrier(comm_); // all have read before anything changes
    if (root_ && command_.resume)
      remove_all_but_record(folder, command_.command == "check");
    else if (root_)
      make_results_folder(folder, command_.overwrite);
  }

  void Simulation::write_dies() const
  {
    if (!root_)
      return;
    for (const Die &die : model_.dies)
      if (die.surface())
        write_stl(command_.output_directory + "/die_" + die.name + ".stl", *die.surface(), StlFormat::binary);
  }

  void Simulation::forge()
  {
    forged_ = forging_.start(first_leg_, X_0_);
    if (root_)
    {
      const std::string &folder = command_.output_directory;
      history_                  = std::make_unique<History>(folder + "/history.csv");
      objective_history_        = std::make_unique<ObjectiveHistory>(folder + "/objectives.csv");
      fields_                   = std::make_unique<FieldWriter>(folder, model_, process_, billet_, X_0_);
      print_head(summary_.whole);
    }
    if (command_.resume)
      resume();
    else if (root_ && parameters_.output.record)
      record_ = std::make_unique<RecordWriter>(
        command_.output_directory,
        RecordHeader{version, commit, echo_, facets(model_.dies), billet_, X_0_, fingerprints(model_.dies)});
    if (root_)
      say_when_stopped(way_on());
    forge_on();
    values_ = trace_.values(forged_, true);
    if (record_)
    {
      const auto timing = timings_.scope("record");
      record_->finish();
    }
    MPI_Barrier(comm_); // the record is complete before any rank reads it
    check_finite(objectives_, values_);
    require_finite(forged_.energy.total(), "Workpiece", "its energy");
    require_finite(volume(forged_.leg->scene.mesh.cells, forged_.X), "Workpiece", "its volume");
  }

  void Simulation::forge_on()
  {
    begin_stroke_  = forged_.stroke;
    begin_seconds_ = timings_.seconds("total");
    bool writes    = false;
    try
    {
      forging_.run(process_, forged_, [&](const IncrementEvent &event) {
        writes = true;
        if (record_)
        {
          const auto timing = timings_.scope("record");
          record_->write(event.record);
        }
        watch(event);
        writes = false;
      });
    }
    catch (const Error &error)
    {
      // Other numerics do not cure a full disk.
      if (writes || forged_.increments == 0 || !(parameters_.output.record || command_.resume))
        throw;
      throw error.or_else(way_on_after_failure());
    }
  }

  std::string Simulation::way_on_after_failure() const
  {
    const std::string remeshing =
      remesher_.enabled() ? "'Remeshing/element size=" + as_text(0.7 * parameters_.edge_length(billet_)) + "'"
                          : "Remeshing/when=quality";
    return "go on from stroke " + as_text(forged_.stroke) +
           " mm, up to which it is recorded, by the same command with --resume" +
           (command_.overwrite ? " in place of --overwrite" : "") +
           " and other numerics, for instance --set Press/increments=" +
           std::to_string(2 * parameters_.press.increments) + " or --set " + remeshing;
  }

  std::string Simulation::way_on() const
  {
    const std::string on = parameters_.output.record || command_.resume
                             ? "the same command with --resume goes on from the last increment"
                             : "without a record (Output/record) it can only begin anew, with --overwrite";
    return "stopped; " + on + "; contrib/report " + command_.output_directory + " shows what there is";
  }

  void Simulation::keep_failure() const
  {
    if (!root_)
      return;
    const std::string message = message_of(std::current_exception());
    try
    {
      write_file(command_.output_directory + "/failure.txt", message + "\n");
      if (fields_ && values_.empty())
        fields_->add_failed(forged_);
    }
    catch (const Error &)
    {
      // What failed first is what the user must know.
    }
  }

  void Simulation::resume()
  {
    const RecordReader record(command_.output_directory);
    const unsigned int n = record.n_increments();
    IncrementRecord    increment;
    forging_.restore(
      process_,
      n,
      [&](const unsigned int i) -> const IncrementRecord & {
        increment = record.read(i);
        return increment;
      },
      forged_,
      [&](const IncrementEvent &event) { watch(event); });
    MPI_Barrier(comm_); // all have read before the writer removes what is torn
    const bool is_left = forging_.is_left(forged_);
    if (is_left)
      change_numerics();
    if (!root_)
      return;
    const std::string &folder = command_.output_directory;
    if (record.finished() && is_left)
      RecordWriter::reopen(folder);
    if (record.finished() && !is_left)
      RecordWriter::tidy(folder);
    else
      record_ = std::make_unique<RecordWriter>(RecordWriter::resume(folder));
    print_resumed();
  }

  void Simulation::change_numerics()
  {
    if (resumption_->changes.empty())
      return;
    Forging::change_numerics(echo_, forged_);
    stretches_.push_back({{forged_.increments, forged_.stroke, echo_}, parameters_});
  }

  void Simulation::print_resumed() const
  {
    std::cout << "  resumed after increment " << forged_.increments << '\n';
    if (!resumption_->changes.empty())
      std::cout << (forging_.is_left(forged_)
                      ? "  with other settings from here on:\n"
                      : "  the forging is done, and other settings do not change it:\n");
    for (const ChangedSetting &setting : resumption_->changes)
      std::cout << "    " << setting.path << " = " << setting.now << ", was " << setting.before << '\n';
    std::cout << std::flush;
  }

  std::vector<Simulation::Stretch> Simulation::make_stretches() const
  {
    std::vector<Stretch> stretches;
    if (resumption_)
      for (const RecordedInput &input : resumption_->inputs)
      {
        stretches.push_back({input, as_solved(Parameters::of_record(input.parameters), command_)});
        stretches.back().parameters.settle(parameters_.size_of(billet_));
      }
    else
    {
      Stretch whole;
      whole.input.parameters = echo_;
      whole.parameters       = parameters_;
      stretches.push_back(whole);
    }
    return stretches;
  }

  void Simulation::watch(const IncrementEvent &event)
  {
    // A check reads the increments many times over; a gradient once, from the record.
    if (command_.command == "check" || (command_.command == "gradient" && !parameters_.output.record))
      records_.push_back(event.record);
    for (std::size_t p = 0; p < event.record.pairs.size(); ++p)
      if (event.record.solves.back().active[p])
        touched_.insert(event.record.pairs[p].die);
    trace(event);
    const auto          timing = timings_.scope("output");
    const ForgingState &state  = event.state;
    const TetMesh      &mesh   = state.leg->scene.mesh;
    if (!root_)
      return;
    const double      quality = minimum_quality(mesh.cells, state.X);
    const double      size    = volume(mesh.cells, state.X);
    const Penetration deepest = deepest_point(
      mesh, state.leg->scene.topology, model_.dies, process_.at_stroke(state.stroke).dies, state.X);
    if (!(deepest.depth <= summary_.deepest.depth))
      summary_.deepest = {deepest.depth,
                          deepest.depth / parameters_.edge_length(billet_),
                          state.stroke,
                          {{deepest.place[0], deepest.place[1], deepest.place[2]}},
                          deepest.die == invalid_index ? "" : model_.dies[deepest.die].name};
    const auto  &leading = nominal_.dies[nominal_.leading_die];
    const double force =
      event.record.forces[nominal_.leading_die] * leading.velocity / leading.velocity.norm();
    const double     energy = state.energy.total();
    const WholePart &whole  = summary_.whole;
    const HistoryRow row{state.increments,
                         event.time,
                         state.stroke,
                         force,
                         energy,
                         size,
                         quality,
                         deepest.depth,
                         event.record.newton,
                         event.record.krylov,
                         whole.force * force,
                         whole.copies * energy,
                         whole.copies * size};
    history_->add(row);
    fields_->follow(event);
    if (event.record.remesh)
      std::printf("      remeshed: %u nodes, %u tetrahedra\n", mesh.n_nodes(), mesh.n_cells());
    print_increment(row,
                    (timings_.seconds("total") - begin_seconds_) * (parameters_.press.stroke - state.stroke) /
                      (state.stroke - begin_stroke_));
    const unsigned int every = parameters_.output.every;
    if (every > 0 &&
        (state.increments % every == 0 || state.stroke >= parameters_.press.stroke * (1. - 1e-9)))
      fields_->add(event);
  }

  void Simulation::trace(const IncrementEvent &event)
  {
    const auto timing = timings_.scope("objectives");
    trace_.add(event);
    const unsigned int every  = parameters_.objectives.every;
    const bool         at_end = event.state.stroke >= parameters_.press.stroke * (1. - 1e-9);
    if (every == 0 || (event.state.increments % every != 0 && !at_end))
      return;
    const auto              values = trace_.values(event.state, true, false);
    const auto              beside = trace_.beside(event.state);
    std::vector<NamedValue> columns;
    for (std::size_t j = 0; j < objectives_.size(); ++j)
    {
      const std::string unit = " [" + objectives_[j].unit() + "]";
      columns.emplace_back(objectives_[j].name + unit, values[j]);
      for (const auto *numbers : {&beside[j].parts, &beside[j].details})
        for (const auto &[name, value] : *numbers)
          columns.emplace_back(objectives_[j].name + ": " + name + unit, value);
    }
    if (root_)
      objective_history_->add(event.state.stroke, columns);
  }

  template <typename Number>
  std::vector<Number> Simulation::combine(const std::vector<Number> &values) const
  {
    std::vector<Number> combined;
    for (const Combination &combination : combinations_)
      combined.push_back(combination(values));
    return combined;
  }

  RecordedForging Simulation::recorded()
  {
    return {model_, first_leg_, process_, source(), forged_.increments, objectives_, timings_};
  }

  void Simulation::differentiate()
  {
    const auto timing = timings_.scope("adjoint");
    const auto values = combine(values_);
    for (std::size_t j = 0; j < combinations_.size(); ++j)
      judged_.push_back(
        {combinations_[j].name, combinations_[j].unit, values[j], std::vector<double>(mu_.size()), {}});
    // A check compares the two methods.
    if (parameters_.adjoint.method == "direct" && command_.command == "gradient")
      differentiate_directly();
    else
      sweep_back();
    for (const Judged &objective : judged_)
    {
      check_finite(objective, design_);
      if (root_)
        print_gradient(objective, design_, mu_);
    }
  }

  void Simulation::sweep_back()
  {
    const AdjointSweep sweep       = adjoint_sweep(recorded(), trace_.rows(), forged_, combinations_);
    summary_.linear_solves_adjoint = sweep.linear_solves;
    for (std::size_t j = 0; j < judged_.size(); ++j)
    {
      const auto timing   = timings_.scope("design");
      judged_[j].gradient = design_.pull_back(mu_, sweep.of[j].X_0, sweep.of[j].process);
      judged_[j].shape    = {sweep.of[j].X_0, {}};
      for (const auto &die : sweep.of[j].process.dies)
        judged_[j].shape.dies.push_back(die.vertices);
    }
    if (root_)
      write_sensitivity();
  }

  void Simulation::differentiate_directly()
  {
    const auto tangent = oracle().tangent;
    for (std::size_t i = 0; i < mu_.size(); ++i)
    {
      std::vector<double> mu_dot(mu_.size(), 0.);
      mu_dot[i]              = 1.;
      const auto derivatives = tangent(mu_dot, {NodalVectors<double>(X_0_.size()), {}});
      for (std::size_t j = 0; j < judged_.size(); ++j)
        judged_[j].gradient[i] = derivatives[j];
    }
  }

  void Simulation::write_sensitivity()
  {
    std::vector<VectorField> fields;
    for (const Judged &objective : judged_)
      fields.push_back({"d" + as_identifier(objective.name) + "_dX0", objective.shape.X_0});
    write_vtu(command_.output_directory + "/sensitivity.vtu", billet_, X_0_, {}, fields, {});
    for (std::size_t d = 0; d < model_.dies.size(); ++d)
      if (const TriangleSurface *surface = model_.dies[d].surface())
      {
        fields.clear();
        for (const Judged &objective : judged_)
          fields.push_back({"d" + as_identifier(objective.name) + "_dXdie", objective.shape.dies[d]});
        write_vtu(
          command_.output_directory + "/sensitivity_die_" + model_.dies[d].name + ".vtu", *surface, fields);
      }
  }

  Forging::Source Simulation::source()
  {
    if (!records_.empty())
      return [this](const unsigned int i) -> const IncrementRecord & { return records_[i]; };
    struct Reader
    {
      RecordReader    file;
      IncrementRecord increment;
    };
    const auto reader = std::make_shared<Reader>(Reader{RecordReader(command_.output_directory), {}});
    return [reader](const unsigned int i) -> const IncrementRecord & {
      reader->increment = reader->file.read(i);
      return reader->increment;
    };
  }

  namespace
  {
    /// Moves the vertices of the dies from where a process has them.
    template <typename Number, typename Shift>
    void move_dies(const std::vector<Die> &dies,
                   const FreeForm         &shift,
                   const Shift            &moved,
                   Process<Number>        &process)
    {
      for (std::size_t d = 0; d < shift.dies.size(); ++d)
      {
        if (shift.dies[d].empty())
          continue;
        NodalVectors<Number> vertices;
        for (std::size_t k = 0; k < shift.dies[d].size(); ++k)
        {
          Vector3<Number> x;
          for (unsigned int i = 0; i < 3; ++i)
            x[i] = moved(process.dies[d].vertices.empty() ? Number(dies[d].surface()->vertices()[k][i])
                                                          : process.dies[d].vertices[k][i],
                         shift.dies[d][k][i]);
          vertices.push_back(x);
        }
        process.dies[d].vertices = std::move(vertices);
      }
    }

    double sum_of(const double x, const double shift)
    {
      return x + shift;
    }

    Dual dual_of(Dual x, const double direction)
    {
      x.fastAccessDx(0) += direction;
      return x;
    }
  } // namespace

  std::vector<double> Simulation::forge_anew(const Process<double>      &process,
                                             const NodalVectors<double> &X_0) const
  {
    ForgingModel    model   = model_;
    Process<double> at_dies = process;
    for (std::size_t d = 0; d < model.dies.size(); ++d)
      if (auto vertices = std::exchange(at_dies.dies[d].vertices, {}); !vertices.empty())
        model.dies[d] = model.dies[d].moved(std::move(vertices));
    Timings          timings;
    const Objectives objectives = parameters_.make_objectives(model.dies, billet_);
    ObjectiveTrace   trace(objectives, model, at_dies);
    ForgingState     state;
    for (std::size_t s = 0; s < stretches_.size(); ++s)
    {
      const Parameters &numerics = stretches_[s].parameters;
      PressParameters   press    = numerics.press;
      if (s + 1 < stretches_.size())
        press.stroke = stretches_[s + 1].input.stroke;
      model.step          = numerics.step_model();
      model.newton        = numerics.newton;
      model.linear_solver = numerics.linear_solver;
      const Remesher remesher(
        numerics.remeshing, numerics.edge_length(billet_), model.dies, billet_.patches, comm_);
      const Forging forging(model, press, remesher, timings);
      if (s == 0)
        state = forging.start(std::make_shared<Leg>(billet_, model, timings), X_0);
      else
        Forging::change_numerics("", state);
      forging.run(at_dies, state, [&](const IncrementEvent &event) { trace.add(event); });
    }
    return combine(trace.values(state, true));
  }

  ObjectiveOracle Simulation::oracle()
  {
    ObjectiveOracle oracle;
    const auto      recorded   = this->recorded();
    const auto      process_at = [this](const std::vector<double> &mu, const FreeForm &shift) {
      Process<double> process = design_.process(mu);
      move_dies(model_.dies, shift, sum_of, process);
      return process;
    };
    oracle.free = [this, process_at](const std::vector<double> &mu, const FreeForm &shift) {
      return forge_anew(process_at(mu, shift), sum(design_.positions(mu), shift.X_0));
    };
    oracle.replayed = [this, recorded, process_at](const std::vector<double> &mu, const FreeForm &shift) {
      const Process<double> process = process_at(mu, shift);
      ObjectiveTrace        trace(objectives_, model_, process);
      ForgingState          state = forging_.start(first_leg_, sum(design_.positions(mu), shift.X_0));
      forging_.replay(
        process, recorded.n, recorded.source, state, [&](const IncrementEvent &event) { trace.add(event); });
      return combine(trace.values(state, false));
    };
    oracle.tangent = [this, recorded](const std::vector<double> &mu_dot, const FreeForm &shift_dot) {
      std::vector<Dual> mu;
      for (std::size_t j = 0; j < mu_.size(); ++j)
        mu.push_back(dual_of(Dual(mu_[j]), mu_dot[j]));
      NodalVectors<Dual> X = design_.positions(mu);
      for (std::size_t k = 0; k < X.size(); ++k)
        for (unsigned int i = 0; i < 3; ++i)
          X[k][i].fastAccessDx(0) += shift_dot.X_0[k][i];
      Process<Dual> process = design_.process(mu);
      move_dies(model_.dies, shift_dot, dual_of, process);
      std::vector<double> derivatives;
      for (const Dual &value : combine(tangent_sweep(recorded, process, X)))
        derivatives.push_back(value.dx(0));
      return derivatives;
    };
    return oracle;
  }

  bool Simulation::check()
  {
    const double                begin = timings_.seconds("total");
    std::optional<unsigned int> before; // directions that were done
    const ObjectiveOracle       oracle = this->oracle();
    std::vector<Judged>         judged = judged_;
    if (command_.resume)
    {
      // The record may be of a run that was solved less well than its replays are here.
      const auto values = oracle.replayed(mu_, {NodalVectors<double>(X_0_.size()), {}});
      for (std::size_t j = 0; j < judged.size(); ++j)
        judged[j].value = values[j];
    }
    const auto rows = check_gradient(
      parameters_.check,
      design_,
      mu_,
      judged,
      parameters_.size_of(billet_).side,
      oracle,
      kept_check(),
      [&](const std::vector<CheckRow> &so_far, const unsigned int done, const unsigned int all) {
        keep_check(so_far, all - done);
        if (root_ && before)
          print_check_progress(so_far, *before, done, all, timings_.seconds("total") - begin);
        else if (root_)
          print_check_begin(all, done, parameters_.check.n_runs(), forging_seconds_);
        before = before.value_or(done);
      });
    if (root_)
      print(rows, std::cout);
    return std::all_of(rows.begin(), rows.end(), [](const CheckRow &row) { return row.passed; });
  }

  void Simulation::keep_check(const std::vector<CheckRow> &rows, const unsigned int remaining)
  {
    summary_.check.clear();
    for (const CheckRow &row : rows)
      summary_.check.push_back(as_summary(row));
    summary_.check_remaining = remaining;
    write_summary();
    if (root_)
      CheckFile{program, echo_, forged_.increments, forged_.stroke, rows}.write(command_.output_directory +
                                                                                "/check.json");
  }

  std::vector<CheckRow> Simulation::kept_check() const
  {
    if (!command_.resume)
      return {};
    CheckFile kept = CheckFile::read(command_.output_directory + "/check.json");
    MPI_Barrier(comm_); // all have read before it is written again
    const bool is_of_this = kept.program == program && kept.n_increments == forged_.increments &&
                            kept.stroke == forged_.stroke && make_same_check(kept.parameters, echo_);
    return is_of_this ? std::move(kept.rows) : std::vector<CheckRow>();
  }

  void Simulation::summarise()
  {
    summary_.command               = command_.command;
    summary_.version               = version;
    summary_.commit                = commit;
    summary_.blas                  = blas_in_use();
    summary_.ranks                 = dealii::Utilities::MPI::n_mpi_processes(comm_);
    summary_.n_nodes               = billet_.n_nodes();
    summary_.n_cells               = billet_.n_cells();
    summary_.newton_iterations     = forged_.newton;
    summary_.krylov_iterations     = forged_.krylov;
    summary_.linear_solves_forward = forged_.linear_solves;
    summary_.remeshings            = forged_.remeshed.size();
    summary_.increments            = forged_.increments;
    summary_.cuts                  = forged_.cuts;
    summary_.volume_initial        = volume(billet_.cells, X_0_);
    summary_.volume_final          = volume(forged_.leg->scene.mesh.cells, forged_.X);
    summary_.volume_repaired       = forged_.repaired;
    summarise_objectives();
    summarise_restarts();
    for (std::size_t j = 0; j < mu_.size() && !judged_.empty(); ++j)
    {
      const DesignParameter &parameter = design_.parameters()[j];
      summary_.parameters.push_back({parameter.name, mu_[j], parameter.unit, {}, parameter.scale});
      for (const Judged &objective : judged_)
        summary_.parameters.back().gradient[objective.name] = objective.gradient[j];
    }
    if (record_)
      summary_.record_bytes = record_->bytes();
  }

  void Simulation::summarise_objectives()
  {
    const auto beside = trace_.beside(forged_);
    for (std::size_t o = 0; o < objectives_.size(); ++o)
      summary_.objectives.push_back({objectives_[o].name,
                                     values_[o],
                                     objectives_[o].unit(),
                                     beside[o].parts,
                                     beside[o].details,
                                     copies(objectives_[o]) * values_[o]});
    if (parameters_.objectives.gradients == "combined")
      summary_.objectives.push_back(
        {combinations_[0].name, combine(values_)[0], combinations_[0].unit, {}, {}});
  }

  void Simulation::summarise_restarts()
  {
    for (std::size_t s = 1; s < stretches_.size(); ++s)
    {
      const RecordedInput &input = stretches_[s].input;
      summary_.restarts.push_back({input.first + 1, input.stroke, {}});
      for (const ChangedSetting &setting :
           changed_numerics(stretches_[s - 1].input.parameters, input.parameters))
        summary_.restarts.back().changed[setting.path] = {setting.before, setting.now};
    }
  }

  void Simulation::write_summary()
  {
    summary_.wall_seconds = timings_.all();
    if (root_)
      summary_.write(command_.output_directory + "/summary.json");
  }

  double Simulation::copies(const NamedObjective &objective) const
  {
    if (objective.extent == Extent::none)
      return Summary::unknown;
    return objective.extent == Extent::part
             ? summary_.whole.copies
             : whole_part(billet_, process_.dies[objective.die].velocity).force;
  }
} // namespace retroforge
