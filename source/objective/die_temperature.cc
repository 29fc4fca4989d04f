// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/heat/surface_temperature.h>
#include <retroforge/material/temperature_range.h>
#include <retroforge/objective/die_temperature.h>
#include <retroforge/objective/objective_settings.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  namespace
  {
    /// Returns whether a node touches the die, and is one of this rank.
    template <typename Number>
    bool counts(const FinalView<Number> &view, const TouchingNode<Number> &at, const unsigned int die)
    {
      return at.die == die && value_of(at.area) > 0. && view.scene.discretization.owns(at.node);
    }

    template <typename Number>
    ThermalSurface<Number> under_press(const FinalView<Number> &view)
    {
      Assert(view.skin != nullptr && view.heat != nullptr, dealii::ExcMessage("heat does not flow"));
      return surface_under_press(view.scene.view(view.dies, view.X), value_of(view.heat->gap));
    }

    /// Whether this rank tells what all know.
    template <typename Number>
    bool is_first(const FinalView<Number> &view)
    {
      return dealii::Utilities::MPI::this_mpi_process(view.scene.discretization.comm()) == 0;
    }
  } // namespace

  DieTemperature::Decisions DieTemperature::compute_decisions(const FinalView<double> &view) const
  {
    const auto   surface = under_press(view);
    const auto   t       = dies_surfaces(surface, view.dies, *view.skin);
    const double itself  = view.dies[die_].temperature;
    double       largest = -std::numeric_limits<double>::infinity();
    for (unsigned int i = 0; i < t.size(); ++i)
      if (counts(view, surface.touching[i], die_))
        largest = std::max(largest, t[i]);
    largest = dealii::Utilities::MPI::max(largest, view.scene.discretization.comm());
    return {std::isfinite(largest) ? largest : itself};
  }

  std::map<std::string, double> DieTemperature::details(const std::vector<double> &,
                                                        const FinalDecisions &decisions) const
  {
    return {{"true maximum", std::any_cast<Decisions>(decisions).largest}};
  }

  template <typename Number>
  std::vector<Number> DieTemperature::compute_integrals(const FinalView<Number> &view,
                                                        const Decisions         &decisions) const
  {
    const auto          surface = under_press(view);
    const auto          t       = dies_surfaces(surface, view.dies, *view.skin);
    std::vector<Number> sums(3, Number(0.));
    for (unsigned int i = 0; i < t.size(); ++i)
      if (const auto &at = surface.touching[i]; counts(view, at, die_))
      {
        const auto f = mean_.terms(t[i], decisions.largest);
        sums[0] += at.area * f[0];
        sums[1] += at.area * f[1];
      }
    if (is_first(view))
      sums[2] = view.dies[die_].temperature;
    return sums;
  }

  template <typename Number>
  Number DieTemperature::combine(const std::vector<Number> &b, const Decisions &decisions) const
  {
    return value_of(b[0]) > 0. ? mean_.combine(b[0], b[1], decisions.largest) : b[2];
  }

  void DieTemperature::reverse_integrals(const FinalView<double>   &view,
                                         const Decisions           &decisions,
                                         const std::vector<double> &weights,
                                         FinalBar                  &bar) const
  {
    const auto          surface = under_press(view);
    const auto          t       = dies_surfaces(surface, view.dies, *view.skin);
    std::vector<double> t_bar(t.size(), 0.);
    ThermalSurfaceBar   surface_bar(surface);
    for (unsigned int i = 0; i < t.size(); ++i)
      if (const auto &at = surface.touching[i]; counts(view, at, die_))
      {
        const auto f = mean_.terms(t[i], decisions.largest), s = mean_.slopes(t[i], decisions.largest);
        surface_bar.touching_area[i] = weights[0] * f[0] + weights[1] * f[1];
        t_bar[i]                     = at.area * (weights[0] * s[0] + weights[1] * s[1]);
      }
    reverse_dies_surfaces(surface, view.dies, *view.skin, t_bar, surface_bar, bar.dies, bar.skin);
    const auto contact = view.scene.view(view.dies, view.X);
    reverse_thermal_surface(contact, surface, view.heat->gap, surface_bar, bar.X, bar.dies);
    if (is_first(view))
      bar.dies[die_].temperature += weights[2];
  }

#define RETROFORGE_INSTANTIATE(Number)                                                      \
  template std::vector<Number> DieTemperature::compute_integrals(const FinalView<Number> &, \
                                                                 const Decisions &) const;  \
  template Number              DieTemperature::combine(const std::vector<Number> &, const Decisions &) const;
  RETROFORGE_INSTANTIATE(double)
  RETROFORGE_INSTANTIATE(Dual)
#undef RETROFORGE_INSTANTIATE

  namespace
  {
    struct DieTemperatureType : ObjectiveType
    {
      DieSetting die;
      double     smoothing = 1.;

      void add_parameters(dealii::ParameterHandler &prm) override
      {
        die.add_parameters(prm);
        add_temperature_smoothing(prm, smoothing);
      }

      void check_names(const std::string &where, const ObjectiveContext &context) const override
      {
        die.find(where, context);
      }

      void make(const std::string      &where,
                const ObjectiveContext &context,
                NamedObjective         &objective) const override
      {
        if (!context.conducts)
          throw Error(where,
                      "is the temperature of a die's surface",
                      "it follows from the heat that flows there, and Heat/heating is not conduction",
                      "set Heat/heating = conduction, or leave the objective out");
        objective.at_end = std::make_unique<DieTemperature>(die.find(where, context), smoothing);
        objective.least  = absolute_zero;
      }
    };
  } // namespace

  Choice<ObjectiveType>::Maker die_temperature_type()
  {
    return {"die temperature", Choice<ObjectiveType>::make<DieTemperatureType>};
  }
} // namespace retroforge
