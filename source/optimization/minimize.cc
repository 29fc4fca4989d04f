// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/optimization/fences.h>
#include <retroforge/optimization/local_model.h>
#include <retroforge/optimization/minimize.h>
#include <retroforge/optimization/small_vectors.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace retroforge
{
  namespace
  {
    using Vector = BoundedProblem::Vector;

    constexpr double rounding = 1e-14; // of gradients, in their entries

    double largest_entry(const Vector &x)
    {
      double largest = 0.;
      for (const double entry : x)
        largest = std::max(largest, std::abs(entry));
      return largest;
    }

    /// Returns the length of  P(x - g) - x: the least of  g.s + |s|^2 / 2  is there.
    double projected_gradient(const BoundedProblem &problem, const Vector &x, const Vector &gradient)
    {
      const Linearization flat{gradient, {}};
      const LocalModel    round(x, flat, [](const Vector &v) { return v; });
      constexpr double    infinity = std::numeric_limits<double>::infinity();
      return length(difference(least_of(round, problem, infinity, rounding * largest_entry(gradient)), x));
    }

    /// The change of the gradient over a step, of terms only what comes from their values' bending: so no kink
    /// of a limit is learned.
    Vector change_of_slopes(const Linearization &before, const Linearization &now)
    {
      Vector change = difference(now.gradient, before.gradient);
      for (std::size_t i = 0; i < now.terms.size(); ++i)
        add(now.terms[i].slope(now.terms[i].c),
            difference(now.terms[i].gradient, before.terms[i].gradient),
            change);
      return change;
    }
  } // namespace

  Vector Minimizer::minimize(const BoundedProblem &problem, const MinimizerSettings &settings)
  {
    constexpr double least_kept = 0.05, poor = 0.25, good = 0.75; // parts of what the model promised
    constexpr double refused_by = 0.25, failed_by = 0.5, poor_by = 0.5, good_by = 2.5;
    constexpr double at_edge = 0.8; // of the radius

    Vector              x      = problem.start;
    double              value  = problem.value(x);
    Linearization       known  = problem.linearize(x);
    double              radius = settings.first_radius;
    Fences              fences;
    LocalModel::Hessian hessian;
    if (problem.learns)
      hessian = [&](const Vector &v) { return learned_.times(v); };
    for (unsigned int iteration = 0;; ++iteration)
    {
      const Vector     gradient  = known.whole_gradient();
      const double     projected = projected_gradient(problem, x, gradient);
      const LocalModel model(x, known, hessian);
      constexpr double exact     = 1e-8;
      const double     tolerance = std::max(exact * projected, rounding * largest_entry(gradient));
      Vector           tried     = least_of(model, problem, radius, tolerance);
      double           promised  = -model.change(tried);
      if (!fences.empty())
      {
        const Vector     beside       = least_of(model.with(fences.terms(model)), problem, radius, tolerance);
        const double     promised_too = -model.change(beside);
        constexpr double enough       = 0.1;
        if (promised_too <= enough * promised)
        {
          // They leave too little, and say no more than that a point has failed.
          fences.clear();
          radius *= refused_by;
          continue;
        }
        tried    = beside;
        promised = promised_too;
      }
      const Vector step  = difference(tried, x);
      const double reach = largest_entry(step);
      if (!settings.go_on({iteration, value, projected, radius, promised}))
        return x;
      if (!(promised > 0.))
      {
        radius *= refused_by;
        continue;
      }
      const double value_there = problem.value(tried);
      const double noise =
        std::max(known.noise, 100. * std::numeric_limits<double>::epsilon() * std::abs(value));
      const double kept     = (value - value_there + noise) / (promised + noise);
      const bool   accepted = std::isfinite(value_there) && kept > least_kept;
      problem.decided(tried, accepted);
      if (!accepted)
      {
        if (std::isinf(value_there))
          fences.add(x, tried);
        radius = (std::isinf(value_there) ? failed_by : refused_by) * reach;
        continue;
      }
      if (kept < poor)
        radius = poor_by * reach;
      else if (kept > good && reach > at_edge * radius)
        radius = std::min(good_by * radius, settings.largest_radius);
      const Linearization before = std::exchange(known, problem.linearize(tried));
      if (problem.learns)
        learned_.learn(step, change_of_slopes(before, known), before.noise);
      x     = tried;
      value = value_there;
      fences.loosen(x);
    }
  }
} // namespace retroforge
