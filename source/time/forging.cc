// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/nearest_name.h>
#include <retroforge/element/strain_history.h>
#include <retroforge/mesh/cell_transfer.h>
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/mesh/self_crossing.h>
#include <retroforge/solver/direct_solver.h>
#include <retroforge/time/forging.h>

#include <sstream>

namespace retroforge
{
  void PressParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    using namespace dealii::Patterns;
    std::string              choices;
    std::vector<std::string> described;
    for (const Scheme &known : Scheme::all())
    {
      choices += (choices.empty() ? "" : "|") + known.name;
      described.push_back("`" + known.name + "` " + known.description);
    }
    prm.enter_subsection("Press");
    prm.add_parameter(
      "leading die", leading_die, "Die whose path is the stroke; empty: the first that moves. Units: none.");
    prm.add_parameter("stroke", stroke, "Path of the leading die. Units: mm.", Double(1e-300));
    prm.add_parameter("increments",
                      increments,
                      "Number of equal increments of stroke, before any is cut; 0 for steps of 0.25 % of the "
                      "billet's height, with which the energy is smooth in the design. Units: none.",
                      Integer(0));
    prm.add_parameter(
      "scheme", scheme, "Time scheme: " + join(described) + ". Units: none.", Selection(choices));
    prm.add_parameter(
      "smallest volume",
      smallest_volume,
      "An increment is halved when an element would keep less than this part of its volume. Units: none.",
      Double(0., 1.));
    prm.add_parameter(
      "largest move",
      largest_move,
      "An increment is halved when two nodes of an edge would move, relative to each other, by more than "
      "this part of its length. Units: none.",
      Double(1e-3));
    prm.add_parameter(
      "largest slip",
      largest_slip,
      "An increment is halved when a node would slip along a curved die by more than this times the edge "
      "length wanted there. Units: none.",
      Double(1e-3));
    prm.add_parameter(
      "max cuts",
      max_cuts,
      "Times an increment may be halved, counted from the whole one, before the run stops. Units: none.",
      Integer(0, 30));
    prm.add_parameter(
      "largest volume change",
      largest_loss,
      "The run stops when the workpiece has lost or won more than this part of its volume. Units: none.",
      Double(0.));
    prm.leave_subsection();
  }

  /// Times Press/increments that cuts may make of them.
  constexpr unsigned int most_increments = 10;

  /// Increments between looks at whether the surface of a mesh that is not remade crosses itself.
  constexpr unsigned int fold_interval = 5;

  Forging::Forging(const ForgingModel    &model,
                   const PressParameters &press,
                   const Remesher        &remesher,
                   Timings               &timings)
      : model_(model), press_(press), remesher_(remesher), timings_(timings)
  {
  }

  ForgingState Forging::start(std::shared_ptr<Leg> leg, const NodalVectors<double> &X_0) const
  {
    ForgingState state;
    state.X      = X_0;
    state.volume = volume(leg->scene.mesh.cells, X_0);
    state.W      = Field<double>(leg->scene.mesh);
    state.strain = std::vector<double>(leg->scene.mesh.n_cells(), 0.);
    state.leg    = std::move(leg);
    return state;
  }

  namespace
  {
    std::string at(const Vec3 &x)
    {
      std::ostringstream text;
      text.precision(4);
      text << " at (" << x[0] << ", " << x[1] << ", " << x[2] << ")";
      return text.str();
    }

    /// A corner of the cell of the least quality.
    Vec3 flattest_cell(const TetMesh &mesh, const NodalVectors<double> &X)
    {
      CellIndex flattest = 0;
      double    least    = std::numeric_limits<double>::infinity();
      for (CellIndex c = 0; c < mesh.n_cells(); ++c)
        if (const double quality = tet_quality(corners(mesh.cells[c], X)); quality < least)
        {
          least    = quality;
          flattest = c;
        }
      return X[mesh.cells[flattest][0]];
    }
  } // namespace

  std::string
  Forging::too_much(const Leg &leg, const NodalVectors<double> &X, const NodalVectors<double> &X_next) const
  {
    const TetMesh &mesh = leg.scene.mesh;
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    {
      const auto   before = positions_of_cell(mesh, X, c), after = positions_of_cell(mesh, X_next, c);
      const double volume = cell_geometry(after).volume;
      if (!(volume > press_.smallest_volume * cell_geometry(before).volume))
        return (volume > 0. ? "an element would be crushed" : "an element would be inverted") + at(before[0]);
      for (unsigned int a = 0; a < 4; ++a)
        for (unsigned int b = 0; b < a; ++b)
          if (((after[a] - before[a]) - (after[b] - before[b])).norm() >
              press_.largest_move * (before[a] - before[b]).norm())
            return "an edge would be turned or stretched by more than Press/largest move" + at(before[a]);
    }
    return "";
  }

  namespace
  {
    /// Of an increment, that bring it down to what is allowed when it is `excess` times as long.
    unsigned int halvings(const double excess)
    {
      return std::max(1, static_cast<int>(std::ceil(std::log2(excess))));
    }
  } // namespace

  double Forging::largest_slip(const Process<double>      &process,
                               const IncrementRecord      &record,
                               const NodalVectors<double> &X,
                               const NodalVectors<double> &X_next,
                               std::string                &where) const
  {
    if (!remesher_.enabled())
      return 0.;
    const auto      dies    = process.at_stroke(record.stroke).dies;
    const SizeField size    = remesher_.size_field(dies);
    const double    time    = process.time(record.step);
    double          largest = 0.;
    for (const ContactPair &pair : record.pairs)
      if (pair.point.is_node() && model_.dies[pair.die].surface())
      {
        const NodeIndex k    = pair.point.nodes[0];
        const Vec3      path = X_next[k] - X[k] - time * dies[pair.die].velocity;
        const double    slip = path.norm() / size(X[k]);
        if (slip <= largest)
          continue;
        largest = slip;
        where   = "die " + model_.dies[pair.die].name + " by more than Press/largest slip" + at(X[k]);
      }
    return largest;
  }

  Refusal Forging::attempt(const Process<double> &process,
                           const ForgingState    &state,
                           Guess                 &guess,
                           IncrementRecord       &record,
                           SolvedIncrement       &solved) const
  {
    try
    {
      solved = state.leg->increment.forward(process, state.X, false, guess, record);
    }
    catch (const NoEquilibrium &failure)
    {
      return {failure.what()};
    }
    catch (const NoLinearSolution &)
    {
      return {"the linear systems of an increment have no solution; the flattest element is" +
              at(flattest_cell(state.leg->scene.mesh, state.X))};
    }
    guess.W.V   = record.solves.front().V;
    guess.W.P   = record.solves.front().P;
    guess.known = Start::near;
    if (const std::string reason = too_much(*state.leg, state.X, solved.X); !reason.empty())
      return {reason};
    std::string  where;
    const double slip = largest_slip(process, record, state.X, solved.X, where) / press_.largest_slip;
    // Velocities hardly depend on the increment's length: what it must be is known at once.
    return slip > 1. ? Refusal{"a node would slip along " + where, halvings(slip), false} : Refusal{};
  }

  namespace
  {
    bool crosses(const ForgingState &state)
    {
      return !self_crossings(state.leg->scene.mesh, state.X).empty();
    }

    /// Throws where metal meets metal: that is not in the model.
    void check_fold(const ForgingState &state)
    {
      check_boundary_does_not_cross(state.leg->scene.mesh, state.X, "Workpiece");
    }
  } // namespace

  void Forging::change_mesh(const RemeshRecord &remesh, ForgingState &state) const
  {
    state.repaired += remesh.repaired;
    const TransferOperator &J = remesh.transfer;
    Field<double>           W(remesh.mesh);
    W.V         = J.apply(state.W.V);
    W.P         = J.apply(state.W.P);
    auto strain = transfer_cells(state.leg->scene.mesh, state.X, J, remesh.mesh, state.strain);
    state.strains_before.push_back(std::exchange(state.strain, std::move(strain)));
    state.X   = J.positions(state.X);
    state.W   = std::move(W);
    state.leg = std::make_shared<Leg>(remesh.mesh, model_, timings_);
    state.remeshed.push_back(state.increments);
  }

  void Forging::remesh(const Process<double> &process, ForgingState &state, IncrementRecord &record) const
  {
    const auto timing = timings_.scope("remeshing");
    record.remesh =
      remesher_.remesh(state.leg->scene.mesh, state.X, process.at_stroke(state.stroke).dies, timings_);
    change_mesh(*record.remesh, state);
    state.X = record.remesh->mesh.X; // J X + c to the last bit
  }

  void Forging::finish_increment(const Process<double> &process,
                                 const IncrementRecord &record,
                                 const SolvedIncrement &solved,
                                 ForgingState          &state,
                                 const Watch           &watch) const
  {
    const NodalVectors<double> X_before = std::exchange(state.X, solved.X);
    for (const auto &stage : solved.stages)
      state.strain = accumulate_strain(
        state.leg->scene.mesh, stage->X, stage->W, stage->weight * solved.start->dt, state.strain);
    std::string where;
    state.W    = solved.last().W;
    state.slip = largest_slip(process, record, X_before, state.X, where) / record.step;
    state.stroke += record.step;
    state.energy.deformation += record.deformation_energy;
    state.energy.friction += record.friction_energy;
    state.cuts += record.cuts;
    state.newton += record.newton;
    state.krylov += record.krylov;
    state.linear_solves += record.linear_solves;
    ++state.increments;
    const double whole = record.contact.step, done = (state.stroke - state.numerics_stroke) / whole;
    while (whole / (1 << state.depth) > record.step * (1. + 1e-9) && state.depth < 30)
      ++state.depth;
    // Back to longer steps once a whole number of them fits, and nothing slips too far in them.
    while (state.depth > 0 && state.slip * whole / (1 << (state.depth - 1)) <= press_.largest_slip &&
           std::abs(done * (1 << (state.depth - 1)) - std::round(done * (1 << (state.depth - 1)))) < 1e-9)
      --state.depth;
    if (watch)
      watch({record, X_before, solved, state, process.time(state.stroke)});
  }

  void Forging::throw_stuck(const IncrementRecord &record, const std::string &reason) const
  {
    std::ostringstream what;
    what.precision(5);
    what << "stops at stroke " << record.stroke << " mm, where even an increment of "
         << whole() * std::ldexp(1., -static_cast<int>(press_.max_cuts)) << " mm is too long: " << reason;
    const char *remedy =
      record.stroke == 0. ? "nothing moved yet, so the stroke is not what is wrong: use values of the usual "
                            "size, penalty and friction above all, more increments, or a better mesh"
      : remesher_.enabled()
        ? "if the dies nearly close or the cavity is full there, shorten the stroke; else use more "
          "increments or a finer mesh"
        : "the mesh may be too distorted to go on: set Remeshing/when = quality";
    throw Error("Press/stroke",
                what.str(),
                "an increment may be halved " + std::to_string(press_.max_cuts) +
                  " times (Press/max cuts), and elements must stay sound",
                remedy);
  }

  void Forging::check_progress(const ForgingState &state) const
  {
    const double       change = volume(state.leg->scene.mesh.cells, state.X) / state.volume - 1.;
    std::ostringstream what;
    what.precision(4);
    if (!(std::abs(change) <= press_.largest_loss))
    {
      what << "at stroke " << state.stroke << " mm the workpiece has " << (change < 0. ? "lost " : "won ")
           << 100. * std::abs(change) << " % of its volume";
      throw Error(
        "Press/stroke",
        what.str(),
        "at most Press/largest volume change may be lost",
        "if the dies nearly close there, shorten the stroke; else use more increments or a finer mesh");
    }
    if (const unsigned int n = state.increments - state.numerics_increments;
        n > most_increments * press_.increments)
    {
      what << "was cut so often that " << n << " increments brought it to " << state.stroke << " mm";
      throw Error("Press/stroke",
                  what.str(),
                  "a run may take " + std::to_string(most_increments) + " times Press/increments",
                  "if the dies nearly close or the cavity is full there, shorten the stroke; else raise "
                  "Press/increments");
    }
  }

  void Forging::change_numerics(const std::string &parameters, ForgingState &state)
  {
    state.depth               = 0;
    state.numerics_stroke     = state.stroke;
    state.numerics_increments = state.increments;
    state.parameters          = parameters;
  }

  bool Forging::is_left(const ForgingState &state) const
  {
    return state.stroke < press_.stroke - 1e-9 * whole();
  }

  void Forging::run(const Process<double> &process, ForgingState &state, const Watch &watch) const
  {
    std::vector<bool> frozen;
    if (remesher_.enabled())
      frozen = remesher_.frozen(state.leg->scene.mesh);
    const auto since_remeshing = [&]() {
      return state.increments - (state.remeshed.empty() ? 0 : state.remeshed.back());
    };
    // Also where a run is resumed that stopped for that.
    if (!remesher_.enabled())
      check_fold(state);
    if (state.increments > 0)
      check_progress(state);
    while (is_left(state))
    {
      IncrementRecord record;
      const auto      renew = [&]() {
        remesh(process, state, record);
        frozen = remesher_.frozen(state.leg->scene.mesh);
      };
      const bool crossed = remesher_.enabled() && crosses(state);
      if (crossed && state.repaired >= remesher_.largest_repair() * state.volume)
        check_fold(state);
      if (crossed || (remesher_.enabled() && remesher_.due(state.leg->scene.mesh,
                                                           state.X,
                                                           process.at_stroke(state.stroke).dies,
                                                           frozen,
                                                           since_remeshing(),
                                                           state.increments == 0)))
        renew();
      if (crossed)
        check_fold(state);
      record.stroke     = state.stroke;
      record.step       = std::min(whole() / (1 << state.depth), press_.stroke - state.stroke);
      record.parameters = std::exchange(state.parameters, "");
      SolvedIncrement solved;
      Guess           guess{state.W, record.remesh ? Start::far : Start::near};
      for (;;)
      {
        const Refusal refusal = attempt(process, state, guess, record, solved);
        if (refusal.reason.empty())
          break;
        if (refusal.of_mesh && remesher_.enabled() && !record.remesh && since_remeshing() > 0)
        {
          renew();
          guess = {state.W, Start::far};
          continue;
        }
        record.step = std::ldexp(record.step, -static_cast<int>(refusal.halvings));
        record.cuts += refusal.halvings;
        if (record.step < whole() * std::ldexp(1., -static_cast<int>(press_.max_cuts)) * (1. - 1e-9))
        {
          // A fold that is closing is the true reason.
          check_fold(state);
          throw_stuck(record, refusal.reason);
        }
      }
      finish_increment(process, record, solved, state, watch);
      check_progress(state);
      // With remeshing, the next increment begins with a repair.
      const bool last = !is_left(state);
      if (remesher_.enabled()
            ? last && !remesher_.repairs(state.leg->scene.mesh, state.X, process.at_stroke(state.stroke).dies)
            : last || state.increments % fold_interval == 0)
        check_fold(state);
    }
  }

  void Forging::restore(const Process<double> &process,
                        const unsigned int     n,
                        const Source          &source,
                        ForgingState          &state,
                        const Watch           &watch) const
  {
    for (unsigned int i = 0; i < n; ++i)
    {
      const IncrementRecord &record = source(i);
      if (!record.parameters.empty())
        change_numerics("", state);
      if (record.remesh)
      {
        change_mesh(*record.remesh, state);
        state.X = record.remesh->mesh.X;
      }
      finish_increment(
        process, record, state.leg->increment.recorded(process, state.X, record), state, watch);
    }
  }

  void Forging::replay(const Process<double> &process,
                       const unsigned int     n,
                       const Source          &source,
                       ForgingState          &state,
                       const Watch           &watch) const
  {
    for (unsigned int i = 0; i < n; ++i)
    {
      IncrementRecord record = source(i);
      record.newton = record.krylov = record.linear_solves = 0;
      if (record.remesh)
        change_mesh(*record.remesh, state);
      Guess guess{Field<double>(state.leg->scene.mesh)};
      guess.W.V                    = record.solves[0].V;
      guess.W.P                    = record.solves[0].P;
      const SolvedIncrement solved = state.leg->increment.forward(process, state.X, true, guess, record);
      finish_increment(process, record, solved, state, watch);
    }
  }
} // namespace retroforge
