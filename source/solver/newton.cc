// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/mpi.h>

#include <retroforge/core/error.h>
#include <retroforge/core/setting_tags.h>
#include <retroforge/discretization/element_pairs.h>
#include <retroforge/solver/contact_steps.h>
#include <retroforge/solver/newton.h>

#include <sstream>

namespace retroforge
{
  void NewtonParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    using namespace dealii::Patterns;
    prm.enter_subsection("Newton");
    prm.add_parameter(
      "tolerance",
      tolerance,
      "Residual at which the equilibrium counts as solved, relative to the nodal forces. Gradients are "
      "exact to about this. Units: none.",
      Double(1e-14, 1e-2));
    prm.add_parameter(
      "forcing",
      forcing,
      "Largest relative tolerance of a linear solve; it falls with the square of the residual's fall. "
      "Units: none.",
      Double(1e-14, 0.5));
    prm.add_parameter(
      "max iterations", max_iterations, "Newton steps before giving up. Units: none.", Integer(1));
    prm.leave_subsection();
    tag(prm, "Newton", SettingRole::numerics);
  }

  Newton::Newton(const Scene &scene, const NewtonParameters &parameters, LinearSystem &system)
      : scene_(scene), parameters_(parameters), system_(system)
  {
  }

  namespace
  {
    /// Of the billet, and of the fastest die.
    std::pair<double, double> volume_and_speed(const Equilibrium<double> &stage)
    {
      const Discretization<3> &discretization = stage.scene.discretization;
      double                   volume = 0., speed = 0.;
      for (const CellIndex c : discretization.cells().owned())
        volume += geometry_of_cell(stage.scene.discretization, stage.X, c).volume;
      for (const auto &die : stage.physics.dies)
        speed = std::max(speed, die.velocity.norm());
      return {discretization.sum(volume), speed};
    }

    /// A strain rate typical of the press.
    double typical_rate(const double volume, const double speed)
    {
      return std::max(speed, 1e-300) / std::cbrt(volume);
    }

    /// What residuals are measured against. Where nothing pushes yet, all there is is rounding: what is small
    /// against the flow at the dies' speed, `reference`, is measured against that.
    std::pair<double, double> scale_of(const Equilibrium<double>       &stage,
                                       const Field<double>             &W,
                                       const std::pair<double, double> &reference)
    {
      constexpr double negligible = 1e-3;
      const auto       scale      = residual_scale(stage, W);
      return {std::max(scale.first, negligible * reference.first),
              std::max(scale.second, negligible * reference.second)};
    }

    /// What residual_scale would be in a flow at the dies' speed.
    std::pair<double, double> reference_scale(const Equilibrium<double> &stage)
    {
      const auto [volume, speed] = volume_and_speed(stage);
      const double rate = typical_rate(volume, speed), n = stage.scene.mesh.n_nodes(), v = volume / n;
      const MaterialLaw<double> newtonian = stage.physics.material.initial_law().newtonian(rate);
      const double              stress    = newtonian(1.5 * rate * rate) * rate;
      return {stress * std::cbrt(v * v) * std::sqrt(n), rate * v * std::sqrt(n)};
    }
  } // namespace

  double Newton::relative_residual(const Equilibrium<double> &stage,
                                   const Field<double>       &W,
                                   const ActiveChoice        &frozen,
                                   const Scale               &scale,
                                   Field<double>             &r)
  {
    r                          = stage.residual(W, frozen);
    const auto  norm           = system_.residual_norm(r);
    double      bubble2        = 0.;
    const auto &discretization = scene_.discretization;
    if (discretization.has_bubbles())
      for (const CellIndex c : discretization.cells().owned())
        bubble2 += MiniPair::bubble(discretization, r, c).norm_square();
    const double momentum = std::sqrt(norm.first * norm.first + discretization.sum(bubble2));
    return std::max(momentum / scale.first, norm.second / scale.second);
  }

  /// d/da of the functional along the step: momentum and bubble rows only.
  double Newton::slope(const Field<double> &r, const Field<double> &step) const
  {
    const auto &discretization = scene_.discretization;
    double      sum            = 0.;
    for (unsigned int place = 0; place < discretization.velocity_nodes()->n_owned(); ++place)
      sum += r.V.at_place(place) * step.V.at_place(place);
    return discretization.sum(sum);
  }

  namespace
  {
    /// Balances bubbles with velocities and pressures that are on their way. Where the metal hardly feels its
    /// rate, a load that a cell cannot bear makes them  |beta| ~ (load / K)^(1/m),  beyond all bounds, and
    /// steps from there lead nowhere: those are left as they are.
    void solve_bubbles_in_reach(const Equilibrium<double> &stage, const double speed, Field<double> &W)
    {
      constexpr double farthest       = 10.; // of the dies' speed
      const auto      &discretization = stage.scene.discretization;
      if (!discretization.has_bubbles())
        return;
      const NodeVector<3, double> before = W.V;
      solve_bubbles(stage, W);
      for (const CellIndex c : discretization.visited_cells())
      {
        const unsigned int place = discretization.velocity_places(c)[4];
        if (!(W.V.at_place(place).norm() <= farthest * speed))
          W.V.at_place(place) = before.at_place(place);
      }
    }
  } // namespace

  double Newton::search_power(const Equilibrium<double> &stage,
                              Field<double>             &W,
                              const Field<double>       &r,
                              const Field<double>       &step,
                              const ActiveChoice        &active)
  {
    // The pressure takes its full step: it is the multiplier of the functional's constraint.
    for (unsigned int place = 0; place < W.P.size(); ++place)
      W.P.at_place(place) += step.P.at_place(place);
    Field<double> velocity_step = step;
    std::fill(velocity_step.P.begin(), velocity_step.P.end(), 0.);
    const auto residual_at = [&](const double a) {
      Field<double> trial = W;
      trial.add(a, velocity_step);
      return stage.residual(trial, active);
    };
    const Field<double> whole = residual_at(1.);
    // What the new pressures add to the slope at the start is their product with the change of continuity,
    // which is linear in the velocity.
    const auto &discretization = scene_.discretization;
    double      added          = 0.;
    for (unsigned int place = 0; place < discretization.pressure_nodes()->n_owned(); ++place)
      added += step.P.at_place(place) * (whole.P.at_place(place) - r.P.at_place(place));
    const double start = slope(r, step) + discretization.sum(added);
    double       a     = 1.;
    if (start < 0.)
    {
      // Bracketed secant for the root of a monotone function. A rough root is not enough: where a step has to be
      // cut, what it leaves of the slope costs further steps, and each is a linear solve.
      double                 low = 0., low_slope = start, high = -1., high_slope = 0.;
      constexpr unsigned int trials     = 12;
      constexpr double       rough_root = 0.1, uphill = 0.1; // of the slope at the start
      for (unsigned int trial = 0; trial < trials; ++trial)
      {
        double s = slope(trial == 0 ? whole : residual_at(a), step);
        if (s <= uphill * std::abs(start) && -s <= rough_root * std::abs(start))
          break;
        // Stresses that hardly feel the rate turn their sign without growing: a slope that is as large on the
        // way back tells that the root is far behind.
        if (s > 0. && s <= rough_root * std::abs(start))
        {
          const double halfway = slope(residual_at(0.5 * a), step);
          if (halfway <= uphill * std::abs(start))
            break;
          a *= 0.5;
          s = halfway;
        }
        if (s > 0.)
        {
          high       = a;
          high_slope = s;
        }
        else
        {
          low       = a;
          low_slope = s;
        }
        if (high < 0.)
          break; // still descending at the full step: take it
        const double root = low - low_slope * (high - low) / (high_slope - low_slope);
        a                 = std::min(std::max(root, low + 0.1 * (high - low)), high - 0.1 * (high - low));
      }
    }
    W.add(a, velocity_step);
    return a;
  }

  double Newton::search_residual(const Equilibrium<double> &stage,
                                 Field<double>             &W,
                                 const SearchStart         &start,
                                 const Field<double>       &step,
                                 const ActiveChoice        &active)
  {
    // Friction that hardly grows with the slip leaves the residual blind to a step that goes too far.
    Field<double> there = W, r;
    const double  part  = search_power(stage, there, start.r, step, active);
    solve_bubbles_in_reach(stage, start.speed, there);
    if (relative_residual(stage, there, active, start.scale, r) < start.residual)
    {
      W = std::move(there);
      return part;
    }
    constexpr unsigned int trials      = 6;
    constexpr double       worth_while = 0.1; // of the fall that the tangent promises
    double                 a = 1., best = 1., least = 0.;
    Field<double>          found;
    for (unsigned int i = 0; i < trials; ++i, a *= 0.5)
    {
      there = W;
      there.add(a, step);
      solve_bubbles_in_reach(stage, start.speed, there);
      const double residual = relative_residual(stage, there, active, start.scale, r);
      if (i == 0 || residual < least)
      {
        least = residual;
        best  = a;
        found = there;
      }
      if (residual <= (1. - worth_while * a) * start.residual)
        break;
    }
    W = std::move(found);
    return best;
  }

  double Newton::search(const Equilibrium<double> &stage,
                        Field<double>             &W,
                        const SearchStart         &start,
                        const Field<double>       &step,
                        const ActiveChoice        &active)
  {
    return stage.has_potential() ? search_power(stage, W, start.r, step, active)
                                 : search_residual(stage, W, start, step, active);
  }

  namespace
  {
    /// The pairs at a gap of no more than `near` [mm].
    ActiveSet pairs_within(const double near, const Equilibrium<double> &stage)
    {
      ActiveSet active;
      for (const auto &projection : stage.contact.projections)
        active.push_back(projection.delta <= near);
      return active;
    }
  } // namespace

  void Newton::initial_guess(const Equilibrium<double> &stage,
                             Field<double>             &W,
                             const ActiveChoice        &frozen,
                             NewtonStatistics          &statistics)
  {
    const auto [volume, speed] = volume_and_speed(stage);
    Physics<double> newtonian  = stage.physics;
    newtonian.material         = stage.physics.material.initial_law().newtonian(typical_rate(volume, speed));
    const double slip = 0.1 * speed, rate = typical_rate(volume, speed),
                 pressure = 1.5 * rate * newtonian.material.law(1.5 * rate * rate);
    const auto linearise  = [&](const ZoneFriction<double> &friction) {
      return linear_friction(
        friction, {slip, pressure, rate}, stage.physics.material.initial_law(), newtonian.material.law);
    };
    for (auto &die : newtonian.dies)
    {
      die.friction      = linearise(die.own_friction());
      die.interface_law = 0;
      for (ZoneFriction<double> &zone : die.zones)
        zone = {linearise(zone), 0., 0};
    }
    const Equilibrium<double> linear(scene_, newtonian, stage.contact, stage.X);
    // Nodes at rest against a die at rest must feel it: all that touch count as active in the first matrix.
    ActiveSet     active = frozen.is_given() ? *frozen : pairs_within(speed * stage.contact.tau, stage);
    Field<double> step;
    for (unsigned int pass = 0; pass < 3; ++pass)
    {
      Field<double> r = linear.residual(W, active);
      Field<double> rhs(scene_.discretization);
      rhs.add(-1., r);
      system_.assemble(linear, W, active);
      statistics.krylov += system_.solve(rhs, 1e-4, step);
      ++statistics.iterations;
      W.add(1., step);
      if (frozen.is_given() || linear.decide_active(W) == active)
        break;
      active = linear.decide_active(W);
    }
    // No die reaches the metal: it stays where it is, and does not drift along a motion that costs nothing.
    active = frozen.is_given() ? *frozen : linear.decide_active(W);
    if (std::none_of(active.begin(), active.end(), [](const char pressed) { return pressed != 0; }))
      W = Field<double>(scene_.discretization);
  }

  namespace
  {
    /// Whether no node moves, on any rank.
    bool is_at_rest(const Discretization<3> &discretization, const Field<double> &W)
    {
      bool moves = false;
      for (unsigned int place = 0; place < discretization.condensed_nodes()->n_owned(); ++place)
        moves = moves || W.V.at_place(place).norm_square() > 0.;
      return dealii::Utilities::MPI::max(moves ? 1 : 0, discretization.comm()) == 0;
    }
  } // namespace

  /// Steps within which contacts are to be found at once.
  constexpr unsigned int contacts_settle = 20;

  /// Steps at constant viscosity that a start from another mesh begins with.
  constexpr unsigned int picard_steps = 2;

  /// Where less of a step is taken, the next is at constant viscosity.
  constexpr double short_step = 0.6;

  /// Residual down to which steps are tried by line search, and bubbles settle after them; below it they are
  /// whole.
  constexpr double settled = 1e-6;

  /// Residual below which a whole step should leave less than poor_fall of it.
  constexpr double close = 1e-3, poor_fall = 0.2;

  /// Linear systems are not solved better than this only because steps are poor.
  constexpr double least_forcing = 1e-6;

  /// Residual below which rounding may be all that is left of it, and the steps in a row that show it: where a
  /// billet rests on few nodes, it is more than the smallest tolerances.
  constexpr double       rounding   = 1e-11;
  constexpr unsigned int idle_steps = 10;

  /// How well the last step of a replay is solved for. Replays are made to be subtracted from each other, and
  /// begin so close to their solutions that the tolerance says little: each takes one step more.
  constexpr double refined = 1e-5;

  namespace
  {
    /// How exactly the linear systems of steps are solved: relative to their right-hand sides.
    class Forcing
    {
    public:
      Forcing(const NewtonParameters &parameters, const bool linear)
          : parameters_(parameters), linear_(linear), largest_(parameters.forcing)
      {
      }

      /// Close to the solution, Newton's steps fall short because their systems are solved too roughly: squashed
      /// elements weigh less in the solver's norm than in the residual's.
      /// @param last  the residual before a whole step
      void learn_from_fall(const double residual, const double last)
      {
        if (residual < close && residual > poor_fall * last)
          largest_ = std::max(least_forcing, 0.1 * largest_);
      }

      /// A step that had to be cut was a poor direction: where dies are stiff, the next one is solved for better.
      void learn_from_search(const bool whole)
      {
        largest_ =
          whole ? std::min(parameters_.forcing, 10. * largest_) : std::max(least_forcing, 0.1 * largest_);
      }

      /// As good as the quadratic convergence that the residual's fall, or its size, promises.
      double operator()(const double residual, const double last) const
      {
        const double goal    = 0.1 * parameters_.tolerance / std::max(residual, parameters_.tolerance);
        const double fall    = residual / last;
        const double promise = 0.1 * std::max(residual, fall * fall);
        const double forcing = linear_ ? goal : std::max(goal, std::min(largest_, promise));
        return std::min(0.5, std::max(1e-12, forcing));
      }

    private:
      const NewtonParameters &parameters_;
      bool                    linear_;
      double                  largest_;
    };
  } // namespace

  NewtonStatistics Newton::solve(const Equilibrium<double> &stage,
                                 Field<double>             &W,
                                 const ActiveChoice        &frozen,
                                 const Origin               origin,
                                 const ActiveChoice        &pressed)
  {
    Assert(&stage.scene == &scene_, dealii::ExcMessage("the stage is of another scene than the matrix"));
    Assert(W.belongs_to(scene_.discretization),
           dealii::ExcMessage("the guess is of another discretisation than the stage"));
    Assert(frozen.fits(stage.contact.pairs.size()) && pressed.fits(stage.contact.pairs.size()),
           dealii::ExcMessage("a choice of active contacts has an entry for each pair"));
    NewtonStatistics statistics;
    const bool       linear    = stage.is_linear();
    const bool       from_rest = is_at_rest(scene_.discretization, W);
    if (from_rest && !linear)
      initial_guess(stage, W, frozen, statistics);
    // A recorded active set comes with its solution.
    const bool        decides = !frozen.is_given() && !linear;
    std::vector<char> held;
    // Friction that follows the pressure needs to know it from the start.
    if (decides && (!from_rest || !stage.has_potential()))
      held = project_onto_dies(stage, W, pressed);
    const double speed = volume_and_speed(stage).second;
    solve_bubbles_in_reach(stage, speed, W);
    if (!held.empty())
      apply_contact_pressure(stage, held, W);
    unsigned int  picard    = decides && origin == Origin::transferred ? picard_steps : 0;
    const Scale   reference = reference_scale(stage);
    Scale         scale;
    Field<double> r, step;
    Forcing       forcing(parameters_, linear);
    double        last  = 1.;
    bool          whole = false; // the step before
    unsigned int  idle  = 0;
    for (unsigned int iteration = 0; iteration < parameters_.max_iterations; ++iteration)
    {
      // At rest nothing is pressed: the first matrix has the contacts that touch.
      std::optional<ActiveSet> touching;
      if (from_rest && iteration == 0 && !frozen.is_given() && linear)
        touching = pairs_within(0., stage);
      const ActiveChoice first_active = touching ? ActiveChoice(touching) : frozen;
      const auto         assemble     = [&]() {
        system_.assemble(stage, W, first_active, picard > 0 ? Linearisation::picard : Linearisation::newton);
      };
      // The first matrix makes the frames and scales that residuals are measured in.
      if (iteration == 0)
        assemble();
      // Close to the solution the scale hardly changes any more.
      if (last >= close)
        scale = scale_of(stage, W, reference);
      statistics.residual = relative_residual(stage, W, first_active, scale, r);
      idle             = statistics.residual <= rounding && statistics.residual > 0.5 * last ? idle + 1 : 0;
      const bool found = !touching && (statistics.residual <= parameters_.tolerance || idle >= idle_steps);
      if (found && !frozen.is_given())
        return statistics;
      if (iteration > 0)
        assemble();
      picard -= picard > 0;
      if (whole)
        forcing.learn_from_fall(statistics.residual, last);
      Field<double> rhs(scene_.discretization);
      rhs.add(-1., r);
      statistics.krylov += system_.solve(rhs, found ? refined : forcing(statistics.residual, last), step);
      ++statistics.iterations;
      if (found)
      {
        W.add(1., step);
        return statistics;
      }
      if (!touching && statistics.residual > settled)
      {
        const SearchStart start{r, statistics.residual, scale, speed};
        double            taken;
        if (decides && iteration < contacts_settle)
        {
          const ActiveSet active = stage.decide_active(W);
          taken                  = search(stage, W, start, step, active);
          clip_to_dies(stage, active, W);
        }
        else
        {
          taken = search(stage, W, start, step, frozen);
          forcing.learn_from_search(taken == 1.);
        }
        whole = taken == 1.;
        if (!linear && taken < short_step)
          picard = std::max(picard, 1u);
      }
      else
        W.add(1., step);
      if (statistics.residual > settled)
        solve_bubbles_in_reach(stage, speed, W);
      last = statistics.residual;
    }
    std::ostringstream what;
    what << "the equilibrium was not reached in " << parameters_.max_iterations << " iterations (residual "
         << statistics.residual << ")";
    throw NoEquilibrium("Newton",
                        what.str(),
                        "each increment must be in equilibrium before the next",
                        "raise the slip regularisation or the regularising strain rate, or shorten the "
                        "increments");
  }
} // namespace retroforge
