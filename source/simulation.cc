// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/contact/penetration.h>
#include <retroforge/core/error.h>
#include <retroforge/core/text.h>
#include <retroforge/core/version.h>
#include <retroforge/geometry/stl_file.h>
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/objective/surface_areas.h>
#include <retroforge/output/blas.h>
#include <retroforge/output/results_folder.h>
#include <retroforge/output/safe_file.h>
#include <retroforge/output/vtu_writer.h>
#include <retroforge/record/record_file.h>
#include <retroforge/resume.h>
#include <retroforge/simulation.h>
#include <retroforge/solver/rigid_modes.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <iostream>
#include <numeric>
#include <sstream>
#include <utility>

namespace retroforge
{
  namespace
  {
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
          if (process.dies[d].vertices)
            dies[d] = dies[d].moved(*process.dies[d].vertices);
      return dies;
    }

    std::vector<unsigned int> facets(const std::vector<Die> &dies)
    {
      std::vector<unsigned int> n;
      for (const Die &die : dies)
        n.push_back(die.n_facets());
      return n;
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
      return Remesher(parameters.remeshing, parameters.edge_length(mesh), dies, comm)
        .remesh(mesh, mesh.X, states, timings)
        ->mesh;
    }

    /// "check" solves all systems as well as they can be, or differences would measure the solvers.
    Parameters read(const CommandLine &command, std::string &echo)
    {
      Parameters parameters = Parameters::read(command.case_file, command.settings(), echo);
      if (command.command == "check")
      {
        parameters.newton.tolerance  = std::min(parameters.newton.tolerance, 1e-12);
        parameters.adjoint.tolerance = std::min(parameters.adjoint.tolerance, 1e-14);
      }
      return parameters;
    }
  } // namespace

  Simulation::Simulation(const CommandLine &command, MPI_Comm comm)
      : command_(command)
      , comm_(comm)
      , root_(dealii::Utilities::MPI::this_mpi_process(comm) == 0)
      , parameters_(read(command, echo_))
      , billet_(make_first_mesh(parameters_, timings_, comm))
      , nominal_(parameters_.settle(billet_size()).process(billet_size()))
      , design_(parameters_.design.all_names(), parameters_.billet, parameters_.dies, nominal_, billet_)
      , mu_(design_.at(parameters_.design.at))
      , process_(design_.process(mu_))
      , X_0_(design_.positions(mu_))
      , model_{make_dies(parameters_, process_),
               parameters_.step_model(),
               parameters_.newton,
               parameters_.linear_solver,
               comm}
      , objectives_(parameters_.make_objectives(model_.dies))
      , combinations_(parameters_.combinations(objectives_))
      , first_leg_(std::make_shared<Leg>(billet_, model_, timings_))
      , remesher_(parameters_.remeshing, parameters_.edge_length(billet_), model_.dies, comm)
      , forging_(model_, parameters_.press, remesher_, timings_)
      , trace_(objectives_, model_, process_)
  {
    check_billet_against_dies();
  }

  Simulation::~Simulation() = default;

  double Simulation::billet_size() const
  {
    return std::cbrt(volume(billet_.cells, billet_.X));
  }

  void Simulation::check_billet_against_dies() const
  {
    // A neighbour of a sound design may begin a little inside a die: contact pushes it out as the run begins.
    const double allowed = (parameters_.design.at.empty() ? 1e-3 : 0.05) * billet_size();
    double       nearest = std::numeric_limits<double>::max();
    for (unsigned int d = 0; d < model_.dies.size(); ++d)
    {
      const double least_depth = 0.1 * parameters_.edge_length(billet_);
      if (model_.dies[d].surface() && parameters_.dies[d].depth > 0. &&
          parameters_.dies[d].depth < least_depth)
        throw Error("Die " + parameters_.dies[d].name + "/depth of contact",
                    "is " + as_text(parameters_.dies[d].depth) + " mm",
                    "nodes deeper are lost to the die, so it must be a tenth of the element size at least, " +
                      as_text(least_depth) + " mm",
                    "leave it out, which takes a tenth of the die's extent");
      double deepest = 0.;
      for (NodeIndex k = 0; k < billet_.n_nodes(); ++k)
        if (first_leg_->scene.topology.is_on_surface(k))
        {
          const double delta = model_.dies[d].signed_distance(X_0_[k], process_.dies[d].displacement);
          nearest            = std::min(nearest, delta);
          deepest            = std::max(deepest, -delta);
        }
      if (deepest > allowed)
        throw Error(
          "Die " + parameters_.dies[d].name,
          "the billet stands " + as_text(deepest) + " mm inside it",
          "a billet starts outside of all dies",
          "move the die's point, or the billet (Billet/translation), or turn the die's facing round");
    }
    if (nearest > parameters_.press.stroke + billet_size())
      throw Error("Dies",
                  "none comes near the billet: the nearest is " + as_text(nearest) + " mm away",
                  "a die must be within the stroke of " + as_text(parameters_.press.stroke) + " mm",
                  "move the dies' points or the billet");
    if (const unsigned int n = n_free_rigid_modes(first_leg_->scene, process_.at_stroke(0.), X_0_); n > 0)
      throw Error("Dies",
                  "the billet can slide or spin freely in " + std::to_string(n) + " rigid motion(s)",
                  "its velocity must be unique",
                  "cut it by symmetry planes, or give a die some friction");
  }

  int Simulation::run()
  {
    const auto total = timings_.scope("total");
    prepare_folder();
    if (root_)
    {
      write_file(command_.output_directory + "/parameters.prm", echo_);
      std::cout << "Retroforge " << version << ' ' << commit << ", " << billet_.n_nodes() << " nodes, "
                << billet_.n_cells() << " tetrahedra, " << dealii::Utilities::MPI::n_mpi_processes(comm_)
                << " rank(s), BLAS: " << blas_in_use() << std::endl;
    }
    write_dies();
    bool passed = true;
    forge();
    if (command_.command != "simulate")
      differentiate();
    if (command_.command == "check")
      passed = check();
    summarise();
    return passed ? 0 : 1;
  }

  void Simulation::prepare_folder() const
  {
    const std::string &folder = command_.output_directory;
    if (command_.resume)
      check_resumable(RecordReader(folder).header(), echo_, billet_, X_0_, model_.dies, folder);
    if (root_ && command_.resume)
      remove_all_but_record(folder);
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
    ForgingState state = forging_.start(first_leg_, X_0_);
    if (root_)
    {
      history_           = std::make_unique<History>(command_.output_directory + "/history.csv");
      objective_history_ = std::make_unique<ObjectiveHistory>(command_.output_directory + "/objectives.csv");
      pvd_               = std::make_unique<PvdWriter>(command_.output_directory + "/fields.pvd");
      std::cout << "  inc   stroke      force        energy        volume   quality   depth newton krylov   "
                   "time left\n";
    }
    if (command_.resume)
      resume(state);
    else if (root_ && parameters_.output.record)
      record_ = std::make_unique<RecordWriter>(
        command_.output_directory, RecordHeader{version, commit, echo_, facets(model_.dies), billet_, X_0_});
    forging_.run(process_, state, [&](const IncrementEvent &event) {
      if (record_)
      {
        const auto timing = timings_.scope("record");
        record_->write(event.record);
      }
      watch(event);
    });
    forged_ = std::move(state);
    values_ = trace_.values(forged_, true);
    if (record_)
    {
      const auto timing = timings_.scope("record");
      record_->finish();
    }
    MPI_Barrier(comm_); // the record is complete before any rank reads it
  }

  void Simulation::resume(ForgingState &state)
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
      state,
      [&](const IncrementEvent &event) { watch(event); });
    MPI_Barrier(comm_); // all have read before the writer removes what is torn
    if (root_ && !record.finished())
      record_ = std::make_unique<RecordWriter>(RecordWriter::resume(command_.output_directory));
    if (root_)
      std::cout << "  resumed after increment " << n << std::endl;
  }

  void Simulation::watch(const IncrementEvent &event)
  {
    // A check reads the increments many times over; a gradient once, from the record.
    if (command_.command == "check" || (command_.command == "gradient" && !parameters_.output.record))
      records_.push_back(event.record);
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
    const double energy = state.energy.total();
    history_->add({state.increments,
                   event.time,
                   state.stroke,
                   force,
                   energy,
                   size,
                   quality,
                   deepest.depth,
                   event.record.newton,
                   event.record.krylov});
    if (event.record.remesh)
      std::printf("      remeshed: %u nodes, %u tetrahedra\n", mesh.n_nodes(), mesh.n_cells());
    const double left = timings_.seconds("total") * (parameters_.press.stroke - state.stroke) / state.stroke;
    std::printf("%5u %8.4f %12.5g %13.7g %13.7g %8.4f %7.3f %6u %6u %8.0f s\n",
                state.increments,
                state.stroke,
                force,
                energy,
                size,
                quality,
                deepest.depth,
                event.record.newton,
                event.record.krylov,
                left);
    std::fflush(stdout);
    const unsigned int every = parameters_.output.every;
    if (every > 0 &&
        (state.increments % every == 0 || state.stroke >= parameters_.press.stroke * (1. - 1e-9)))
      write_fields(event);
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
    const auto              parts  = trace_.parts(event.state);
    std::vector<NamedValue> columns;
    for (std::size_t j = 0; j < objectives_.size(); ++j)
    {
      const std::string unit = " [" + objectives_[j].unit() + "]";
      columns.emplace_back(objectives_[j].name + unit, values[j]);
      for (const auto &[name, value] : parts[j])
        columns.emplace_back(objectives_[j].name + ": " + name + unit, value);
    }
    if (root_)
      objective_history_->add(event.state.stroke, columns);
  }

  void Simulation::write_fields(const IncrementEvent &event)
  {
    const ForgingState  &run   = event.state;
    const Scene         &scene = run.leg->scene;
    const TetMesh       &mesh  = scene.mesh;
    const Field<double> &W     = run.W;
    ScalarField pressure{"pressure", W.P}, state{"contact_state", std::vector<double>(mesh.n_nodes(), 0.)},
      contact_pressure{"contact_pressure", std::vector<double>(mesh.n_nodes(), 0.)}, rate{"strain_rate", {}};
    const LastStage      last(scene, model_.step, process_, event.X_before, event.record);
    const Stage<double> &stage = last.stage;
    std::vector<double>  force(mesh.n_nodes(), 0.);
    for (unsigned int p = 0; p < event.record.pairs.size(); ++p)
    {
      const auto          node  = stage.contact_node(p, W, event.record.solves.back().active);
      const ContactPoint &point = event.record.pairs[p].point;
      if (node.active)
        for (unsigned int i = 0; i < point.n_nodes(); ++i)
        {
          const NodeIndex k = point.nodes[i];
          state.values[k]   = event.record.pairs[p].die + 1.;
          force[k] += point.weight() * stage.physics.contact.rho * node.S * approach_excess(node);
        }
    }
    const std::vector<double> area = lumped_areas(surface_triangles(mesh), stage.X);
    for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
      if (force[k] > 0.)
        contact_pressure.values[k] = force[k] / area[k];
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    {
      const auto e =
        cell_strain_rates(cell_geometry(positions_of_cell(mesh, stage.X, c)), W.on_cell(mesh, c));
      rate.values.push_back(0.25 * (e[0] + e[1] + e[2] + e[3]));
    }
    if (pvd_->steps().empty())
    {
      write_vtu(command_.output_directory + "/fields_000000.vtu", billet_, X_0_, {}, {}, {});
      pvd_->add(0., "fields_000000.vtu");
    }
    char name[32];
    std::snprintf(name, sizeof name, "fields_%06u.vtu", run.increments);
    write_vtu(command_.output_directory + "/" + name,
              mesh,
              run.X,
              {pressure, state, contact_pressure},
              {{"velocity", W.V}},
              {rate, {"equivalent_strain", run.strain}});
    pvd_->add(event.time, name);
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
    if (root_)
      print_gradient();
  }

  void Simulation::sweep_back()
  {
    const AdjointSweep sweep       = adjoint_sweep(recorded(), trace_.rows(), forged_, combinations_);
    summary_.linear_solves_adjoint = sweep.linear_solves;
    for (std::size_t j = 0; j < judged_.size(); ++j)
    {
      const auto timing   = timings_.scope("design");
      judged_[j].gradient = design_.pull_back(mu_, sweep.of[j].X_0, sweep.of[j].process);
      judged_[j].shape    = {sweep.of[j].X_0, sweep.of[j].process.die_vertices};
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

  void Simulation::print_gradient() const
  {
    for (const Judged &objective : judged_)
    {
      // What a forger would turn first: by what one per cent of the parameter's size does.
      std::vector<std::size_t> order(mu_.size());
      std::iota(order.begin(), order.end(), 0);
      const std::string unit   = objective.unit == "none" ? "" : " " + objective.unit;
      const auto        effect = [&](const std::size_t j) {
        return 0.01 * design_.parameters()[j].scale * objective.gradient[j];
      };
      std::stable_sort(order.begin(), order.end(), [&](const std::size_t a, const std::size_t b) {
        return std::abs(effect(a)) > std::abs(effect(b));
      });
      std::printf("\n  gradient of %s = %.10g%s\n  %-24s %14s   %18s   for +1 %%\n",
                  objective.name.c_str(),
                  objective.value,
                  unit.c_str(),
                  "parameter",
                  "value",
                  "derivative");
      for (const std::size_t j : order)
        std::printf("  %-24s %14.8g   %18.12g   %+.4g%s\n",
                    design_.parameters()[j].name.c_str(),
                    mu_[j],
                    objective.gradient[j],
                    effect(j),
                    unit.c_str());
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
            x[i] = moved(process.dies[d].vertices ? (*process.dies[d].vertices)[k][i]
                                                  : Number(dies[d].surface()->vertices()[k][i]),
                         shift.dies[d][k][i]);
          vertices.push_back(x);
        }
        process.dies[d].vertices = std::make_shared<const NodalVectors<Number>>(std::move(vertices));
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
      if (const auto vertices = std::exchange(at_dies.dies[d].vertices, nullptr))
        model.dies[d] = model.dies[d].moved(*vertices);
    Timings          timings;
    const Remesher   remesher(parameters_.remeshing, parameters_.edge_length(billet_), model.dies, comm_);
    const Forging    forging(model, parameters_.press, remesher, timings);
    const Objectives objectives = parameters_.make_objectives(model.dies);
    ObjectiveTrace   trace(objectives, model, at_dies);
    ForgingState     state = forging.start(std::make_shared<Leg>(billet_, model, timings), X_0);
    forging.run(at_dies, state, [&](const IncrementEvent &event) { trace.add(event); });
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
    checks_ = check_gradient(parameters_.check, design_, mu_, judged_, billet_size(), oracle());
    if (root_)
      print(checks_, std::cout);
    return std::all_of(checks_.begin(), checks_.end(), [](const CheckRow &row) { return row.passed; });
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
    summary_.wall_seconds          = timings_.all();
    const auto parts               = trace_.parts(forged_);
    for (std::size_t o = 0; o < objectives_.size(); ++o)
      summary_.objectives.push_back({objectives_[o].name, values_[o], objectives_[o].unit(), parts[o]});
    if (parameters_.objectives.gradients == "combined")
      summary_.objectives.push_back({combinations_[0].name, combine(values_)[0], combinations_[0].unit, {}});
    for (std::size_t j = 0; j < mu_.size() && !judged_.empty(); ++j)
    {
      summary_.parameters.push_back({design_.parameters()[j].name, mu_[j], design_.parameters()[j].unit, {}});
      for (const Judged &objective : judged_)
        summary_.parameters.back().gradient[objective.name] = objective.gradient[j];
    }
    for (const CheckRow &row : checks_)
    {
      Summary::Check check{row.objective,
                           row.parameter,
                           row.adjoint,
                           row.tangent,
                           {},
                           row.taylor_orders,
                           row.is_zero  ? "zero"
                           : row.passed ? "passed"
                                        : "failed"};
      for (const auto &d : row.steps)
        check.steps.push_back(
          {d.step, d.replayed_central, d.replayed_forward, d.replayed_backward, d.free_central});
      summary_.check.push_back(check);
    }
    if (!root_)
      return;
    if (record_)
      summary_.record_bytes = record_->bytes();
    summary_.write(command_.output_directory + "/summary.json");
    std::printf("\n");
    for (const Summary::Objective &objective : summary_.objectives)
    {
      std::printf("  %s %.12g %s", objective.name.c_str(), objective.value, objective.unit.c_str());
      for (const auto &[name, value] : objective.parts)
        std::printf("%s%s %.6g", name == objective.parts.begin()->first ? " (" : ", ", name.c_str(), value);
      std::printf("%s\n", objective.parts.empty() ? "" : ")");
    }
    if (summary_.deepest.relative > parameters_.contact.largest_depth)
      std::printf(
        "  warning: the surface was up to %.3g mm (%.1f %% of the element size) inside die %s, at (%.4g, "
        "%.4g, "
        "%.4g) and stroke %.5g: what is inside does no work. More increments, a smaller Contact/edge sinking "
        "or Remeshing/chord error hold it out.\n",
        summary_.deepest.depth,
        100. * summary_.deepest.relative,
        summary_.deepest.die.c_str(),
        summary_.deepest.place[0],
        summary_.deepest.place[1],
        summary_.deepest.place[2],
        summary_.deepest.stroke);
    if (summary_.volume_repaired > 0.)
      std::printf("  the surface crossed itself in places thinner than an element: %.3g mm^3 were taken away "
                  "there, and put back elsewhere\n",
                  summary_.volume_repaired);
    std::printf("  volume change %.3g, %.1f s\n  results in %s\n",
                summary_.volume_final / summary_.volume_initial - 1.,
                timings_.seconds("total"),
                command_.output_directory.c_str());
  }
} // namespace retroforge
