// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/quadrature_lib.h>

#include <retroforge/heat/arrivals.h>

#include <algorithm>

namespace retroforge
{
  namespace
  {
    /// Part of the dies' path that a point which does not come nearer is taken to have.
    constexpr double least_part = 0.01;

    /// Gauss' rule where a point is on the ramp: `use(x, weight)`. It is exact, w is of fifth degree.
    template <typename Use>
    void for_each_place(const double delta, const double path, const double gap, const Use &use)
    {
      const double begin = std::max(0., (delta - gap) / path), end = std::min(1., delta / path);
      if (!(begin < end))
        return;
      static const dealii::QGauss<1> rule(4);
      for (unsigned int q = 0; q < rule.size(); ++q)
        use(begin + (end - begin) * rule.point(q)[0], (end - begin) * rule.weight(q));
    }

    FrictionRamp with_walls()
    {
      FrictionRamp ramp;
      ramp.wall = least_part;
      return ramp;
    }
  } // namespace

  template <typename Number>
  Arrivals<Number>::Arrivals(const ThermalReach &reach, const std::vector<DieState<Number>> &states)
      : states_(states), reach_(reach), fading_(reach.fading()), scales_(with_walls(), states)
  {
  }

  template <typename Number>
  Arrival<Number> Arrivals<Number>::operator()(const unsigned int        die,
                                               const Projection<Number> &at,
                                               const Vector3<Number>    *metal) const
  {
    const Number &delta = at.delta;
    if (reach_.path == 0. || value_of(delta) <= 0.)
    {
      const Number w = fading_(delta, true);
      return {w, w, Number(0.)};
    }
    const Number    p = reach_.path * scales_(die, at.n, metal);
    Arrival<Number> of{Number(0.), Number(0.), Number(0.)};
    // Where the point comes onto the ramp and into contact does not count in derivatives: w is continuous there.
    if (const double t = value_of(delta) / value_of(p); t < 1.)
    {
      of.first  = Number((1. - t) * (1. - t));
      of.second = Number(1. - t * t);
    }
    else
      of.gap = delta - p;
    for_each_place(value_of(delta), value_of(p), reach_.gap, [&](const double x, const double weight) {
      const Number w = fading_(Number(delta - p * x), true);
      of.first += 2. * (1. - x) * weight * w;
      of.second += 2. * x * weight * w;
    });
    return of;
  }

  template <typename Number>
  double Arrivals<Number>::reach(const unsigned int die, const Vector3<Number> *metal) const
  {
    if (reach_.path == 0.)
      return reach_.gap;
    double scale = 1.;
    if (metal)
    {
      // Straight towards it.
      Vector3<Number> n     = *metal - states_[die].velocity;
      const double    speed = std::sqrt(value_of(n * n));
      if (speed > 0.)
        n /= Number(speed);
      scale = value_of(scales_(die, n, metal));
    }
    return reach_.gap + reach_.path * scale;
  }

  template <typename Number>
  void Arrivals<Number>::reverse(const unsigned int             die,
                                 const Projection<Number>      &at,
                                 const Vector3<Number>         *metal,
                                 const Arrival<double>         &bar,
                                 double                        &delta_bar,
                                 Vec3                          &n_bar,
                                 Vec3                          &metal_bar,
                                 std::vector<DieState<double>> &states_bar) const
  {
    if (reach_.path == 0. || at.delta <= 0.)
    {
      delta_bar += (bar.first + bar.second) * fading_.derivative(at.delta);
      return;
    }
    const double s = scales_(die, at.n, metal), p = reach_.path * s;
    double       p_bar = 0.;
    if (at.delta >= p)
    {
      delta_bar += bar.gap;
      p_bar -= bar.gap;
    }
    for_each_place(at.delta, p, reach_.gap, [&](const double x, const double weight) {
      const double d_bar =
        2. * weight * (bar.first * (1. - x) + bar.second * x) * fading_.derivative(at.delta - p * x);
      delta_bar += d_bar;
      p_bar -= x * d_bar;
    });
    scales_.reverse(die, at.n, metal, p_bar * reach_.path, n_bar, metal_bar, states_bar);
  }

  template class Arrivals<double>;
  template Arrivals<Dual>::Arrivals(const ThermalReach &, const std::vector<DieState<Dual>> &);
  template Arrival<Dual>
  Arrivals<Dual>::operator()(unsigned int, const Projection<Dual> &, const Vector3<Dual> *) const;
  template double Arrivals<Dual>::reach(unsigned int, const Vector3<Dual> *) const;
} // namespace retroforge
