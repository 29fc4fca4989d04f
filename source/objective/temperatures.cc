// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/material/temperature_range.h>
#include <retroforge/objective/objective_settings.h>
#include <retroforge/objective/temperatures.h>
#include <retroforge/objective/volume.h>

#include <algorithm>

namespace retroforge
{
  std::string TemperatureObjective::name() const
  {
    switch (extreme_)
    {
      case TemperatureExtreme::largest:
        return "largest temperature";
      case TemperatureExtreme::least:
        return "least temperature";
      default:
        return "temperature spread";
    }
  }

  TemperatureObjective::Decisions TemperatureObjective::compute_decisions(const FinalView<double> &view) const
  {
    Assert(view.T != nullptr, dealii::ExcMessage("temperatures are not followed"));
    const auto [least, largest] = std::minmax_element(view.T->begin(), view.T->end());
    return {*largest, *least};
  }

  std::map<std::string, double> TemperatureObjective::details(const std::vector<double> &,
                                                              const FinalDecisions &decisions) const
  {
    const auto [largest, least] = std::any_cast<Decisions>(decisions);
    switch (extreme_)
    {
      case TemperatureExtreme::largest:
        return {{"true maximum", largest}};
      case TemperatureExtreme::least:
        return {{"true minimum", least}};
      default:
        return {{"true spread", largest - least}};
    }
  }

  template <typename Number>
  std::vector<Number> TemperatureObjective::compute_integrals(const FinalView<Number> &view,
                                                              const Decisions         &decisions) const
  {
    AssertDimension(view.T->size(), view.scene.mesh.n_nodes());
    std::vector<Number> sums(4, Number(0.));
    for (const CellIndex c : view.scene.discretization.cells().owned())
    {
      const Number volume = cell_volume(view, c);
      for (const NodeIndex k : view.scene.mesh.cells[c])
      {
        const auto f = terms((*view.T)[k], decisions);
        for (unsigned int i = 0; i < sums.size(); ++i)
          sums[i] += volume * f[i];
      }
    }
    return sums;
  }

  template <typename Number>
  Number TemperatureObjective::combine(const std::vector<Number> &b, const Decisions &decisions) const
  {
    const Number largest = hottest_.combine(b[0], b[1], decisions.largest),
                 least   = coldest_.combine(b[2], b[3], decisions.least);
    switch (extreme_)
    {
      case TemperatureExtreme::largest:
        return largest;
      case TemperatureExtreme::least:
        return least;
      default:
        return Number(largest - least);
    }
  }

  void TemperatureObjective::reverse_integrals(const FinalView<double>   &view,
                                               const Decisions           &decisions,
                                               const std::vector<double> &weights,
                                               FinalBar                  &bar) const
  {
    for (const CellIndex c : view.scene.discretization.cells().owned())
    {
      const double volume     = cell_volume(view, c);
      double       volume_bar = 0.;
      for (const NodeIndex k : view.scene.mesh.cells[c])
      {
        const double T = (*view.T)[k];
        const auto   f = terms(T, decisions);
        for (unsigned int i = 0; i < weights.size(); ++i)
          volume_bar += weights[i] * f[i];
        const auto hot = hottest_.slopes(T, decisions.largest), cold = coldest_.slopes(T, decisions.least);
        for (unsigned int i = 0; i < 2; ++i)
          bar.T[k] += volume * (weights[i] * hot[i] + weights[2 + i] * cold[i]);
      }
      reverse_cell_volume(view, c, volume_bar, bar.X);
    }
  }

#define RETROFORGE_INSTANTIATE(Number)                                                            \
  template std::vector<Number> TemperatureObjective::compute_integrals(const FinalView<Number> &, \
                                                                       const Decisions &) const;  \
  template Number TemperatureObjective::combine(const std::vector<Number> &, const Decisions &) const;
  RETROFORGE_INSTANTIATE(double)
  RETROFORGE_INSTANTIATE(Dual)
#undef RETROFORGE_INSTANTIATE

  namespace
  {
    template <TemperatureExtreme extreme>
    struct TemperatureType : ObjectiveType
    {
      double smoothing = 1.;

      void add_parameters(dealii::ParameterHandler &prm) override
      {
        add_temperature_smoothing(prm, smoothing);
      }

      void make(const std::string      &where,
                const ObjectiveContext &context,
                NamedObjective         &objective) const override
      {
        if (!context.warms)
          throw Error(where,
                      "follows the temperatures of the workpiece",
                      "Heat/heating is none, and the metal keeps that before the stroke",
                      "set Heat/heating = adiabatic or conduction, or leave the objective out");
        objective.at_end = std::make_unique<TemperatureObjective>(extreme, smoothing);
        if (extreme != TemperatureExtreme::spread)
          objective.least = absolute_zero;
      }
    };
  } // namespace

  Choice<ObjectiveType>::Maker largest_temperature_type()
  {
    return {"largest temperature", Choice<ObjectiveType>::make<TemperatureType<TemperatureExtreme::largest>>};
  }

  Choice<ObjectiveType>::Maker least_temperature_type()
  {
    return {"least temperature", Choice<ObjectiveType>::make<TemperatureType<TemperatureExtreme::least>>};
  }

  Choice<ObjectiveType>::Maker temperature_spread_type()
  {
    return {"temperature spread", Choice<ObjectiveType>::make<TemperatureType<TemperatureExtreme::spread>>};
  }
} // namespace retroforge
