// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/dual.h>
#include <retroforge/geometry/closing_speed.h>
#include <retroforge/solver/contact_pullback.h>
#include <retroforge/solver/spent_power.h>

#include <algorithm>

namespace retroforge
{
  namespace
  {
    // Order of the terms: deformation, friction, m, then the moments of each die.
    constexpr std::size_t of_friction = 1, of_m = 2, of_dies = 3, n_moments = n_closing_moments;

    /// Speed of closing, as a part of that of the dies, below which points rest: there kappa would follow the last
    /// digits.
    constexpr double at_rest = 0.025;

    /// The same for the approach to points by which one sees how far the die is off.
    constexpr double standing = 0.01;

    /// Part of an increment that a die presses after it arrived, below which it does not count.
    constexpr double just_touching = 1e-12;

    /// m is no sum: one rank has it.
    bool has_number_of_metal(const Scene &scene)
    {
      return dealii::Utilities::MPI::this_mpi_process(scene.discretization.comm()) == 0;
    }

    /// Edges do, whose penalty is soft.
    template <typename Number>
    bool sinks(const Equilibrium<Number> &stage, const unsigned int p)
    {
      return !stage.contact.pairs[p].point.has_own_velocity();
    }

    template <typename Number>
    bool is_counted(const Equilibrium<Number> &stage, const unsigned int p)
    {
      return stage.contact.counts_closing &&
             stage.scene.discretization.owns(stage.contact.pairs[p].point.nodes[0]);
    }
  } // namespace

  template <typename Number>
  Number rest_speed(const std::vector<DieState<Number>> &dies)
  {
    return standing * closing_speed(dies);
  }

  void reverse_rest_speed(const std::vector<DieState<double>> &dies,
                          const double                         speed_bar,
                          std::vector<DieState<double>>       &dies_bar)
  {
    const ClosingDies closing = closing_dies(dies);
    const Vec3        v       = closing.velocity(dies);
    if (!(v.norm() > 0.))
      return;
    const Vec3 v_bar = standing * speed_bar / v.norm() * v;
    dies_bar[closing.die].velocity += v_bar;
    if (closing.other != invalid_index)
      dies_bar[closing.other].velocity -= v_bar;
  }

  template <typename Number>
  std::vector<Number> power_terms(const EquilibriumView<Number> &view)
  {
    const Equilibrium<Number> &stage = view.stage;
    std::vector<Number>        terms(n_power_terms(stage.scene.dies.size()), Number(0.));
    std::tie(terms[0], terms[of_friction]) = stage.power(view.W, view.active);
    if (has_number_of_metal(stage.scene))
      terms[of_m] = stage.physics.material.initial_law().m;
    const Number u_r = rest_speed(stage.physics.dies);
    for (unsigned int p = 0; p < stage.contact.pairs.size(); ++p)
      if (is_counted(stage, p))
      {
        const auto moments = closing_moments(
          stage.contact_node(p, view.W, view.active), stage.physics.contact, u_r, sinks(stage, p));
        for (unsigned int i = 0; i < n_moments; ++i)
          terms[of_dies + n_moments * stage.contact.pairs[p].die + i] += moments[i];
      }
    return terms;
  }

  void reverse_power_terms(const EquilibriumView<double> &view,
                           const std::vector<double>     &weights,
                           EquilibriumBar                &bar)
  {
    const Equilibrium<double> &stage = view.stage;
    Assert(weights.size() >= n_power_terms(stage.scene.dies.size()),
           dealii::ExcDimensionMismatch(weights.size(), n_power_terms(stage.scene.dies.size())));
    reverse_power(view, weights[0], weights[of_friction], bar);
    if (has_number_of_metal(stage.scene))
      reverse_initial_law(stage.physics.material, {0., weights[of_m], 0.}, bar.physics.material);
    ContactPullback pullback(view, bar);
    const double    u_r     = rest_speed(stage.physics.dies);
    double          u_r_bar = 0.;
    for (unsigned int p = 0; p < stage.contact.pairs.size(); ++p)
      if (is_counted(stage, p))
      {
        ClosingMoments<double> of_die;
        std::copy_n(
          weights.begin() + of_dies + n_moments * stage.contact.pairs[p].die, n_moments, of_die.begin());
        pullback.add(p,
                     reverse_closing_moments(stage.contact_node(p, view.W, view.active),
                                             stage.physics.contact,
                                             u_r,
                                             sinks(stage, p),
                                             of_die,
                                             u_r_bar));
      }
    pullback.finish();
    reverse_rest_speed(stage.physics.dies, u_r_bar, bar.physics.dies);
  }

  template <typename Number>
  Number closing_power(const std::vector<Number> &terms)
  {
    Number C(0.);
    for (std::size_t d = of_dies; d < terms.size(); d += n_moments)
      C += terms[d + 1];
    return C;
  }

  template <typename Number>
  EnergyParts<Number> spent_power(const std::vector<Number> &terms)
  {
    Assert(terms.size() >= of_dies && (terms.size() - of_dies) % n_moments == 0,
           dealii::ExcMessage("the terms of an increment's power are three, and five of each die"));
    const Number       &m = terms[of_m];
    EnergyParts<Number> parts{terms[0], terms[of_friction], Number(0.)};
    const Number        D = parts.total();
    Number              at_once(0.);
    for (std::size_t d = of_dies; d < terms.size(); d += n_moments)
    {
      const Number &N = terms[d], &Nu = terms[d + 1];
      // The speed at which the die comes to the nearest points, and the moments of what closes beside that.
      const Number common = value_of(terms[d + 3]) > 0. ? Number(terms[d + 4] / terms[d + 3]) : Number(0.);
      const Number beside = Nu - N * common, second = terms[d + 2] - (2. * Nu - N * common) * common;
      const Number rest = (at_rest * D) * (at_rest * D), square = N * second + rest;
      at_once += N * common;
      if (value_of(square) > 0.)
      {
        const Number part = (beside * beside + rest) / square, squared = part * part;
        at_once += beside * squared * squared;
      }
    }
    parts.closing = 0.5 * (1. + m) * (closing_power(terms) - at_once);
    // A die that hardly reaches the metal by the end of the increment spends nothing; one that gives way to it
    // faster than it could close follows the tangent.
    const double least = -0.5 * value_of(D);
    if (value_of(at_once) < least)
      parts.closing +=
        D * (power(Number(0.5), m) - 1.) + m * power(Number(0.5), Number(m - 1.)) * (at_once + 0.5 * D);
    else if (value_of(D) > just_touching * std::abs(value_of(at_once)))
      parts.closing += D * (power(Number(1. + at_once / D), m) - 1.);
    return parts;
  }

  template <typename Number>
  Number force_factor(const std::vector<Number> &terms)
  {
    const EnergyParts<Number> parts = spent_power(terms);
    const Number              given = parts.deformation + parts.friction + closing_power(terms);
    return value_of(given) > 0. ? Number(parts.total() / given) : Number(1.);
  }

#define RETROFORGE_INSTANTIATE(Number)                                            \
  template Number              rest_speed(const std::vector<DieState<Number>> &); \
  template std::vector<Number> power_terms(const EquilibriumView<Number> &);      \
  template EnergyParts<Number> spent_power(const std::vector<Number> &);          \
  template Number              closing_power(const std::vector<Number> &);        \
  template Number              force_factor(const std::vector<Number> &);
  RETROFORGE_INSTANTIATE(double)
  RETROFORGE_INSTANTIATE(Dual)
#undef RETROFORGE_INSTANTIATE
} // namespace retroforge
