// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/optimization/local_model.h>
#include <retroforge/optimization/search.h>
#include <retroforge/optimization/small_vectors.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace retroforge
{
  namespace
  {
    /// The part of x along orthonormal directions.
    std::vector<double> along(const std::vector<std::vector<double>> &directions,
                              const std::vector<double>              &x)
    {
      std::vector<double> part(x.size(), 0.);
      for (const std::vector<double> &direction : directions)
        for (std::size_t j = 0; j < x.size(); ++j)
          part[j] += dot(direction, x) * direction[j];
      return part;
    }
  } // namespace

  Search::Search(const DesignSpace            &space,
                 const Criteria               &criteria,
                 const OptimizationParameters &parameters,
                 SearchTask                    task)
      : space_(space), criteria_(criteria), parameters_(parameters), task_(std::move(task))
  {
  }

  double Search::merit_of(const Evaluation &evaluation) const
  {
    return evaluation.failed() ? INFINITY : merit_.value(evaluation.values);
  }

  std::vector<double> Search::multipliers() const
  {
    std::vector<double> multipliers = merit_.multipliers;
    for (double &multiplier : multipliers)
      multiplier *= merit_.size;
    return multipliers;
  }

  void Search::begin(const Evaluation &start)
  {
    now_   = start;
    x_     = space_.scaled(now_.mu);
    merit_ = {&criteria_, criteria_.value(now_.values), 1., {}, {}};
    // A unit of merit is what the first step promises where nothing bends: so the first guess of the Hessian,
    // which is one, is of the right size.
    const double slope = varied_length(merit_.gradient(now_.values, now_.gradients));
    // Where it does not feel the design yet, as a die that nothing touches, a thousandth of it has to do.
    constexpr double flat = 1e-8, felt = 1e-3;
    const double     value = std::abs(criteria_.value(now_.values));
    merit_.size            = slope > flat * value ? slope / parameters_.first_step
                             : value > 0.         ? felt * value / parameters_.first_step
                                                  : 1.;
    merit_.multipliers.assign(criteria_.limits.size(), 0.);
    for (const Limit &limit : criteria_.limits)
      merit_.penalties.push_back(curving_penalty(limit).value_or(1.));
    merit_.multipliers = fitted_multipliers();
    radius_            = parameters_.first_step;
  }

  double Search::varied_length(const std::vector<double> &by_mu) const
  {
    std::vector<double> by_x = space_.pull_back(by_mu);
    for (std::size_t j = 0; j < by_x.size(); ++j)
      if (space_.at(now_.mu, j) == DesignSpace::At::fixed)
        by_x[j] = 0.;
    return length(by_x);
  }

  std::optional<double> Search::curving_penalty(const Limit &limit) const
  {
    const double     slope     = limit.slope() * varied_length(now_.gradients[limit.objective]);
    constexpr double curvature = 10.; // of the penalty, in that of the first guess of the Hessian
    return slope != 0. ? std::optional<double>(curvature / (slope * slope)) : std::nullopt;
  }

  bool Search::raise_penalties(const std::vector<double> &before, const std::vector<double> &least)
  {
    constexpr double largest_growth = 1e6; // beyond, rounding rules
    bool             raised         = false;
    for (std::size_t i = 0; i < before.size(); ++i)
    {
      const double excess = criteria_.limits[i].excess(now_.values);
      double      &rho    = merit_.penalties[i];
      if (excess > 0.1 * before[i] && excess > parameters_.limit_tolerance && rho < largest_growth * least[i])
      {
        rho    = std::max(4. * rho, curving_penalty(criteria_.limits[i]).value_or(0.));
        raised = true;
      }
    }
    return raised;
  }

  std::vector<DifferenceCheck> Search::check()
  {
    const BoundedProblem asked = problem();
    std::mt19937         generator(2);
    std::vector<double>  direction(space_.size());
    for (std::size_t j = 0; j < direction.size(); ++j)
    {
      // Both ways must be free.
      const double sign = generator() % 2 == 0 ? 1. : -1.;
      direction[j]      = space_.at(now_.mu, j) == DesignSpace::At::inside ? sign : 0.;
    }
    if (!space_.relations().empty())
      direction = along(space_.free_directions(now_.mu), direction);
    const std::vector<double> steps = {1e-1, 1e-2, 1e-3};
    return check_derivative(asked, direction, steps);
  }

  double Search::noise_of_limits() const
  {
    double square = 0.;
    for (std::size_t i = 0; i < criteria_.limits.size() && !value_noise_.empty(); ++i)
    {
      // A limit that a lucky design keeps by less than its noise presses at the next.
      const Limit &limit  = criteria_.limits[i];
      const double excess = limit.excess(now_.values);
      const double noise  = std::abs(limit.slope()) * value_noise_[limit.objective];
      square += std::pow(merit_.term(i, excess + noise) - merit_.term(i, excess), 2);
    }
    return std::sqrt(square);
  }

  double Search::noise() const
  {
    return std::hypot(noise_, noise_of_limits());
  }

  double Search::descent() const
  {
    std::vector<double> by_x = space_.pull_back(merit_.gradient(now_.values, now_.gradients));
    for (std::size_t j = 0; j < by_x.size(); ++j)
    {
      const auto at = space_.at(now_.mu, j);
      if (at == DesignSpace::At::fixed || (at == DesignSpace::At::lower && by_x[j] > 0.) ||
          (at == DesignSpace::At::upper && by_x[j] < 0.))
        by_x[j] = 0.;
    }
    return length(by_x);
  }

  void Search::set_noise(const double noise, std::vector<double> of_values)
  {
    noise_       = noise / merit_.size;
    value_noise_ = std::move(of_values);
  }

  bool Search::run()
  {
    if (criteria_.limits.empty())
    {
      minimize_merit();
      return false;
    }
    constexpr unsigned int most_rounds = 50;
    // Limits that five rounds of a penalty four times as large each do not bring nearer cannot be met.
    constexpr unsigned int    most_in_vain    = 5;
    constexpr double          nearer          = 0.99;
    const std::vector<double> first_penalties = merit_.penalties;
    double                    excess          = criteria_.largest_excess(now_.values);
    unsigned int              n_in_vain       = 0;
    for (unsigned int round = 0; round < most_rounds; ++round)
    {
      std::vector<double> before;
      for (const Limit &limit : criteria_.limits)
        before.push_back(std::max(limit.excess(now_.values), 0.));
      const unsigned int iterations = iterations_;
      minimize_merit();
      if (stop_ == SearchStop::iterations || stop_ == SearchStop::simulations)
        break;
      const std::vector<double> multipliers = fitted_multipliers();
      const bool                settled     = limits_are_settled(multipliers);
      const bool                is_stuck    = iterations_ == iterations && multipliers == merit_.multipliers;
      merit_.multipliers                    = multipliers;
      if (settled)
        return true;
      const double excess_now = criteria_.largest_excess(now_.values);
      if (!raise_penalties(before, first_penalties) && is_stuck)
        break;
      n_in_vain = excess_now > nearer * excess ? n_in_vain + 1 : 0;
      if (n_in_vain == most_in_vain && excess_now > parameters_.limit_tolerance)
        break;
      excess = excess_now;
      task_.renewed(excess);
    }
    if (stop_ != SearchStop::iterations && stop_ != SearchStop::simulations &&
        criteria_.largest_excess(now_.values) > parameters_.limit_tolerance)
      stop_ = SearchStop::limits;
    return false;
  }

  BoundedProblem Search::problem()
  {
    BoundedProblem problem;
    problem.start     = x_;
    problem.lower     = space_.scaled_lower();
    problem.upper     = space_.scaled_upper();
    problem.relations = space_.scaled_relations();
    problem.value = [&](const std::vector<double> &x) { return merit_of(task_.evaluate(space_.values(x))); };
    problem.linearize = [&](const std::vector<double> &x) {
      x_   = x;
      now_ = task_.differentiate(space_.values(x));
      return linearization();
    };
    problem.learns  = criteria_.data.empty();
    problem.decided = [&](const std::vector<double> &x, const bool accepted) {
      task_.decided(task_.evaluate(space_.values(x)), accepted);
    };
    return problem;
  }

  void Search::minimize_merit()
  {
    for (;;)
    {
      stop_ = SearchStop::running;
      minimize_on_one_mesh();
      if (stop_ != SearchStop::mesh)
        return;
      if (const std::optional<Evaluation> again = task_.renew_mesh(now_))
        now_ = *again;
    }
  }

  void Search::minimize_on_one_mesh()
  {
    // A step shorter than the noise lets see tells nothing: the first one promises several times as much,
    // where the largest step can. A round before may have ended with steps as short as its noise.
    constexpr double several = 4.;
    const double     slope   = space_.projected_length(now_.mu, merit_.gradient(now_.values, now_.gradients));
    double           seen    = slope > 0. ? several * noise_ / slope : 0.;
    if (const double steepest = descent(); noise_of_limits() > 0. && steepest > 0.)
      seen = std::max(seen, several * noise() / steepest);
    const double radius =
      std::clamp(std::max(radius_, seen), 0.25 * parameters_.first_step, parameters_.largest_step);
    begun_with_ = slope;
    begun_at_   = iterations_;
    n_designs_  = task_.n_evaluated();
    n_repeated_ = 0;
    merits_.clear();
    minimizer_.minimize(problem(), {radius, parameters_.largest_step, [&](const MinimizerState &state) {
                                      return go_on(state);
                                    }});
  }

  bool Search::go_on(const MinimizerState &state)
  {
    radius_ = state.radius;
    // Designs that were tried before cost nothing, as all but the first of those that shorter and shorter
    // steps ask for again.
    const bool is_new = task_.n_evaluated() != n_designs_;
    iterations_ += is_new ? 1 : 0;
    n_repeated_ = is_new ? 0 : n_repeated_ + 1;
    n_designs_  = task_.n_evaluated();
    if (is_new)
      merits_.push_back(state.value);
    constexpr double shortest = 1e-5;
    // While a limit presses, multipliers are renewed as soon as most of what the last ones changed is done;
    // and where the merit is rough, that does not come and the limit is far off, after some steps, so that
    // the penalty may grow.
    constexpr double       part          = 0.1;
    constexpr unsigned int longest_round = 8;
    const bool             presses       = !pressing().empty();
    const double           enough        = presses ? part * begun_with_ : 0.;
    constexpr double       far_off       = 0.01; // of the limit
    constexpr double       seen_part     = 0.1;  // of the noise
    // Of data the misfit is in squares of deviations: a start far off says nothing of how near its least one is.
    constexpr double within_deviations = 0.005; // a tenth of a deviation
    // Where noise hides all, from one corner between bounds to another and back.
    constexpr unsigned int most_repeated = 50;
    const bool             is_long =
      iterations_ - begun_at_ >= longest_round && criteria_.largest_excess(now_.values) > far_off;
    const bool may_go_on =
      iterations_ < parameters_.iterations && task_.n_evaluated() < parameters_.simulations;
    // First of all: what a bad mesh says of the others is not worth much.
    if (may_go_on && task_.mesh_is_bad && task_.mesh_is_bad(now_))
      stop_ = SearchStop::mesh;
    else if (is_long ||
             (state.gradient <= std::max(enough, parameters_.gradient_tolerance * parameters_.first_step) &&
              (criteria_.data.empty() || state.promised * merit_.size <= within_deviations)))
      stop_ = SearchStop::gradient;
    else if (n_repeated_ > most_repeated || state.gradient * state.radius <= noise_ ||
             (noise_of_limits() > 0. && descent() * state.radius <= noise()) ||
             (state.promised <= seen_part * noise() &&
              criteria_.largest_excess(now_.values) <= parameters_.limit_tolerance))
      stop_ = SearchStop::noise;
    else if (state.radius < shortest * parameters_.first_step)
      stop_ = SearchStop::step;
    else if (gains_little())
      // Else it is the round that ends, and the penalty of what is exceeded grows.
      stop_ = criteria_.largest_excess(now_.values) <= parameters_.limit_tolerance ? SearchStop::gains
                                                                                   : SearchStop::gradient;
    else if (iterations_ >= parameters_.iterations)
      stop_ = SearchStop::iterations;
    else if (task_.n_evaluated() >= parameters_.simulations)
      stop_ = SearchStop::simulations;
    return stop_ == SearchStop::running;
  }

  bool Search::gains_little() const
  {
    // Data are met to parts of their deviations, however little of the misfit that is.
    constexpr std::size_t designs = 8;
    return criteria_.data.empty() && merits_.size() > designs &&
           merits_[merits_.size() - 1 - designs] - merits_.back() <
             parameters_.least_gain * std::abs(criteria_.value(now_.values)) / merit_.size;
  }

  Linearization Search::linearization() const
  {
    const auto scaled = [&](const unsigned int objective, const double factor) {
      std::vector<double> row = space_.pull_back(now_.gradients[objective]);
      for (double &entry : row)
        entry *= factor;
      return row;
    };
    Linearization known;
    known.noise = noise();
    known.gradient.assign(x_.size(), 0.);
    for (unsigned int o = 0; o < now_.gradients.size(); ++o)
      if (criteria_.objective.weights[o] != 0.)
        add(
          criteria_.objective.weights[o] / merit_.size, space_.pull_back(now_.gradients[o]), known.gradient);
    for (const Datum &datum : criteria_.data)
      known.terms.push_back(
        {datum.misfit(now_.values), scaled(datum.objective, 1. / datum.deviation), 1. / merit_.size});
    for (unsigned int i = 0; i < criteria_.limits.size(); ++i)
    {
      const Limit &limit = criteria_.limits[i];
      known.terms.push_back({limit.excess(now_.values),
                             scaled(limit.objective, limit.slope()),
                             merit_.penalties[i],
                             true,
                             merit_.multipliers[i]});
    }
    return known;
  }

  std::vector<unsigned int> Search::pressing() const
  {
    std::vector<unsigned int> limits;
    for (unsigned int i = 0; i < criteria_.limits.size(); ++i)
      if (merit_.pressed(i, now_.values) > 0.)
        limits.push_back(i);
    return limits;
  }

  std::vector<double> Search::fitted_multipliers() const
  {
    const std::vector<std::vector<double>> free = space_.free_directions(now_.mu);
    const auto over_free                        = [&](const std::vector<double> &by_mu, const double factor) {
      const std::vector<double> by_x = space_.pull_back(by_mu);
      std::vector<double>       part;
      for (const std::vector<double> &direction : free)
        part.push_back(factor * dot(direction, by_x));
      return part;
    };
    Merit plain = merit_;
    plain.multipliers.clear();
    const std::vector<double>        g = over_free(plain.gradient(now_.values, now_.gradients), 1.);
    std::vector<std::vector<double>> columns;
    const std::vector<unsigned int>  pressed = pressing();
    for (const unsigned int i : pressed)
      columns.push_back(
        over_free(now_.gradients[criteria_.limits[i].objective], criteria_.limits[i].slope()));
    const std::vector<double> fitted = least_squares_multipliers(g, columns);
    std::vector<double>       multipliers(criteria_.limits.size(), 0.);
    for (std::size_t k = 0; k < pressed.size(); ++k)
      multipliers[pressed[k]] = fitted[k];
    return multipliers;
  }

  bool Search::limits_are_settled(const std::vector<double> &multipliers) const
  {
    Merit lagrangian = merit_;
    lagrangian.multipliers.clear();
    std::vector<double> gradient = lagrangian.gradient(now_.values, now_.gradients);
    for (std::size_t i = 0; i < multipliers.size(); ++i)
    {
      const Limit &limit  = criteria_.limits[i];
      const double excess = limit.excess(now_.values);
      // What a limit that presses still leaves to be gained may be less than the noise.
      if (excess > parameters_.limit_tolerance ||
          (excess < -parameters_.limit_tolerance && multipliers[i] * -excess > noise_))
        return false;
      for (std::size_t j = 0; j < gradient.size(); ++j)
        gradient[j] += multipliers[i] * limit.slope() * now_.gradients[limit.objective][j];
    }
    constexpr double looser = 10.; // than what each round is asked for
    return stop_ == SearchStop::noise || stop_ == SearchStop::step || stop_ == SearchStop::gains ||
           space_.projected_length(now_.mu, gradient) <=
             looser * parameters_.gradient_tolerance * parameters_.first_step;
  }
} // namespace retroforge
