// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/text.h>
#include <retroforge/objective/largest_wear.h>
#include <retroforge/objective/pairs_of_die.h>
#include <retroforge/objective/sliding_work.h>
#include <retroforge/solver/contact_pullback.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  LargestWear::LargestWear(const unsigned int                 die,
                           DieSites                           sites,
                           const double                       exponent,
                           const PathWindow                  &window,
                           const std::optional<SmoothRegion> &region)
      : die_(die), sites_(std::move(sites)), exponent_(exponent), window_(window), region_(region)
  {
    window.check("Die wear");
    if (region)
      region->check("Die wear");
    if (!(exponent >= 1.))
      throw Error("Die wear",
                  "the exponent of the largest wear is " + as_text(exponent),
                  "it must be at least 1",
                  "use 10 to 50: the larger, the nearer to the maximum");
  }

  template <typename Number>
  std::vector<Number> LargestWear::wear(const PathRows<Number> &rows) const
  {
    std::vector<Number> wear(sites_.size(), Number(0.));
    for (const PathRow<Number> &row : rows)
      if (const Number time = window_.time_inside(row); value_of(time) > 0.)
        for (std::size_t s = 0; s < wear.size(); ++s)
          if (value_of(row.integrals[s]) != 0.)
            wear[s] += time * row.integrals[s];
    return wear;
  }

  template std::vector<double> LargestWear::wear(const PathRows<double> &) const;
  template std::vector<Dual>   LargestWear::wear(const PathRows<Dual> &) const;

  namespace
  {
    template <typename Number>
    std::size_t place_of_largest(const std::vector<Number> &x)
    {
      return std::max_element(x.begin(),
                              x.end(),
                              [](const Number &a, const Number &b) { return value_of(a) < value_of(b); }) -
             x.begin();
    }

    template <typename Number>
    double largest(const std::vector<Number> &x)
    {
      return x.empty() ? 0. : value_of(x[place_of_largest(x)]);
    }
  } // namespace

  template <typename Number>
  Number LargestWear::mean(const std::vector<Number> &wear) const
  {
    using std::pow;
    // What pulls does not wear.
    const double scale = largest(wear);
    if (!(scale > 0.))
      return Number(0.);
    Number sum(0.), weights(0.);
    for (const Number &w : wear)
      if (value_of(w) > 0.)
      {
        const Number part = w / scale, weight = pow(part, exponent_);
        weights += weight;
        sum += weight * part;
      }
    return scale * sum / weights;
  }

  double LargestWear::value(const PathRows<double> &rows) const
  {
    return mean(wear(rows));
  }

  Dual LargestWear::value(const PathRows<Dual> &rows) const
  {
    return mean(wear(rows));
  }

  std::map<std::string, double> LargestWear::details(const PathRows<double> &rows) const
  {
    const auto worn = wear(rows);
    if (!(largest(worn) > 0.))
      return {{"true maximum", 0.}};
    const std::size_t s = place_of_largest(worn);
    const Vec3       &x = sites_.places()[s];
    return {{"true maximum", worn[s]}, {"at x [mm]", x[0]}, {"at y [mm]", x[1]}, {"at z [mm]", x[2]}};
  }

  ObjectiveMap LargestWear::map(const PathRows<double> &rows) const
  {
    return {sites_.places(), wear(rows)};
  }

  PathRows<double> LargestWear::reverse_value(const PathRows<double> &rows) const
  {
    const auto          worn  = wear(rows);
    const double        scale = largest(worn), mean_wear = mean(worn);
    std::vector<double> bar(worn.size(), 0.);
    double              weights = 0.;
    const auto          part    = [&](const std::size_t s) { return worn[s] / scale; };
    for (std::size_t s = 0; s < worn.size(); ++s)
      if (worn[s] > 0.)
        weights += std::pow(part(s), exponent_);
    for (std::size_t s = 0; s < worn.size(); ++s)
      if (worn[s] > 0.)
        bar[s] = std::pow(part(s), exponent_ - 1.) *
                 ((exponent_ + 1.) * part(s) - exponent_ * mean_wear / scale) / weights;
    PathRows<double> rows_bar;
    for (const PathRow<double> &row : rows)
    {
      const double time = window_.time_inside(row);
      double       work = 0.;
      for (std::size_t s = 0; s < bar.size(); ++s)
        work += bar[s] * row.integrals[s];
      const PathRow<double> without{
        {}, row.dt, row.time, row.stroke, row.step, row.place, row.length, row.operation};
      rows_bar.push_back(derivatives_of(
        [&](const PathRow<Dual> &at) { return Dual(work * window_.time_inside(at)); }, without));
      rows_bar.back().integrals = bar;
      for (double &b : rows_bar.back().integrals)
        b *= time;
    }
    return rows_bar;
  }

  template <typename Number>
  std::vector<Number> LargestWear::compute_integrals(const EquilibriumView<Number> &view) const
  {
    const Equilibrium<Number> &stage = view.stage;
    std::vector<Number>        densities(sites_.size(), Number(0.));
    for (unsigned int p = 0; p < stage.contact.pairs.size(); ++p)
      if (is_of_die(view, p, die_))
      {
        const Number work = sliding_work(stage.contact_node(p, view.W, view.active), stage.physics.contact);
        const Vector3<Number> x = stage.contact.pairs[p].point.position(stage.X);
        if (value_of(work) != 0.)
          sites_.gather<Number>(
            x - stage.physics.dies[die_].displacement, weight_in(region_, x) * work, densities);
      }
    return densities;
  }

  void LargestWear::reverse_integrals(const EquilibriumView<double> &view,
                                      const std::vector<double>     &weights,
                                      EquilibriumBar                &bar) const
  {
    const Equilibrium<double> &stage = view.stage;
    const ContactLaw<double>  &law   = stage.physics.contact;
    ContactPullback            pullback(view, bar);
    for (unsigned int p = 0; p < stage.contact.pairs.size(); ++p)
      if (is_of_die(view, p, die_))
      {
        const ContactPoint       &point  = stage.contact.pairs[p].point;
        const ContactNode<double> node   = stage.contact_node(p, view.W, view.active);
        const Vec3                x      = point.position(stage.X);
        const double              inside = weight_in(region_, x), work = sliding_work(node, law);
        const auto                sum = sites_.sum(x - stage.physics.dies[die_].displacement, weights);
        pullback.add(p, reverse_sliding_work(node, law, inside * sum.value));
        const Vec3 y_bar = inside * work * sum.gradient;
        Vec3       x_bar = y_bar;
        if (region_)
          x_bar += sum.value * work * region_->gradient(x);
        point.add_to_position(x_bar, bar.X);
        bar.physics.dies[die_].displacement -= y_bar;
      }
    pullback.finish();
  }

  template std::vector<double> LargestWear::compute_integrals(const EquilibriumView<double> &) const;
  template std::vector<Dual>   LargestWear::compute_integrals(const EquilibriumView<Dual> &) const;
} // namespace retroforge
