// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
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
  std::array<Number, 4> TemperatureObjective::terms(const Number &T, const Decisions &decisions) const
  {
    using std::exp;
    const Number from_hot = T - decisions.largest, from_cold = T - decisions.least;
    const Number hot = exp(Number(from_hot / smoothing_)), cold = exp(Number(-from_cold / smoothing_));
    return {{hot, Number(hot * from_hot), cold, Number(cold * from_cold)}};
  }

  std::array<double, 4> TemperatureObjective::slopes(const double T, const Decisions &decisions) const
  {
    const auto f = terms(T, decisions);
    return {{f[0] / smoothing_, f[0] + f[1] / smoothing_, -f[2] / smoothing_, f[2] - f[3] / smoothing_}};
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
    const Number largest = decisions.largest + b[1] / b[0], least = decisions.least + b[3] / b[2];
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
        const auto   f = terms(T, decisions), slope = slopes(T, decisions);
        for (unsigned int i = 0; i < weights.size(); ++i)
        {
          volume_bar += weights[i] * f[i];
          bar.T[k] += weights[i] * volume * slope[i];
        }
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
        prm.add_parameter(
          "temperature smoothing",
          smoothing,
          "Difference of temperatures over which an extreme is smoothed: it is missed by about 1.5 "
          "times as much. Units: K.",
          dealii::Patterns::Double(1e-300));
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
