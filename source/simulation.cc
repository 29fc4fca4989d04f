// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/version.h>
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/output/blas.h>
#include <retroforge/output/safe_file.h>
#include <retroforge/output/vtu_writer.h>
#include <retroforge/record/record_file.h>
#include <retroforge/simulation.h>
#include <retroforge/solver/rigid_modes.h>

#include <cstdio>
#include <iostream>
#include <sstream>

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

    NodalVectors<double> sum(NodalVectors<double> a, const NodalVectors<double> &b)
    {
      for (std::size_t k = 0; k < a.size(); ++k)
        a[k] += b[k];
      return a;
    }

    /// "check" solves all systems as well as they can be, or differences would measure the solvers.
    Parameters read(const CommandLine &command, std::string &echo)
    {
      if (command.resume)
        throw Error("--resume",
                    "this version cannot go on with a run",
                    "its record can be read, differentiated and replayed, but not continued",
                    "run the case anew, without --resume");
      Parameters parameters = Parameters::read(command.case_file, command.overrides, echo);
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
      , scene_(make_billet(parameters_.billet, comm), make_dies(parameters_.dies), comm)
      , nominal_(parameters_.settle(mesh_size()).process(mesh_size()))
      , model_(parameters_.step_model())
      , design_(parameters_.design.names, parameters_.billet, parameters_.dies, nominal_, scene_.mesh.X)
      , system_(scene_, parameters_.linear_solver, timings_)
      , increment_(scene_, model_, parameters_.newton, system_, timings_)
      , forging_(scene_, parameters_.press, increment_)
      , mu_(design_.nominal())
      , process_(design_.process(mu_))
      , X_0_(design_.positions(mu_))
  {
    check_billet_against_dies();
  }

  Simulation::~Simulation() = default;

  double Simulation::mesh_size() const
  {
    return std::cbrt(volume(scene_.mesh.cells, scene_.mesh.X));
  }

  void Simulation::check_billet_against_dies() const
  {
    double nearest = std::numeric_limits<double>::max();
    for (unsigned int d = 0; d < scene_.dies.size(); ++d)
    {
      double deepest = 0.;
      for (NodeIndex k = 0; k < scene_.mesh.n_nodes(); ++k)
        if (scene_.topology.is_on_surface(k))
        {
          const double delta = scene_.dies[d].project(X_0_[k], Vec3()).delta;
          nearest            = std::min(nearest, delta);
          deepest            = std::max(deepest, -delta);
        }
      if (deepest > 1e-3 * mesh_size())
        throw Error(
          "Die " + parameters_.dies[d].name,
          "the billet stands " + std::to_string(deepest) + " mm inside it",
          "a billet starts outside of all dies",
          "move the die's point, or the billet (Billet/translation), or turn the die's facing round");
    }
    if (nearest > parameters_.press.stroke + mesh_size())
      throw Error("Dies",
                  "none comes near the billet: the nearest is " + std::to_string(nearest) + " mm away",
                  "a die must be within the stroke of " + std::to_string(parameters_.press.stroke) + " mm",
                  "move the dies' points or the billet");
    if (const unsigned int n = n_free_rigid_modes(scene_, process_.at_stroke(0.), X_0_); n > 0)
      throw Error("Dies",
                  "the billet can slide or spin freely in " + std::to_string(n) + " rigid motion(s)",
                  "its velocity must be unique",
                  "cut it by symmetry planes, or give a die some friction");
  }

  int Simulation::run()
  {
    const auto total = timings_.scope("total");
    if (root_)
    {
      make_directory(command_.output_directory);
      write_file(command_.output_directory + "/parameters.prm", echo_);
      std::cout << "Retroforge " << version << ' ' << commit << ", " << scene_.mesh.n_nodes() << " nodes, "
                << scene_.mesh.n_cells() << " tetrahedra, " << dealii::Utilities::MPI::n_mpi_processes(comm_)
                << " rank(s), BLAS: " << blas_in_use() << std::endl;
    }
    bool passed = true;
    forge();
    if (command_.command != "simulate")
      differentiate();
    if (command_.command == "check")
      passed = check();
    summarise();
    return passed ? 0 : 1;
  }

  void Simulation::forge()
  {
    if (root_)
    {
      history_ = std::make_unique<History>(command_.output_directory + "/history.csv");
      pvd_     = std::make_unique<PvdWriter>(command_.output_directory + "/fields.pvd");
      if (parameters_.output.record)
        record_ = std::make_unique<RecordWriter>(
          command_.output_directory,
          RecordHeader{
            version, commit, echo_, static_cast<unsigned int>(scene_.dies.size()), scene_.mesh, X_0_});
      std::cout
        << "  inc   stroke      force        energy        volume   quality newton krylov   time left\n";
    }
    forged_ = forging_.run(process_, X_0_, [&](const IncrementEvent &event) { watch(event); });
    if (record_)
    {
      const auto timing = timings_.scope("record");
      record_->finish();
    }
    MPI_Barrier(comm_); // the record is complete before any rank reads it
    summary_.linear_solves_forward = system_.n_solves;
    summary_.newton_iterations     = forged_.newton;
    summary_.krylov_iterations     = forged_.krylov;
  }

  void Simulation::watch(const IncrementEvent &event)
  {
    // A check reads the increments many times over; a gradient once, from the record.
    if (command_.command == "check" || (command_.command == "gradient" && !parameters_.output.record))
      records_.push_back(event.record);
    const auto   timing  = timings_.scope("record");
    const double quality = minimum_quality(scene_.mesh.cells, event.X);
    const double size    = volume(scene_.mesh.cells, event.X);
    if (!root_)
      return;
    if (record_)
      record_->write(event.record);
    const auto  &leading = nominal_.dies[nominal_.leading_die];
    const double force =
      event.report.forces[nominal_.leading_die] * leading.velocity / leading.velocity.norm();
    const double stroke = event.record.stroke + event.record.step;
    history_->add({event.index,
                   event.time,
                   stroke,
                   force,
                   event.energy,
                   size,
                   quality,
                   event.report.newton.iterations,
                   event.report.newton.krylov});
    const double left = timings_.seconds("total") * (parameters_.press.stroke - stroke) / stroke;
    std::printf("%5u %8.4f %12.5g %13.7g %13.7g %8.4f %6u %6u %8.0f s\n",
                event.index,
                stroke,
                force,
                event.energy,
                size,
                quality,
                event.report.newton.iterations,
                event.report.newton.krylov,
                left);
    std::fflush(stdout);
    const unsigned int every = parameters_.output.every;
    if (every > 0 && (event.index % every == 0 || stroke >= parameters_.press.stroke * (1. - 1e-9)))
      write_fields(event);
  }

  void Simulation::write_fields(const IncrementEvent &event)
  {
    const TetMesh &mesh = scene_.mesh;
    ScalarField    pressure{"pressure", event.W.P},
      state{"contact_state", std::vector<double>(mesh.n_nodes(), 0.)},
      contact_pressure{"contact_pressure", std::vector<double>(mesh.n_nodes(), 0.)}, rate{"strain_rate", {}};
    const auto          physics  = process_.at_stroke(event.record.stroke);
    const auto          position = increment_.stage_positions(process_, event.X_before, event.record);
    ContactSet<double>  contact  = make_contact_set(mesh,
                                                  scene_.topology,
                                                  scene_.dies,
                                                  physics.dies,
                                                  event.record.pairs,
                                                  model_.ramp,
                                                  model_.approach * event.record.step / process_.speed(),
                                                  event.X_before,
                                                  model_.layer);
    const Stage<double> stage(scene_, physics, contact, position);
    for (unsigned int p = 0; p < event.record.pairs.size(); ++p)
    {
      const auto      node = stage.contact_node(p, event.W, event.record.solves.back().active);
      const NodeIndex k    = event.record.pairs[p].node;
      if (node.active)
      {
        state.values[k] = event.record.pairs[p].die + 1.;
        contact_pressure.values[k] += physics.contact.rho * approach_excess(node);
      }
    }
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    {
      const auto e =
        cell_strain_rates(cell_geometry(positions_of_cell(mesh, position, c)), event.W.on_cell(mesh, c));
      rate.values.push_back(0.25 * (e[0] + e[1] + e[2] + e[3]));
    }
    if (event.index == parameters_.output.every)
    {
      write_vtu(command_.output_directory + "/fields_000000.vtu", mesh, X_0_, {}, {}, {});
      pvd_->add(0., "fields_000000.vtu");
    }
    char name[32];
    std::snprintf(name, sizeof name, "fields_%06u.vtu", event.index);
    write_vtu(command_.output_directory + "/" + name,
              mesh,
              event.X,
              {pressure, state, contact_pressure},
              {{"velocity", event.W.V}},
              {rate});
    pvd_->add(event.time, name);
  }

  void Simulation::differentiate()
  {
    const auto         timing = timings_.scope("adjoint");
    const unsigned int before = system_.n_solves;
    const auto result = adjoint_sweep(scene_, increment_, process_, forged_.X, forged_.increments, source());
    X_0_bar_          = result.X_0;
    gradient_         = design_.pull_back(mu_, X_0_bar_, result.process);
    summary_.linear_solves_adjoint = system_.n_solves - before;
    if (root_)
    {
      write_sensitivity();
      std::cout << "\n  gradient of the energy\n";
      for (std::size_t j = 0; j < mu_.size(); ++j)
        std::printf("  %-24s %14.8g   d/d = %18.12g mJ/(%s)\n",
                    design_.parameters()[j].name.c_str(),
                    mu_[j],
                    gradient_[j],
                    design_.parameters()[j].unit.c_str());
    }
  }

  void Simulation::write_sensitivity()
  {
    write_vtu(
      command_.output_directory + "/sensitivity.vtu", scene_.mesh, X_0_, {}, {{"denergy_dX0", X_0_bar_}}, {});
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

  ObjectiveOracle Simulation::oracle()
  {
    ObjectiveOracle oracle;
    const auto      source = this->source();
    oracle.free            = [this](const std::vector<double> &mu, const NodalVectors<double> &shift) {
      return forging_.run(design_.process(mu), sum(design_.positions(mu), shift), {}).energy.total();
    };
    oracle.replayed = [this, source](const std::vector<double> &mu, const NodalVectors<double> &shift) {
      return forging_.replay(design_.process(mu), sum(design_.positions(mu), shift), records_.size(), source)
        .energy.total();
    };
    oracle.tangent = [this, source](const std::vector<double>  &mu_dot,
                                    const NodalVectors<double> &shift_dot) {
      std::vector<Dual> mu;
      for (std::size_t j = 0; j < mu_.size(); ++j)
      {
        mu.emplace_back(mu_[j]);
        mu.back().fastAccessDx(0) = mu_dot[j];
      }
      NodalVectors<Dual> X = design_.positions(mu);
      for (std::size_t k = 0; k < X.size(); ++k)
        for (unsigned int i = 0; i < 3; ++i)
          X[k][i].fastAccessDx(0) += shift_dot[k][i];
      return tangent_sweep(increment_, scene_, design_.process(mu), X, records_.size(), source).total().dx(0);
    };
    return oracle;
  }

  bool Simulation::check()
  {
    const double size = mesh_size();
    checks_           = check_gradient(
      parameters_.check, design_, mu_, forged_.energy.total(), gradient_, X_0_bar_, size, oracle());
    if (root_)
      print(checks_, std::cout);
    return std::all_of(checks_.begin(), checks_.end(), [](const CheckRow &row) { return row.passed; });
  }

  void Simulation::summarise()
  {
    summary_.command        = command_.command;
    summary_.version        = version;
    summary_.commit         = commit;
    summary_.blas           = blas_in_use();
    summary_.ranks          = dealii::Utilities::MPI::n_mpi_processes(comm_);
    summary_.n_nodes        = scene_.mesh.n_nodes();
    summary_.n_cells        = scene_.mesh.n_cells();
    summary_.increments     = forged_.increments;
    summary_.cuts           = forged_.cuts;
    summary_.volume_initial = volume(scene_.mesh.cells, X_0_);
    summary_.volume_final   = volume(scene_.mesh.cells, forged_.X);
    summary_.wall_seconds   = timings_.all();
    summary_.objectives     = {
          {"energy",
           forged_.energy.total(),
           "mJ",
           {{"deformation", forged_.energy.deformation}, {"friction", forged_.energy.friction}}}};
    for (std::size_t j = 0; j < mu_.size() && !gradient_.empty(); ++j)
      summary_.parameters.push_back(
        {design_.parameters()[j].name, mu_[j], design_.parameters()[j].unit, {{"energy", gradient_[j]}}});
    for (const CheckRow &row : checks_)
    {
      Summary::Check check{"energy",
                           row.parameter,
                           row.adjoint,
                           row.tangent,
                           {},
                           row.taylor_orders,
                           row.passed ? "passed" : "failed"};
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
    std::printf(
      "\n  energy %.12g mJ (deformation %.6g, friction %.6g), volume change %.3g, %.1f s\n  results in %s\n",
      forged_.energy.total(),
      forged_.energy.deformation,
      forged_.energy.friction,
      summary_.volume_final / summary_.volume_initial - 1.,
      timings_.seconds("total"),
      command_.output_directory.c_str());
  }
} // namespace retroforge
