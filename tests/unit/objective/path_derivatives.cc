// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Derivatives of the objectives along a path, over three increments with any positions and velocities under
// two tilted dies (sliding, pressed and free nodes, nodes within the ramp): the reverse of integrals and
// value, put together as a backward sweep does it, against dual numbers in each group of inputs alone
// (positions at the increment's start and at its stage, velocities, bubbles, pressures, laws, dies, approach time,
// speed), and the Taylor order along all of them. Windows cut increments, so that an increment's part of the
// window counts. The same with a smooth, curved die, middles of edges among the points; and the contact
// pressure with quadratic velocities, where some vertices pull. The growth of the damage, a step of the state, in the
// same way; stresses, wear and it with quadratic velocities, too.

#include <deal.II/base/mpi.h>

#include <retroforge/objective/contact_pressure.h>
#include <retroforge/objective/die_wear.h>
#include <retroforge/objective/effort.h>
#include <retroforge/objective/energy.h>
#include <retroforge/objective/fold.h>
#include <retroforge/objective/largest_wear.h>
#include <retroforge/objective/stress_maxima.h>
#include <retroforge/steps/damage.h>

#include "../contact/wavy_sheet.h"
#include "../mesh/block_mesh.h"
#include "objective_test_tools.h"

using namespace retroforge;

constexpr unsigned int n_increments = 3;
constexpr double       steps[] = {0.3, 0.4, 0.2}, strokes[] = {0., 0.3, 0.7};

/// All that an objective's value depends on.
template <typename Number>
struct PathInputs
{
  struct State
  {
    NodalVectors<Number> X, Y, V;
    NodalVectors<Number> bubbles; ///< of all cells, if there are any
    std::vector<Number>  P;

    /// What of it this rank has.
    Field<Number> field(const Scene &scene) const
    {
      Field<Number>        W(scene.discretization);
      NodalVectors<Number> all = V;
      all.insert(all.end(), bubbles.begin(), bubbles.end());
      W.V.take(all);
      W.P.take(P);
      return W;
    }
  };

  std::array<State, n_increments> states;
  Physics<Number>                 physics;
  Number                          tau, speed; ///< tau in increments

  std::vector<Group<Number>> groups()
  {
    std::vector<Group<Number>> groups = {{"X", {}},
                                         {"Y", {}},
                                         {"V", {}},
                                         {"bubbles", {}},
                                         {"P", {}},
                                         {"K", {&physics.material.law.K}},
                                         {"m", {&physics.material.law.m}},
                                         {"e0", {&physics.material.law.e0}},
                                         {"rho", {&physics.contact.rho}},
                                         {"v0", {&physics.contact.v0}},
                                         {"v_die", {}},
                                         {"displacement", {}},
                                         {"friction", {}},
                                         {"tau", {&tau}},
                                         {"speed", {&speed}}};
    for (State &state : states)
    {
      append(state.X, groups[0].second);
      append(state.Y, groups[1].second);
      append(state.V, groups[2].second);
      append(state.bubbles, groups[3].second);
      for (Number &p : state.P)
        groups[4].second.push_back(&p);
    }
    for (auto &die : physics.dies)
    {
      for (unsigned int i = 0; i < 3; ++i)
      {
        groups[10].second.push_back(&die.velocity[i]);
        groups[11].second.push_back(&die.displacement[i]);
      }
      groups[12].second.push_back(&die.friction);
    }
    return groups;
  }
};

template <typename Number>
PathInputs<Number> empty_inputs(const Scene &scene)
{
  PathInputs<Number> inputs;
  for (auto &state : inputs.states)
  {
    state.X.resize(scene.mesh.n_nodes());
    state.Y.resize(scene.mesh.n_nodes());
    state.V.resize(scene.discretization.condensed_nodes()->n());
    state.bubbles.resize(scene.discretization.has_bubbles() ? scene.mesh.n_cells() : 0);
    state.P.resize(scene.mesh.n_nodes(), Number(0.));
  }
  inputs.physics.material.law.K = Number(0.);
  inputs.physics.material.law.m = Number(0.);
  inputs.physics.contact        = {Number(0.), Number(0.)};
  inputs.tau                    = Number(0.);
  inputs.speed                  = Number(0.);
  inputs.physics.dies.resize(scene.dies.size());
  for (auto &die : inputs.physics.dies)
    die.friction = Number(0.);
  return inputs;
}

struct PathProblem
{
  Scene                                              scene;
  FrictionRamp                                       ramp{0.9, false};
  PathInputs<double>                                 at;
  std::array<std::vector<ContactPair>, n_increments> pairs;
  std::array<ActiveSet, n_increments>                active;
  double                                             layer = 0.43, edge_stiffness = 0.3;

  static std::vector<Die> make_dies(const bool curved)
  {
    const Vec3 up = Vec3({0.1, -0.15, 1.}), side = Vec3({-1., 0.1, 0.2});
    return {curved ? Die("lower", wavy_sheet(), 2., {true, 60., 1.})
                   : Die("lower", Vec3({0., 0., 0.1}), up / up.norm()),
            Die("side", Vec3({5., 0., 0.}), side / side.norm())};
  }

  PathProblem(Random &random, const bool curved, const ElementPair pair = ElementPair::mini)
      : scene(half_box_mesh(Vec3({10., 8., 6.}), {{3, 6, 4}}), {pair}, make_dies(curved), MPI_COMM_WORLD)
      , at(empty_inputs<double>(scene))
  {
    at.physics.material.law = {1.3, 0.4, 0.2};
    at.physics.contact      = {2., 0.3};
    at.tau                  = 1.5;
    at.speed                = 2.;
    for (auto &die : at.physics.dies)
      die = {2. * random.vector(), 0.1 * random.vector(), 0.3, {}};
    for (unsigned int i = 0; i < n_increments; ++i)
    {
      auto &state = at.states[i];
      for (NodeIndex k = 0; k < state.V.size(); ++k)
      {
        if (k < scene.mesh.n_nodes())
        {
          state.X[k] = scene.mesh.X[k] + 0.1 * random.vector();
          state.Y[k] = state.X[k] + 0.1 * random.vector();
        }
        state.V[k] = (1. + i) * random.vector();
      }
      for (Vec3 &beta : state.bubbles)
        beta = 0.3 * random.vector();
      for (double &p : state.P)
        p = 3. * random.scalar();
      pairs[i] = find_contact_pairs(scene.view(at.physics.dies, state.X), ramp, 1.5 * ramp.width, true);
      active[i] =
        Equilibrium<double>(scene, at.physics, contact(at, i), state.Y).decide_active(state.field(scene));
    }
  }

  template <typename Number>
  Number dt(const PathInputs<Number> &inputs, const unsigned int i) const
  {
    return steps[i] / inputs.speed;
  }

  template <typename Number>
  ContactSet<Number> contact(const PathInputs<Number> &inputs, const unsigned int i) const
  {
    return make_contact_set<Number>(scene.view(inputs.physics.dies, inputs.states[i].X),
                                    pairs[i],
                                    {ramp, Number(inputs.tau * dt(inputs, i)), layer, edge_stiffness});
  }

  /// Middles of edges that press on the die, in all increments.
  unsigned int n_pressed_edges(const unsigned int die) const
  {
    unsigned int n = 0;
    for (unsigned int i = 0; i < n_increments; ++i)
      for (unsigned int p = 0; p < pairs[i].size(); ++p)
        n += pairs[i][p].die == die && !pairs[i][p].point.is_node() && active[i][p];
    return n;
  }

  /// Vertices that are pressed and pull, in all increments.
  unsigned int n_pulling() const
  {
    unsigned int n = 0;
    for (unsigned int i = 0; i < n_increments; ++i)
    {
      const ContactSet<double>  set = contact(at, i);
      const Equilibrium<double> stage(scene, at.physics, set, at.states[i].Y);
      for (unsigned int p = 0; p < pairs[i].size(); ++p)
        n +=
          active[i][p] && approach_excess(stage.contact_node(p, at.states[i].field(scene), active[i])) < 0.;
    }
    return n;
  }

  template <typename Number>
  PathRows<Number> rows(const PathObjective &objective, const PathInputs<Number> &inputs) const
  {
    PathRows<Number> rows;
    for (unsigned int i = 0; i < n_increments; ++i)
    {
      const ContactSet<Number>  set = contact(inputs, i);
      const Equilibrium<Number> stage(scene, inputs.physics, set, inputs.states[i].Y);
      const Field<Number>       W = inputs.states[i].field(scene);
      rows.push_back(
        recorded_row<Number>(objective.integrals(EquilibriumView<Number>{stage, W, active[i]}).complete(),
                             dt(inputs, i),
                             Number(strokes[i] / inputs.speed),
                             strokes[i],
                             steps[i]));
    }
    return rows;
  }

  PathInputs<double> reverse(const PathObjective &objective, const PathInputs<double> &inputs) const
  {
    PathInputs<double> bar      = empty_inputs<double>(scene);
    const auto         forward  = rows(objective, inputs);
    const auto         rows_bar = objective.reverse_value(forward);
    for (unsigned int i = 0; i < n_increments; ++i)
    {
      const ContactSet<double>  set = contact(inputs, i);
      const Equilibrium<double> stage(scene, inputs.physics, set, inputs.states[i].Y);
      ContactSetBar             set_bar(pairs[i].size());
      PhysicsBar                physics_bar(scene.dies);
      const Field<double>       W = inputs.states[i].field(scene);
      Field<double>             W_bar(scene.discretization);
      EquilibriumBar            stage_bar{W_bar, bar.states[i].Y, set_bar, physics_bar};
      objective.reverse_integrals({stage, W, active[i]}, rows_bar[i].integrals, stage_bar);
      for (unsigned int place = 0; place < W_bar.V.size(); ++place)
      {
        const NodeIndex k = W_bar.V.numbering()->node_at(place), n = bar.states[i].V.size();
        (k < n ? bar.states[i].V[k] : bar.states[i].bubbles[k - n]) += W_bar.V.at_place(place);
      }
      for (unsigned int place = 0; place < W_bar.P.size(); ++place)
        bar.states[i].P[W_bar.P.numbering()->node_at(place)] += W_bar.P.at_place(place);
      NodalVectors<double> no_velocity_bar(inputs.states[i].X.size());
      reverse_contact_set(scene.view(inputs.physics.dies, inputs.states[i].X),
                          set,
                          ramp,
                          set_bar,
                          bar.states[i].X,
                          no_velocity_bar,
                          physics_bar.dies);
      add_numbers(physics_bar.material.law, bar.physics.material.law);
      add_numbers(physics_bar.contact, bar.physics.contact);
      bar.tau += physics_bar.tau * dt(inputs, i);
      if (dealii::Utilities::MPI::this_mpi_process(scene.discretization.comm()) == 0)
        physics_bar.dt += rows_bar[i].dt + rows_bar[i].time * forward[i].stroke / forward[i].step;
      bar.speed -= (inputs.tau * physics_bar.tau + physics_bar.dt) * steps[i] / (inputs.speed * inputs.speed);
      for (unsigned int d = 0; d < scene.dies.size(); ++d)
      {
        bar.physics.dies[d].velocity += physics_bar.dies[d].velocity;
        bar.physics.dies[d].displacement += physics_bar.dies[d].displacement;
        bar.physics.dies[d].friction += physics_bar.dies[d].friction;
      }
    }
    for (const auto &[name, entries] : bar.groups())
      for (double *entry : entries)
        *entry = scene.discretization.sum(*entry);
    return bar;
  }
};

/// Deformation and friction weighted unequally: what EnergyObjective itself never asks for.
class WeightedEnergy : public PathObjectiveOf<WeightedEnergy>
{
public:
  static constexpr unsigned int n_terms = 1;

  std::string name() const override { return "weighted energy"; }
  std::string unit() const override { return "mJ"; }

  template <typename Number>
  std::vector<Number> compute_integrals(const EquilibriumView<Number> &view) const
  {
    return energy_.compute_integrals(view);
  }

  void reverse_integrals(const EquilibriumView<double> &view,
                         const std::vector<double>     &weights,
                         EquilibriumBar                &bar) const override
  {
    energy_.reverse_integrals(view, weights, bar);
  }

  template <typename Number>
  std::vector<Number> terms(const PathRow<Number> &row, double) const
  {
    return {Number(row.dt * (row.integrals[0] - 2. * row.integrals[1]))};
  }

  template <typename Number>
  Number combine(const std::vector<Number> &sums, double) const
  {
    return sums[0];
  }

private:
  EnergyObjective energy_;
};

/// What the increments add to the damage of cells, summed with weights that differ from cell to cell.
class DamageGrowth : public PathObjectiveOf<DamageGrowth>
{
public:
  static constexpr unsigned int n_terms = 1;

  std::string name() const override { return "damage growth"; }
  std::string unit() const override { return "none"; }

  template <typename Number>
  std::vector<Number> compute_integrals(const EquilibriumView<Number> &view) const
  {
    std::vector<Number> damage(view.stage.scene.mesh.n_cells(), Number(0.));
    add_damage(view, Number(1.), damage);
    Number sum(0.);
    for (const CellIndex c : view.stage.scene.discretization.cells().owned())
      sum += weight(c) * damage[c];
    return {sum};
  }

  /// Times are those of the increment, which the terms have: the derivative in dt is the value.
  void reverse_integrals(const EquilibriumView<double> &view,
                         const std::vector<double>     &weights,
                         EquilibriumBar                &bar) const override
  {
    std::vector<double> damage_bar(view.stage.scene.mesh.n_cells());
    for (CellIndex c = 0; c < damage_bar.size(); ++c)
      damage_bar[c] = weights[0] * weight(c);
    const double before = bar.physics.dt;
    reverse_add_damage(view, 1., damage_bar, bar);
    const double value = weights[0] * compute_integrals(view)[0];
    if (std::abs(bar.physics.dt - before - value) > 1e-12 * std::abs(value))
      std::cout << "  WRONG derivative of the damage in time" << std::endl;
    bar.physics.dt = before;
  }

  template <typename Number>
  std::vector<Number> terms(const PathRow<Number> &row, double) const
  {
    return {Number(row.dt * row.integrals[0])};
  }

  template <typename Number>
  Number combine(const std::vector<Number> &sums, double) const
  {
    return sums[0];
  }

private:
  static double weight(const CellIndex c) { return 1. + 0.3 * (c % 5); }
};

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) > 0)
    std::cout.setstate(std::ios::failbit);
  Random            random;
  const PathProblem flat(random, false);
  double            worst = 0.;

  const auto check_of =
    [&](const PathProblem &problem, const std::string &name, const PathObjective &objective) {
      const auto evaluate = [&](const auto &inputs) {
        return objective.value(problem.rows(objective, inputs));
      };
      const auto reverse = [&](const auto &inputs) { return problem.reverse(objective, inputs); };
      worst              = std::max(worst,
                       check_derivatives<PathInputs>(
                         name, problem.at, evaluate, reverse, empty_inputs<Dual>(problem.scene), random));
    };
  const auto check = [&](const std::string &name, const PathObjective &objective) {
    check_of(flat, name, objective);
  };
  using Over = PathWindow::Over;
  const SmoothMaximum p_norm{SmoothMaximum::Kind::p_norm, 12.},
    exponential{SmoothMaximum::Kind::log_sum_exp, 1e-3};
  const PathWindow late{Over::stroke, 0.5, 1e9}, part_of_time{Over::time, 0.1, 0.41};
  const Effort     by_power(1), by_force(0, Effort::By::force);
  check("energy", EnergyObjective());
  check("energy, friction weighted apart", WeightedEnergy());
  check("mean effort over stroke", MeanEffort(by_power, late));
  check("mean effort over time", MeanEffort(by_power, part_of_time));
  check("mean force over stroke", MeanEffort(by_force, late));
  check("mean force over time", MeanEffort(by_force, part_of_time));
  check("maximum effort, p-norm", MaximumEffort(by_power, part_of_time, p_norm));
  check("maximum effort, log-sum-exp", MaximumEffort(by_power, late, exponential));
  check("maximum force, log-sum-exp", MaximumEffort(by_force, part_of_time, exponential));
  check("maximum effort, fitted to all of the path", MaximumEffort(by_power, part_of_time, p_norm, 1.));
  check("maximum effort, not fitted", MaximumEffort(by_power, part_of_time, p_norm, 0.));
  check("fold, alpha = 1", FoldObjective(1.));
  check("fold, alpha = 4", FoldObjective(4.));
  check("fold, alpha = 2.5, in a box",
        FoldObjective(2.5, SmoothRegion{{Vec3({-9., -2., -1.}), Vec3({9., 2., 3.})}, 2.}));
  check("dimensionless fold, alpha = 3", DimensionlessFold(3.));
  check("contact pressure, q = 1", ContactPressure(0, 1., 5.));
  check("contact pressure, q = 12", ContactPressure(1, 12., 5.));
  const SmoothRegion inner{{Vec3({-9., -2., -1.}), Vec3({9., 2., 3.})}, 2.};
  const auto         check_stresses = [&](const PathProblem &problem) {
    for (const InnerStress stress : {InnerStress::pressure, InnerStress::shear})
    {
      const StressMaximum all(stress, 3., 2.), part(stress, 12., 2., part_of_time, inner);
      check_of(problem, all.name() + ", q = 3", all);
      check_of(problem, part.name() + ", q = 12, in a window and a box", part);
    }
    check_of(problem, "damage growth", DamageGrowth());
    check_of(problem, "die wear, total, in a window", DieWear(0, Wear::total, part_of_time));
    check_of(problem, "die wear, mean, in a box", DieWear(0, Wear::mean, late, inner));
  };
  check_stresses(flat);

  const PathProblem curved(random, true);
  std::cout << "with a curved die, edges pressed: " << (curved.n_pressed_edges(0) > 10 ? "yes, " : "NO, ")
            << curved.n_pressed_edges(0) << std::endl;
  check_of(curved, "energy", EnergyObjective());
  check_of(curved, "mean force over time", MeanEffort(by_force, part_of_time));
  check_of(curved, "fold, alpha = 4", FoldObjective(4.));
  check_of(curved, "contact pressure, q = 1", ContactPressure(0, 1., 5.));
  check_of(curved, "contact pressure, q = 12", ContactPressure(0, 12., 5.));
  check_of(curved, "die wear, mean, in a box", DieWear(0, Wear::mean, {}, inner));

  const PathProblem quadratic(random, true, ElementPair::taylor_hood);
  std::cout << "quadratic velocities, vertices pull: " << (quadratic.n_pulling() > 0 ? "yes" : "NO")
            << std::endl;
  check_of(quadratic, "contact pressure, q = 1", ContactPressure(0, 1., 5.));
  check_of(quadratic, "contact pressure, q = 12", ContactPressure(0, 12., 5.));
  check_stresses(quadratic);
  const auto check_largest_wear = [&](const PathProblem &problem) {
    const DieSites sites(problem.scene.dies[0], problem.scene.mesh, Vec3({0., 0., -1.}), 3.);
    check_of(problem, "die wear, largest, in a window", LargestWear(0, sites, 4., part_of_time));
    check_of(problem, "die wear, largest, in a box", LargestWear(0, sites, 20., late, inner));
  };
  for (const PathProblem *problem : {&flat, &curved, &quadratic})
    check_largest_wear(*problem);
  std::cout << "FIGURE path_objective_derivative_error " << worst << std::endl;
}
