// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/heat/healing.h>
#include <retroforge/heat/skin.h>

#include <cmath>
#include <optional>

namespace retroforge
{
  namespace
  {
    /// What a skin heals by.
    template <typename Number>
    struct HealingArguments
    {
      Number e, h, k, capacity, die_effusivity, time;

      template <typename Self>
      static auto members(Self &self)
      {
        auto &[e, h, k, capacity, die_effusivity, time] = self;
        return std::tie(e, h, k, capacity, die_effusivity, time);
      }
    };

    double square_of_effusivity(const HealingArguments<double> &of)
    {
      return std::pow(joint_effusivity(std::sqrt(of.k * of.capacity), of.die_effusivity), 2);
    }

    double healed(const HealingArguments<double> &of)
    {
      return healed_skin(of.e, of.h, square_of_effusivity(of), of.time).e;
    }

    /// Returns e_bar times the derivatives of the skin after the time.
    HealingArguments<double> reverse_healed(const HealingArguments<double> &of, const double e_bar)
    {
      const double b2 = square_of_effusivity(of), b = std::sqrt(b2), metal = std::sqrt(of.k * of.capacity);
      const HealedSkin after    = healed_skin(of.e, of.h, b2, of.time);
      const double     b_bar    = e_bar * after.e_b2 * 2. * b; // 1/b = 1/metal + 1/die
      const double     of_metal = b_bar * std::pow(b / metal, 2) * 0.5 * metal;
      return {e_bar * after.e_e,
              e_bar * after.e_h,
              of_metal / of.k,
              of_metal / of.capacity,
              b_bar * std::pow(b / of.die_effusivity, 2),
              e_bar * after.e_time};
    }

    Dual healed(const HealingArguments<Dual> &of)
    {
      HealingArguments<double> at;
      for_each_number([](const Dual &from, double &to) { to = from.val(); }, of, at);
      const HealingArguments<double> slopes = reverse_healed(at, 1.);
      Dual                           e(healed(at));
      for_each_number(
        [&](const double slope, const Dual &x) { e.fastAccessDx(0) += slope * x.dx(0); }, slopes, of);
      return e;
    }

    /// How far dies touch each node.
    template <typename Number>
    std::vector<Number> weights(const ThermalSurface<Number> &surface)
    {
      std::vector<Number> sums(surface.free.size(), Number(0.));
      for (const auto &at : surface.touching)
        sums[at.node] += at.weight;
      return sums;
    }

    /// Of a node; none where its skin stays as it is.
    template <typename Number>
    std::optional<HealingArguments<Number>>
    arguments_at(const HeatLaw<Number> &law, const Number &weight, const Number &time, const Number &e)
    {
      const Number open = 1. - weight;
      if (!(value_of(open) > 0. && value_of(e) > 0. && value_of(law.contact_film) > 0.))
        return {};
      return HealingArguments<Number>{
        e, law.contact_film, law.conductivity, law.capacity, law.die_effusivity, Number(open * time)};
    }
  } // namespace

  template <typename Number>
  void heal_skins(const ThermalSurface<Number> &surface,
                  const HeatLaw<Number>        &law,
                  const Number                 &time,
                  std::vector<Number>          &skin)
  {
    AssertDimension(skin.size(), surface.free.size());
    const std::vector<Number> weight = weights(surface);
    for (NodeIndex k = 0; k < skin.size(); ++k)
      if (const auto of = arguments_at(law, weight[k], time, skin[k]))
        skin[k] = healed(*of);
  }

  template void
  heal_skins(const ThermalSurface<double> &, const HeatLaw<double> &, const double &, std::vector<double> &);
  template void
  heal_skins(const ThermalSurface<Dual> &, const HeatLaw<Dual> &, const Dual &, std::vector<Dual> &);

  void reverse_heal_skins(const ThermalSurface<double> &surface,
                          const HeatLaw<double>        &law,
                          const double                  time,
                          const std::vector<double>    &skin,
                          std::vector<double>          &skin_bar,
                          const HealingBar             &bar)
  {
    AssertDimension(skin.size(), surface.free.size());
    const std::vector<double> weight = weights(surface);
    std::vector<double>       weight_bar(weight.size(), 0.);
    for (NodeIndex k = 0; k < skin.size(); ++k)
      if (const auto of = arguments_at(law, weight[k], time, skin[k]))
      {
        const HealingArguments<double> of_bar = reverse_healed(*of, skin_bar[k]);
        skin_bar[k]                           = of_bar.e;
        bar.law.contact_film += of_bar.h;
        bar.law.conductivity += of_bar.k;
        bar.law.capacity += of_bar.capacity;
        bar.law.die_effusivity += of_bar.die_effusivity;
        bar.time += of_bar.time * (1. - weight[k]);
        weight_bar[k] = -of_bar.time * time;
      }
    for (std::size_t i = 0; i < surface.touching.size(); ++i)
      bar.surface.weight[i] += weight_bar[surface.touching[i].node];
  }
} // namespace retroforge
