// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Every term of the backward sweep by which metal hardens, warms by its work and by friction, by which heat flows,
// is needed, and tests of this kind see it: on the block under a tilted die of dropped_terms.cc, and then under another one,
// of metal that hardens and softens as it warms, with friction after Tresca and conduction, the adjoint of the spread of
// temperatures at the end agrees with replayed central differences along the nodes at random, the speed of the die, the numbers
// of heat and the times of waiting; and a sweep that leaves out any one term does not. The sweep with omissions is made of the
// library's steps as Increment::reverse is: complete, it agrees with adjoint_sweep. What depends on positions and velocities
// must show along the nodes, what on times along the speed or the times of waiting, what on numbers along these.

#include <deal.II/base/mpi.h>

#include <retroforge/discretization/strain_history.h>
#include <retroforge/objective/temperatures.h>
#include <retroforge/steps/friction_heat.h>
#include <retroforge/steps/warming.h>

#include "two_strokes.h"
#include "ways.h"

using namespace retroforge;

namespace
{
  enum class Piece
  {
    none,
    strain,      // accumulation of strain
    warming,     // work of deformation
    friction,    // heat of friction in the metal
    flux,        // that of skins
    law,         // law of the metal by strain and temperature
    first_half,  // conduction before mechanics
    second_half, // and after it
    waiting      // conduction before a stroke
  };

  enum class Part
  {
    velocity,
    position,
    contact,
    state,  // by strain and temperature of the metal
    flux,   // by friction's flux
    number, // of metal and heat
    time,
    all
  };

  struct Omission
  {
    std::string name;
    Piece       piece = Piece::none;
    Part        part  = Part::all;
    std::size_t way   = 0; ///< along which it shows
  };

  const std::vector<Omission> omissions = {
    {"strain by velocity", Piece::strain, Part::velocity, 0},
    {"strain by position", Piece::strain, Part::position, 0},
    {"strain by time", Piece::strain, Part::time, 1},
    {"the law by strain and temperature", Piece::law, Part::all, 0},
    {"warming by velocity", Piece::warming, Part::velocity, 0},
    {"warming by position", Piece::warming, Part::position, 0},
    {"warming by the state", Piece::warming, Part::state, 0},
    {"warming by numbers", Piece::warming, Part::number, 2},
    {"warming by time", Piece::warming, Part::time, 1},
    {"friction's heat by velocity", Piece::friction, Part::velocity, 0},
    {"friction's heat by position", Piece::friction, Part::position, 0},
    {"friction's heat by contact", Piece::friction, Part::contact, 0},
    {"friction's heat by the state", Piece::friction, Part::state, 0},
    {"friction's heat by numbers", Piece::friction, Part::number, 2},
    {"friction's heat by time", Piece::friction, Part::time, 1},
    {"friction's flux by velocity", Piece::flux, Part::velocity, 0},
    {"friction's flux by position", Piece::flux, Part::position, 0},
    {"friction's flux by contact", Piece::flux, Part::contact, 0},
    {"friction's flux by the state", Piece::flux, Part::state, 0},
    {"first half of conduction by position", Piece::first_half, Part::position, 0},
    {"first half of conduction by temperature and skin", Piece::first_half, Part::state, 0},
    {"first half of conduction by friction's flux", Piece::first_half, Part::flux, 1},
    {"first half of conduction by process", Piece::first_half, Part::number, 2},
    {"first half of conduction by the velocity before", Piece::first_half, Part::velocity, 0},
    {"second half of conduction by position", Piece::second_half, Part::position, 0},
    {"second half of conduction by temperature and skin", Piece::second_half, Part::state, 0},
    {"second half of conduction by friction's flux", Piece::second_half, Part::flux, 1},
    {"second half of conduction by process", Piece::second_half, Part::number, 2},
    {"conduction before strokes by its time", Piece::waiting, Part::time, 3},
    {"conduction before strokes by position", Piece::waiting, Part::position, 0},
    {"conduction before strokes by the skin", Piece::waiting, Part::state, 0},
    {"conduction before strokes by numbers", Piece::waiting, Part::number, 2}};

  /// What a stage's history takes back, without the omitted part of one piece.
  class ReverseHistory
  {
  public:
    ReverseHistory(const Omission &omission, const EquilibriumView<double> &view, EquilibriumBar &bar)
        : omission_(omission), view_(view), bar_(bar)
    {
    }

    void operator()(const Piece piece, const std::function<void(EquilibriumBar &)> &reverse) const
    {
      if (piece != omission_.piece)
      {
        reverse(bar_);
        return;
      }
      Field<double>        W(view_.stage.scene.discretization);
      NodalVectors<double> X(bar_.X.size());
      ContactSetBar        contact(view_.stage.contact.pairs.size());
      PhysicsBar           physics(view_.stage.scene.dies);
      physics.material.numbers.resize(bar_.physics.material.numbers.size(), 0.);
      physics.points.resize(bar_.physics.points.size());
      EquilibriumBar part{W, X, contact, physics, bar_.shape};
      reverse(part);
      const auto keeps = [&](const Part part_of) { return omission_.part != part_of; };
      if (keeps(Part::velocity))
        bar_.W.add(1., W);
      if (keeps(Part::position))
        add_numbers(X, bar_.X);
      if (keeps(Part::contact))
      {
        add_numbers(contact.delta, bar_.contact.delta);
        add_numbers(contact.ramp, bar_.contact.ramp);
        add_numbers(contact.rates, bar_.contact.rates);
        add_numbers(contact.n, bar_.contact.n);
      }
      bar_.physics.points.resize(physics.points.size()); // the first piece makes them
      if (keeps(Part::state))
        add_numbers(physics.points, bar_.physics.points);
      if (keeps(Part::number))
        add_numbers<Physics<double>>(physics, bar_.physics);
      if (keeps(Part::time))
      {
        bar_.physics.dt += physics.dt;
        bar_.physics.tau += physics.tau;
      }
    }

  private:
    const Omission                &omission_;
    const EquilibriumView<double> &view_;
    EquilibriumBar                &bar_;
  };

  void reverse_history_without(const Omission                  &omission,
                               const EquilibriumView<double>   &view,
                               const double                     dt,
                               const WorkpieceState<3, double> &costate,
                               EquilibriumBar                  &bar)
  {
    const ReverseHistory piece(omission, view, bar);
    piece(Piece::warming,
          [&](EquilibriumBar &part) { reverse_add_warming(view, dt, costate.temperature, part); });
    piece(Piece::friction,
          [&](EquilibriumBar &part) { reverse_add_friction_heat(view, dt, costate.temperature, part); });
    piece(Piece::flux,
          [&](EquilibriumBar &part) { reverse_add_friction_flux(view, costate.friction_flux, part); });
    piece(Piece::strain, [&](EquilibriumBar &part) {
      part.physics.dt += view.weight * reverse_accumulate_strain(view.stage.scene.discretization,
                                                                 view.stage.X,
                                                                 view.W,
                                                                 view.weight * dt,
                                                                 costate.strain,
                                                                 part.W,
                                                                 part.X);
    });
  }

  void vanish(NodeField<double> &field)
  {
    std::fill(field.begin(), field.end(), 0.);
  }

  /// Does something to a costate but for a part.
  template <typename Action>
  void without(const bool omits, const Part part, Costate &costate, const Action &action)
  {
    const Costate before = costate;
    action();
    if (!omits)
      return;
    if (part == Part::position)
      costate.workpiece.X = before.workpiece.X;
    if (part == Part::velocity)
      costate.workpiece.velocity = before.workpiece.velocity;
    if (part == Part::number)
      costate.process = before.process;
    if (part == Part::state || part == Part::all)
    {
      costate.workpiece.strain      = before.workpiece.strain;
      costate.workpiece.temperature = before.workpiece.temperature;
      costate.workpiece.skin        = before.workpiece.skin;
    }
    if (part == Part::flux)
      costate.workpiece.friction_flux = before.workpiece.friction_flux;
  }

  /// A time before a stroke: in the surroundings, or on the resting die.
  struct Spell
  {
    std::vector<bool> touch;
    double            time;

    ThermalSurface<double>                                       surface = {};
    std::vector<std::pair<NodeField<double>, NodeSkins<double>>> before  = {}; // temperatures and skins
  };

  /// What comes before the stroke of an operation, as conduct_before() has it, to be gone back over without a term.
  class Wait
  {
  public:
    /// @param start  of the operation; its temperatures and skins are taken over the wait
    Wait(const RecordedRun         &run,
         const NetworkEdges        &edges,
         const StrokeStep          &at,
         WorkpieceState<3, double> &start)
        : process_(run.process())
        , operation_(at.operation)
        , dies_(process_.over({0., 0., operation_}).dies)
        , view_(run.scene.view(dies_, start.X))
        , edges_(edges)
        , network_(conduction_network(run.scene.mesh, edges, start.X))
    {
      const Waiting<double> &waiting = process_.operations[operation_].waiting;
      std::vector<bool>      touch(dies_.size(), false);
      spells_.push_back({touch, waiting.transfer});
      touch[waiting.resting_die] = true;
      spells_.push_back({touch, waiting.dwell});
      for (Spell &spell : spells_)
      {
        spell.surface = thermal_surface(view_, spell.touch, process_.heat.gap);
        for (unsigned int s = 0; s < process_.heat.waiting_steps; ++s)
        {
          spell.before.emplace_back(start.temperature, start.skin);
          conduct(flow(spell), part(s) * spell.time, start.temperature, start.skin);
        }
      }
    }

    void reverse(const Omission &omission, Costate &costate) const
    {
      WorkpieceState<3, double> &workpiece   = costate.workpiece;
      ConductionNetwork<double>  network_bar = no_derivatives(network_);
      PhysicsBar                 physics(view_.dies);
      Waiting<double>            times;
      const auto                 keeps = [&](const Part of) {
        return omission.piece != Piece::waiting || omission.part != of;
      };
      NodalVectors<double> X_bar(workpiece.X.size());
      for (const bool dwells : {true, false})
      {
        const Spell      &spell = spells_[dwells];
        ThermalSurfaceBar surface_bar(spell.surface);
        double           &time = dwells ? times.dwell : times.transfer;
        for (unsigned int s = process_.heat.waiting_steps; s-- > 0;)
        {
          double                  dt_bar = 0.;
          HeatFlowBar             bar{network_bar,
                          surface_bar,
                          physics.heat,
                          dwells ? physics.heat.dwell_film : physics.heat.contact_film,
                          physics.dies,
                          dt_bar};
          const NodeSkins<double> skin_bar = workpiece.skin;
          reverse_conduct(flow(spell),
                          part(s) * spell.time,
                          spell.before[s].first,
                          spell.before[s].second,
                          workpiece.temperature,
                          workpiece.skin,
                          bar);
          if (!keeps(Part::state))
            workpiece.skin = skin_bar;
          if (keeps(Part::time))
            time += part(s) * dt_bar;
        }
        reverse_thermal_surface(view_, spell.surface, process_.heat.gap, surface_bar, X_bar, physics.dies);
      }
      reverse_conduction_network(view_.mesh, edges_, view_.X, network_bar, X_bar);
      if (keeps(Part::position))
        add_numbers(X_bar, workpiece.X);
      if (!keeps(Part::number))
        physics.heat = HeatLaw<double>();
      costate.process.add_once([&](Process<double> &of) {
        reverse_over(process_, {0., 0., operation_}, 0., physics, of);
        add_numbers(times, of.operations[operation_].waiting);
      });
    }

  private:
    HeatFlow<double> flow(const Spell &spell) const
    {
      const bool dwells = &spell == &spells_.back();
      return {edges_,
              network_,
              spell.surface,
              process_.heat,
              dwells ? process_.heat.dwell_film : process_.heat.contact_film,
              dies_};
    }

    double part(const unsigned int s) const
    {
      return (2. * s + 1.) / (double(process_.heat.waiting_steps) * process_.heat.waiting_steps);
    }

    const Process<double>              &process_;
    const unsigned int                  operation_;
    const std::vector<DieState<double>> dies_;
    const ContactView<double>           view_;
    const NetworkEdges                 &edges_;
    const ConductionNetwork<double>     network_;
    std::vector<Spell>                  spells_;
  };

  /// The sweep of the first objective, one of the end, on one mesh.
  AdjointResult sweep(RecordedRun &run, const Omission &omission)
  {
    const ForgingState   &end       = run.state();
    const FinalObjective &objective = *run.objectives()[0].at_end;
    const auto            physics   = run.process().at_stroke(end.stroke, end.operation);
    const auto            view      = final_view(objective, run.scene, end.workpiece, physics);
    const auto            decisions = objective.decide(view);
    const auto            b         = objective.integrals(view, decisions).complete();
    const FinalBar        bar =
      objective.derivatives(view, decisions, objective.reverse_value(b, decisions)).complete();
    std::vector<Costate> costates(
      1,
      {zero_costate<3>(run.scene.mesh.n_nodes(),
                       run.scene.mesh.n_cells(),
                       true,
                       NodeSkins<double>::none(run.scene.mesh.n_nodes(), run.process().dies.size())),
       {no_process_derivatives(run.process(), run.scene.dies), MPI_COMM_SELF}});
    Costate &costate                    = costates[0];
    costate.workpiece.X                 = bar.X;
    costate.workpiece.temperature       = bar.T;
    WorkpieceState<3, double> state     = end.workpiece;
    Mechanics                &mechanics = run.first_epoch().increment.mechanics;
    const NetworkEdges        edges(run.scene.mesh, run.scene.topology);
    const auto                X = positions_of(run);
    for (unsigned int i = run.records.size(); i-- > 0;)
    {
      const IncrementRecord &record = run.records[i];
      const double           dt     = run.process().duration(place(record));
      state                         = end.remembered[i].start.get();
      state.X                       = X[i];
      state.velocity.clear(); // an operation begins at rest
      if (i > 0 && run.records[i - 1].operation == record.operation)
        state.velocity = mechanics.mean_velocity(run.records[i - 1]);
      const IncrementMemory    &memory  = end.remembered[i];
      Process<double>           process = run.process();
      WorkpieceState<3, double> waited = state, half = memory.half;
      half.X        = state.X;
      half.velocity = state.velocity;
      std::optional<Wait> wait;
      if (record.stroke == 0.)
      {
        wait.emplace(run, edges, place(record), waited);
        process.operations[record.operation].waiting = {};
      }
      ReversibleConduction conduction(run.scene, edges, process, place(record), waited, memory.touching);
      without(omission.piece == Piece::second_half, omission.part, costate, [&] {
        conduction.reverse_after(X[i + 1], memory.worked.get(), costates);
      });
      without(omission.piece == Piece::law, omission.part, costate, [&] {
        mechanics.reverse(
          run.process(),
          half,
          record,
          [&](std::size_t, const EquilibriumView<double> &of_stage, EquilibriumBar &to) {
            reverse_history_without(omission, of_stage, dt, costate.workpiece, to);
          },
          costates);
      });
      vanish(costate.workpiece.friction_flux); // the mechanics make another one
      without(omission.piece == Piece::first_half, omission.part, costate, [&] {
        conduction.reverse_before(costates);
        if (wait)
          wait->reverse(omission, costate);
      });
    }
    return {costate.workpiece.X, costate.process.complete()};
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  Parameters                               p = block_of_two_strokes();
  p.press.increments                         = 2;
  p.heat.gap                                 = 2.;  // less than what the die goes: nodes arrive
  p.heat.friction_part                       = 0.1; // skins show its heat most where it goes to one side
  p.dies[2].point                            = Vec3({0., 0., 28.});
  for (DieParameters &die : p.dies)
    die.friction_law = "Tresca";
  Objectives hottest;
  hottest.push_back({"hottest",
                     1.,
                     SymmetryScaling::none,
                     invalid_index,
                     nullptr,
                     std::make_unique<TemperatureObjective>(TemperatureExtreme::spread, 5.)});
  ForgingProblem problem = two_strokes(p, Meshes::one, std::move(hottest));
  // On a tilted die, which nodes touch in part.
  problem.process.operations[1].waiting = {0.02, 0.4, 2};
  RecordedRun                run(std::move(problem));
  const NodalVectors<double> still(run.scene.mesh.n_nodes());
  const std::vector<Way>     ways    = {{{"random X_0", random_vectors(still.size()), 0., 0., {}}},
                                        {{"die speed", still, 1., 0., {}}},
                                        {{"numbers of heat", still, 0., 0., {}},
                                         [&](Process<double> &dot) {
                                    HeatLaw<double> heat = run.process().heat;
                                    for (unsigned int i = 0; i < heat.info().size(); ++i)
                                      number_of(dot.heat, i) =
                                        number_of(heat, i) / (1. + i); // not in proportion
                                  }},
                                        {{"times of waiting", still, 0., 0., {}}, [](Process<double> &dot) {
                                    dot.operations[0].waiting.transfer = 0.3;
                                    dot.operations[0].waiting.dwell    = 0.05;
                                    dot.operations[1].waiting.transfer = 0.01;
                                    dot.operations[1].waiting.dwell    = 0.2;
                                  }}};
  const AdjointResult        library = run.adjoint(), complete = sweep(run, {"", Piece::none});
  std::vector<double>        differences;
  std::cout << "complete sweep\n";
  for (const Way &way : ways)
  {
    const double adjoint = slope(run, complete, way);
    ValuesAlong  value(run, way);
    double       best = 1e300;
    for (const double h : {1e-4, 1e-5, 1e-6})
    {
      const double difference = (value(0, h) - value(0, -h)) / (2. * h);
      if (relative_error(difference, adjoint) < relative_error(best, adjoint))
        best = difference;
    }
    differences.push_back(best);
    std::cout << "  " << way.direction.name
              << ": differences within 1e-6: " << yes(relative_error(best, adjoint) < 1e-6)
              << ", adjoint_sweep within 1e-13: "
              << yes(relative_error(adjoint, slope(run, library, way)) < 1e-13) << "\n";
  }
  for (const Omission &omission : omissions)
  {
    const Way   &way   = ways[omission.way];
    const double error = relative_error(slope(run, sweep(run, omission), way), differences[omission.way]);
    std::cout << "without " << omission.name << ", along " << way.direction.name
              << ": error > 1e-5: " << yes(error > 1e-5) << "\n";
    if (error <= 1e-5)
      std::cout << "    " << error << "\n";
  }
}
