// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/enum_setting.h>
#include <retroforge/core/error.h>
#include <retroforge/objective/damage_statistics.h>
#include <retroforge/objective/objective_settings.h>
#include <retroforge/objective/volume.h>

#include <algorithm>

namespace retroforge
{
  DamageObjective::DamageObjective(const DamageStatistic statistic, const SmoothMaximum &smooth)
      : statistic_(statistic), smooth_(smooth)
  {
    if (statistic == DamageStatistic::largest)
      smooth.check("Damage");
  }

  DamageObjective::Decisions DamageObjective::compute_decisions(const FinalView<double> &view) const
  {
    Assert(view.damage != nullptr, dealii::ExcMessage("the damage is not followed"));
    return {view.damage->empty() ? 0. : *std::max_element(view.damage->begin(), view.damage->end())};
  }

  std::map<std::string, double> DamageObjective::details(const std::vector<double> &,
                                                         const FinalDecisions &decisions) const
  {
    return {{"true maximum", std::any_cast<Decisions>(decisions).largest}};
  }

  template <typename Number>
  std::vector<Number> DamageObjective::compute_integrals(const FinalView<Number> &view,
                                                         const Decisions         &decisions) const
  {
    AssertDimension(view.damage->size(), view.scene.mesh.n_cells());
    std::vector<Number> sums(2, Number(0.));
    for (const CellIndex c : view.scene.discretization.cells().owned())
    {
      const Number volume = cell_volume(view, c);
      sums[0] += volume;
      sums[1] += volume * integrand((*view.damage)[c], decisions);
    }
    return sums;
  }

  template <typename Number>
  Number DamageObjective::combine(const std::vector<Number> &b, const Decisions &decisions) const
  {
    if (statistic_ == DamageStatistic::mean)
      return b[1] / b[0];
    if (value_of(b[1]) == 0.) // nothing was pulled: there is no slope of a root
      return Number(0.);
    return smooth_.combine(b[1], b[0], decisions.largest);
  }

  void DamageObjective::reverse_integrals(const FinalView<double>   &view,
                                          const Decisions           &decisions,
                                          const std::vector<double> &weights,
                                          FinalBar                  &bar) const
  {
    for (const CellIndex c : view.scene.discretization.cells().owned())
    {
      const double damage = (*view.damage)[c];
      const double slope =
        statistic_ == DamageStatistic::mean ? 1. : smooth_.slope(damage, decisions.largest);
      reverse_cell_volume(view, c, weights[0] + weights[1] * integrand(damage, decisions), bar.X);
      bar.damage[c] += weights[1] * cell_volume(view, c) * slope;
    }
  }

#define RETROFORGE_INSTANTIATE(Number)                                                       \
  template std::vector<Number> DamageObjective::compute_integrals(const FinalView<Number> &, \
                                                                  const Decisions &) const;  \
  template Number              DamageObjective::combine(const std::vector<Number> &, const Decisions &) const;
  RETROFORGE_INSTANTIATE(double)
  RETROFORGE_INSTANTIATE(Dual)
#undef RETROFORGE_INSTANTIATE

  namespace
  {
    struct DamageType : ObjectiveType
    {
      DamageStatistic statistic = DamageStatistic::largest;
      MaximumSettings maximum;

      void add_parameters(dealii::ParameterHandler &prm) override
      {
        add_enum<DamageStatistic>(
          prm,
          "statistic",
          statistic,
          {{"largest", DamageStatistic::largest}, {"mean", DamageStatistic::mean}},
          "Of the damage: its smooth maximum, or its mean over the volume. Units: none.");
        maximum.add_parameters(prm);
      }

      void make(const std::string      &where,
                const ObjectiveContext &context,
                NamedObjective         &objective) const override
      {
        if (!context.is_damaged)
          throw Error(where,
                      "follows the damage of the metal",
                      "Material/damage is none",
                      "set Material/damage = Latham-Cockcroft, or leave the objective out");
        const SmoothMaximum smooth =
          statistic == DamageStatistic::largest ? maximum.make(where) : SmoothMaximum();
        objective.at_end = std::make_unique<DamageObjective>(statistic, smooth);
      }
    };
  } // namespace

  Choice<ObjectiveType>::Maker damage_type()
  {
    return {"damage", Choice<ObjectiveType>::make<DamageType>};
  }
} // namespace retroforge
