// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/heat/surface_temperature.h>
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
    std::vector<Number> die_surface(const FinalView<Number> &view, const HeatUnderPress<Number> &heat)
    {
      Assert(view.T != nullptr && view.skin != nullptr && view.heat != nullptr,
             dealii::ExcMessage("heat does not flow"));
      return surface_temperatures(heat.flow, *view.T, *view.skin)[1];
    }

    template <typename Number>
    HeatUnderPress<Number> under_press(const FinalView<Number> &view)
    {
      return {view.scene.view(view.dies, view.X), *view.heat};
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
    const auto   heat    = under_press(view);
    const auto   t       = die_surface(view, heat);
    const double itself  = view.dies[die_].temperature;
    double       largest = -std::numeric_limits<double>::infinity();
    for (const auto &at : heat.surface.touching)
      if (counts(view, at, die_))
        largest = std::max(largest, t[at.node]);
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
    const auto          heat = under_press(view);
    const auto          t    = die_surface(view, heat);
    std::vector<Number> sums(3, Number(0.));
    for (const auto &at : heat.surface.touching)
      if (counts(view, at, die_))
      {
        const auto f = mean_.terms(t[at.node], decisions.largest);
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
    const auto                         heat = under_press(view);
    const auto                         t    = die_surface(view, heat);
    std::array<std::vector<double>, 2> surfaces_bar;
    for (auto &of_surface : surfaces_bar)
      of_surface.assign(t.size(), 0.);
    ConductionNetwork<double> network_bar = no_derivatives(heat.network);
    ThermalSurfaceBar         surface_bar(heat.surface);
    for (unsigned int i = 0; i < heat.surface.touching.size(); ++i)
      if (const auto &at = heat.surface.touching[i]; counts(view, at, die_))
      {
        const auto f                 = mean_.terms(t[at.node], decisions.largest),
                   s                 = mean_.slopes(t[at.node], decisions.largest);
        surface_bar.touching_area[i] = weights[0] * f[0] + weights[1] * f[1];
        surfaces_bar[1][at.node]     = at.area * (weights[0] * s[0] + weights[1] * s[1]);
      }
    double      no_time = 0.;
    HeatFlowBar flow_bar{network_bar, surface_bar, bar.heat, bar.heat.contact_film, bar.dies, no_time};
    reverse_surface_temperatures(heat.flow, *view.T, *view.skin, surfaces_bar, bar.T, bar.skin, flow_bar);
    const auto contact = view.scene.view(view.dies, view.X);
    reverse_thermal_surface(contact, heat.surface, view.heat->gap, surface_bar, bar.X, bar.dies);
    reverse_conduction_network(view.scene.mesh, heat.edges, view.X, network_bar, bar.X);
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
      }
    };
  } // namespace

  Choice<ObjectiveType>::Maker die_temperature_type()
  {
    return {"die temperature", Choice<ObjectiveType>::make<DieTemperatureType>};
  }
} // namespace retroforge
