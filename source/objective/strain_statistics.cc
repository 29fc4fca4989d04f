// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/objective/objective_settings.h>
#include <retroforge/objective/strain_statistics.h>
#include <retroforge/objective/volume.h>

#include <algorithm>

namespace retroforge
{
  StrainObjective::StrainObjective(const StrainStatistic statistic, const SmoothMaximum &smooth)
      : statistic_(statistic), smooth_(smooth)
  {
    if (statistic == StrainStatistic::maximum)
      smooth.check("Maximum strain");
  }

  std::string StrainObjective::name() const
  {
    switch (statistic_)
    {
      case StrainStatistic::mean:
        return "mean strain";
      case StrainStatistic::variance:
        return "strain variance";
      default:
        return "maximum strain";
    }
  }

  std::map<std::string, double> StrainObjective::details(const std::vector<double> &,
                                                         const FinalDecisions &decisions) const
  {
    if (statistic_ != StrainStatistic::maximum)
      return {};
    return {{"true maximum", std::any_cast<Decisions>(decisions).reference}};
  }

  StrainObjective::Decisions StrainObjective::compute_decisions(const FinalView<double> &view) const
  {
    if (statistic_ == StrainStatistic::maximum)
      return {view.q.empty() ? 0. : *std::max_element(view.q.begin(), view.q.end())};
    const Discretization<3> &discretization = view.scene.discretization;
    double                   strain = 0., volume = 0.;
    for (const CellIndex c : discretization.cells().owned())
    {
      strain += cell_volume(view, c) * view.q[c];
      volume += cell_volume(view, c);
    }
    return {discretization.sum(strain) / discretization.sum(volume)};
  }

  template <typename Number>
  std::array<Number, 2> StrainObjective::integrands(const Number &q, const double reference) const
  {
    if (statistic_ == StrainStatistic::maximum)
      return {{smooth_.term(q, Number(1.), reference), Number(0.)}};
    const Number x = q - reference;
    return {{x, Number(x * x)}};
  }

  std::array<double, 2> StrainObjective::slopes(const double q, const double reference) const
  {
    if (statistic_ == StrainStatistic::maximum)
      return {{smooth_.slope(q, reference), 0.}};
    return {{1., 2. * (q - reference)}};
  }

  template <typename Number>
  std::vector<Number> StrainObjective::compute_integrals(const FinalView<Number> &view,
                                                         const Decisions         &decisions) const
  {
    const Discretization<3> &discretization = view.scene.discretization;
    std::vector<Number>      sums(3, Number(0.));
    for (const CellIndex c : discretization.cells().owned())
    {
      const Number volume = cell_volume(view, c);
      const auto   f      = integrands(view.q[c], decisions.reference);
      sums[0] += volume;
      sums[1] += volume * f[0];
      sums[2] += volume * f[1];
    }
    return sums;
  }

  template <typename Number>
  Number StrainObjective::combine(const std::vector<Number> &b, const Decisions &decisions) const
  {
    if (statistic_ == StrainStatistic::maximum)
      return smooth_.combine(b[1], b[0], decisions.reference);
    const Number mean = b[1] / b[0];
    return statistic_ == StrainStatistic::mean ? Number(decisions.reference + mean)
                                               : Number(b[2] / b[0] - mean * mean);
  }

  void StrainObjective::reverse_integrals(const FinalView<double>   &view,
                                          const Decisions           &decisions,
                                          const std::vector<double> &weights,
                                          FinalBar                  &bar) const
  {
    const Discretization<3> &discretization = view.scene.discretization;
    for (const CellIndex c : discretization.cells().owned())
    {
      const auto f     = integrands(view.q[c], decisions.reference),
                 slope = slopes(view.q[c], decisions.reference);
      reverse_cell_volume(view, c, weights[0] + weights[1] * f[0] + weights[2] * f[1], bar.X);
      bar.q[c] += cell_volume(view, c) * (weights[1] * slope[0] + weights[2] * slope[1]);
    }
  }

#define RETROFORGE_INSTANTIATE(Number)                                                       \
  template std::vector<Number> StrainObjective::compute_integrals(const FinalView<Number> &, \
                                                                  const Decisions &) const;  \
  template Number              StrainObjective::combine(const std::vector<Number> &, const Decisions &) const;
  RETROFORGE_INSTANTIATE(double)
  RETROFORGE_INSTANTIATE(Dual)
#undef RETROFORGE_INSTANTIATE

  namespace
  {
    template <StrainStatistic statistic>
    struct StrainType : ObjectiveType
    {
      void make(const std::string &, const ObjectiveContext &, NamedObjective &objective) const override
      {
        objective.at_end = std::make_unique<StrainObjective>(statistic);
      }
    };

    struct MaximumStrainType : ObjectiveType
    {
      MaximumSettings maximum;

      void add_parameters(dealii::ParameterHandler &prm) override { maximum.add_parameters(prm); }

      void make(const std::string &where, const ObjectiveContext &, NamedObjective &objective) const override
      {
        objective.at_end = std::make_unique<StrainObjective>(StrainStatistic::maximum, maximum.make(where));
      }
    };
  } // namespace

  Choice<ObjectiveType>::Maker mean_strain_type()
  {
    return {"mean strain", Choice<ObjectiveType>::make<StrainType<StrainStatistic::mean>>};
  }

  Choice<ObjectiveType>::Maker strain_variance_type()
  {
    return {"strain variance", Choice<ObjectiveType>::make<StrainType<StrainStatistic::variance>>};
  }

  Choice<ObjectiveType>::Maker maximum_strain_type()
  {
    return {"maximum strain", Choice<ObjectiveType>::make<MaximumStrainType>};
  }
} // namespace retroforge
