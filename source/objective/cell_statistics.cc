// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/enum_setting.h>
#include <retroforge/core/error.h>
#include <retroforge/objective/cell_statistics.h>
#include <retroforge/objective/objective_settings.h>
#include <retroforge/objective/volume.h>

#include <algorithm>

namespace retroforge
{
  CellStatistics::CellStatistics(const CellQuantity   quantity,
                                 const CellStatistic  statistic,
                                 const SmoothMaximum &smooth)
      : quantity_(quantity), statistic_(statistic), smooth_(smooth)
  {
    if (statistic == CellStatistic::largest)
      smooth.check(quantity == CellQuantity::strain ? "Maximum strain" : "Damage");
  }

  std::string CellStatistics::name() const
  {
    if (quantity_ == CellQuantity::damage)
      return "damage";
    switch (statistic_)
    {
      case CellStatistic::mean:
        return "mean strain";
      case CellStatistic::variance:
        return "strain variance";
      default:
        return "maximum strain";
    }
  }

  std::map<std::string, double> CellStatistics::details(const std::vector<double> &,
                                                        const FinalDecisions &decisions) const
  {
    if (statistic_ != CellStatistic::largest)
      return {};
    return {{"true maximum", std::any_cast<Decisions>(decisions).reference}};
  }

  CellStatistics::Decisions CellStatistics::compute_decisions(const FinalView<double> &view) const
  {
    const std::vector<double> &x = values(view);
    if (statistic_ == CellStatistic::largest)
      return {x.empty() ? 0. : *std::max_element(x.begin(), x.end())};
    const Discretization<3> &discretization = view.scene.discretization;
    double                   sum = 0., volume = 0.;
    for (const CellIndex c : discretization.cells().owned())
    {
      sum += cell_volume(view, c) * x[c];
      volume += cell_volume(view, c);
    }
    return {discretization.sum(sum) / discretization.sum(volume)};
  }

  template <typename Number>
  std::array<Number, 2> CellStatistics::integrands(const Number &x, const double reference) const
  {
    if (statistic_ == CellStatistic::largest)
      return {{smooth_.term(x, Number(1.), reference), Number(0.)}};
    const Number beside = x - reference;
    return {{beside, Number(beside * beside)}};
  }

  std::array<double, 2> CellStatistics::slopes(const double x, const double reference) const
  {
    if (statistic_ == CellStatistic::largest)
      return {{smooth_.slope(x, reference), 0.}};
    return {{1., 2. * (x - reference)}};
  }

  template <typename Number>
  std::vector<Number> CellStatistics::compute_integrals(const FinalView<Number> &view,
                                                        const Decisions         &decisions) const
  {
    const std::vector<Number> &x = values(view);
    AssertDimension(x.size(), view.scene.mesh.n_cells());
    std::vector<Number> sums(3, Number(0.));
    for (const CellIndex c : view.scene.discretization.cells().owned())
    {
      const Number volume = cell_volume(view, c);
      const auto   f      = integrands(x[c], decisions.reference);
      sums[0] += volume;
      sums[1] += volume * f[0];
      sums[2] += volume * f[1];
    }
    return sums;
  }

  template <typename Number>
  Number CellStatistics::combine(const std::vector<Number> &b, const Decisions &decisions) const
  {
    if (statistic_ == CellStatistic::largest)
      return smooth_.combine(b[1], b[0], decisions.reference);
    const Number mean = b[1] / b[0];
    return statistic_ == CellStatistic::mean ? Number(decisions.reference + mean)
                                             : Number(b[2] / b[0] - mean * mean);
  }

  void CellStatistics::reverse_integrals(const FinalView<double>   &view,
                                         const Decisions           &decisions,
                                         const std::vector<double> &weights,
                                         FinalBar                  &bar) const
  {
    const std::vector<double> &x     = values(view);
    std::vector<double>       &x_bar = quantity_ == CellQuantity::strain ? bar.q : bar.damage;
    for (const CellIndex c : view.scene.discretization.cells().owned())
    {
      const auto f = integrands(x[c], decisions.reference), slope = slopes(x[c], decisions.reference);
      reverse_cell_volume(view, c, weights[0] + weights[1] * f[0] + weights[2] * f[1], bar.X);
      x_bar[c] += cell_volume(view, c) * (weights[1] * slope[0] + weights[2] * slope[1]);
    }
  }

#define RETROFORGE_INSTANTIATE(Number)                                                      \
  template std::vector<Number> CellStatistics::compute_integrals(const FinalView<Number> &, \
                                                                 const Decisions &) const;  \
  template Number              CellStatistics::combine(const std::vector<Number> &, const Decisions &) const;
  RETROFORGE_INSTANTIATE(double)
  RETROFORGE_INSTANTIATE(Dual)
#undef RETROFORGE_INSTANTIATE

  namespace
  {
    template <CellStatistic statistic>
    struct StrainType : ObjectiveType
    {
      void make(const std::string &, const ObjectiveContext &, NamedObjective &objective) const override
      {
        objective.at_end = std::make_unique<CellStatistics>(CellQuantity::strain, statistic);
      }
    };

    struct MaximumStrainType : ObjectiveType
    {
      MaximumSettings maximum;

      void add_parameters(dealii::ParameterHandler &prm) override { maximum.add_parameters(prm); }

      void make(const std::string &where, const ObjectiveContext &, NamedObjective &objective) const override
      {
        objective.at_end =
          std::make_unique<CellStatistics>(CellQuantity::strain, CellStatistic::largest, maximum.make(where));
      }
    };

    struct DamageType : ObjectiveType
    {
      CellStatistic   statistic = CellStatistic::largest;
      MaximumSettings maximum;

      void add_parameters(dealii::ParameterHandler &prm) override
      {
        add_enum<CellStatistic>(
          prm,
          "statistic",
          statistic,
          {{"largest", CellStatistic::largest}, {"mean", CellStatistic::mean}},
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
          statistic == CellStatistic::largest ? maximum.make(where) : SmoothMaximum();
        objective.at_end = std::make_unique<CellStatistics>(CellQuantity::damage, statistic, smooth);
      }
    };
  } // namespace

  Choice<ObjectiveType>::Maker mean_strain_type()
  {
    return {"mean strain", Choice<ObjectiveType>::make<StrainType<CellStatistic::mean>>};
  }

  Choice<ObjectiveType>::Maker strain_variance_type()
  {
    return {"strain variance", Choice<ObjectiveType>::make<StrainType<CellStatistic::variance>>};
  }

  Choice<ObjectiveType>::Maker maximum_strain_type()
  {
    return {"maximum strain", Choice<ObjectiveType>::make<MaximumStrainType>};
  }

  Choice<ObjectiveType>::Maker damage_type()
  {
    return {"damage", Choice<ObjectiveType>::make<DamageType>};
  }
} // namespace retroforge
