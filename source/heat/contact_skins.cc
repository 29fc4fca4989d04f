// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/heat/bounded_films.h>
#include <retroforge/heat/contact_skins.h>

namespace retroforge
{
  namespace
  {
    template <typename Number>
    Skin<Number> by_modes(Skin<Number> a, const Skin<Number> &b)
    {
      return healed(std::move(a), b);
    }

    /// mu M + p (P - mu D), of the metal's drop what does not follow from the node's temperature.
    template <typename Number>
    Skin<Number> metals_own(const NodeFilm<Number> &film, const Skin<Number> &metal, const Number &part)
    {
      return by_modes(metal, film.left.mean) +
             part * (film.parts.carried.mean - by_modes(film.both, film.left.mean));
    }

    template <typename Number>
    Number unbounded_drops(const NodeFilm<Number> &film, const Number &part)
    {
      return (1. - part * (film.shown * film.parts.source.mean)) / (1. - drop_of(film.parts.source.mean));
    }

    template <typename Number>
    Number unbounded_shift(const NodeFilm<Number> &film, const Skin<Number> &metal, const Number &part)
    {
      return film.drops * drop_of(film.parts.carried.mean) - film.shown * metals_own(film, metal, part);
    }

    template <typename Number>
    NodeFilm<Number> node_film(const HeatFlow<Number>      &flow,
                               const NodeContact<Number>   &contact,
                               const SkinsOverStep<Number> &over,
                               const Number                &dt,
                               const Number                &T,
                               const NodeSkins<Number>     &skin)
    {
      NodeFilm<Number>   film;
      const Number       time  = contact.weight * dt;
      const auto        &metal = skin.metal[contact.node];
      const Skin<Number> dies  = contact.dies_skin(flow, skin);
      film.both                = metal + dies;
      film.parts               = over.touching(value_of(time), [&](const SkinPropagator &beneath) {
        return skin_parts(beneath, over.rate(), film.both, time);
      });
      film.left                = over.healing(time);
      film.shown               = parts_shown(flow.law, contact.depth(flow));
      film.drops               = bounded_drops(unbounded_drops(film, over.part()));
      film.behind              = contact.die_temperature(flow);
      film.shift =
        kept_between(unbounded_shift(film, metal, over.part()), Number(T - film.behind), drop_of(dies));
      if (flow.friction != nullptr && value_of((*flow.friction)[contact.node]) != 0.)
      {
        film.friction =
          friction_in_skins(flow.law, flow.contact_film, (*flow.friction)[contact.node], time, film.left);
        film.shift += film.friction->shift(film.drops, film.shown, film.parts.source.mean, over.part());
      }
      return film;
    }

    /// DeltaT, by the temperature with which a film took its heat, and friction's sigma.
    template <typename Number>
    Number difference_of(const NodeFilm<Number> &film, const Number &T)
    {
      Number across = (T - film.behind - film.shift) / film.drops;
      if (film.friction)
        across += film.friction->difference;
      return (across + drop_of(film.parts.carried.mean)) / (1. - drop_of(film.parts.source.mean));
    }

    /// What the flux adds to the skins of metal and die together.
    template <typename Number>
    Skin<Number> grown(const NodeFilm<Number> &film, const Number &difference)
    {
      return film.parts.carried.after + difference * film.parts.source.after -
             by_modes(film.both, film.left.after);
    }

    /// For each entry of a contact the part of the time of the touch in which it does.
    template <typename Number>
    Number
    part_of_time(const HeatFlow<Number> &flow, const NodeContact<Number> &contact, const unsigned int entry)
    {
      return flow.surface.touching[entry].weight / contact.weight;
    }
  } // namespace

  template <typename Number>
  SkinsOverStep<Number>::SkinsOverStep(const HeatFlow<Number> &flow, const Number &dt)
      : rate_(flow.contact_film / joint_effusivity(metals_effusivity(flow.law), flow.law.die_effusivity))
      , part_(metals_part(flow.law))
      , dt_(value_of(dt))
      , healing_(retroforge::healing(dt))
  {
    if (value_of(rate_) > 0.)
      whole_.emplace(film_.emplace(value_of(rate_)), dt_);
  }

  template <typename Number>
  ContactSkins<Number>::ContactSkins(const HeatFlow<Number>    &flow,
                                     const Number              &dt,
                                     const std::vector<Number> &T,
                                     NodeSkins<Number>         &skin)
      : flow_(flow), over_(flow, dt), contacts_(node_contacts(flow))
  {
    std::vector<Number> open(T.size(), dt);
    for (const auto &contact : contacts_)
      open[contact.node] -= contact.weight * dt;
    for (NodeIndex k = 0; k < T.size(); ++k)
      if (value_of(open[k]) > 0.)
      {
        const Skin<Number> left = over_.healing(open[k]).after;
        skin.metal[k]           = by_modes(skin.metal[k], left);
        for (auto &die : skin.dies)
          die[k] = by_modes(die[k], left);
      }
    for (const auto &contact : contacts_)
      if (contact.has_film)
        films_.push_back(node_film(flow, contact, over_, dt, T[contact.node], skin));
  }

  template <typename Number>
  NodeFilms<Number> ContactSkins<Number>::films() const
  {
    NodeFilms<Number> films(flow_.network.volumes.size());
    auto              film = films_.begin();
    for (const auto &contact : contacts_)
      if (contact.has_film)
      {
        films.conductance[contact.node] = contact.area * flow_.contact_film / film->drops;
        films.source[contact.node]      = films.conductance[contact.node] * (film->behind + film->shift);
        ++film;
      }
    return films;
  }

  template <typename Number>
  void ContactSkins<Number>::advance(const std::vector<Number> &T, NodeSkins<Number> &skin) const
  {
    auto film = films_.begin();
    for (const auto &contact : contacts_)
      if (contact.has_film)
      {
        const NodeIndex    k     = contact.node;
        const Skin<Number> comes = grown(*film, difference_of(*film, T[k]));
        Skin<Number>       rise; // by friction, of either side
        if (film->friction)
          rise = film->friction->rise * film->friction->unit.after;
        skin.metal[k] = by_modes(skin.metal[k], film->left.after) + over_.part() * comes - rise;
        for (auto &die : skin.dies)
          die[k] = by_modes(die[k], film->left.after);
        for (const unsigned int i : contact.entries)
          skin.dies[flow_.surface.touching[i].die][k] +=
            part_of_time(flow_, contact, i) * (Number(1. - over_.part()) * comes + rise);
        ++film;
      }
  }

  template class SkinsOverStep<double>;
  template class SkinsOverStep<Dual>;
  template class ContactSkins<double>;
  template class ContactSkins<Dual>;

  ReverseContactSkins::ReverseContactSkins(const HeatFlow<double>    &flow,
                                           const double               dt,
                                           const std::vector<double> &T,
                                           const NodeSkins<double>   &skin)
      : flow_(flow), dt_(dt), T_(T), before_(skin), skin_(skin), contact_(flow, dt, T, skin_)
  {
  }

  namespace
  {
    /// Derivatives in what the flux adds to both skins.
    Skin<double> reverse_grown(const HeatFlow<double>    &flow,
                               const NodeContact<double> &contact,
                               const double               part,
                               const NodeSkins<double>   &skin_bar)
    {
      Skin<double> bar = part * skin_bar.metal[contact.node];
      for (const unsigned int i : contact.entries)
        bar += part_of_time(flow, contact, i) * (1. - part) *
               skin_bar.dies[flow.surface.touching[i].die][contact.node];
      return bar;
    }

    /// Derivatives in what friction adds to the skins of either side.
    Skin<double> reverse_rise(const HeatFlow<double>    &flow,
                              const NodeContact<double> &contact,
                              const NodeSkins<double>   &skin_bar)
    {
      Skin<double> bar = -1. * skin_bar.metal[contact.node];
      for (const unsigned int i : contact.entries)
        bar += part_of_time(flow, contact, i) * skin_bar.dies[flow.surface.touching[i].die][contact.node];
      return bar;
    }

    /// Derivatives in the drop across a film, by which DeltaT follows from the node's temperature.
    double reverse_across(const NodeFilm<double> &film, const Skin<double> &grown_bar)
    {
      return grown_bar * film.parts.source.after / (1. - drop_of(film.parts.source.mean));
    }

    double along(const SkinStep<double> &a, const SkinStep<double> &b)
    {
      return a.after * b.after + a.mean * b.mean;
    }

    /// Derivatives in a node's film, and in what it is made of.
    struct NodeFilmBar
    {
      Skin<double>            both, metal, shown;
      SkinParts<double>       parts;
      SkinStep<double>        left;
      FrictionInSkins<double> friction = {};
      double                  drops = 0., behind = 0., shift = 0., warmth = 0., rate = 0., part = 0.;
    };

    /// Of skins after the step, which follow from DeltaT, and that from the temperature with which the film took its heat.
    /// @param skin_bar  of the dies' skins, those before the touch on exit
    NodeFilmBar reverse_advance(const HeatFlow<double>    &flow,
                                const NodeContact<double> &contact,
                                const NodeFilm<double>    &film,
                                const double               part,
                                const double               T,
                                const NodeSkins<double>   &skin,
                                NodeSkins<double>         &skin_bar,
                                NodeContactBar            &contact_bar)
    {
      const NodeIndex     k          = contact.node;
      const Skin<double> &metal_bar  = skin_bar.metal[k];
      const double        difference = difference_of(film, T);
      const Skin<double>  comes      = grown(film, difference),
                         comes_bar   = reverse_grown(flow, contact, part, skin_bar);
      NodeFilmBar bar;
      if (film.friction)
      {
        const Skin<double> rise_bar = reverse_rise(flow, contact, skin_bar);
        bar.friction.rise           = rise_bar * film.friction->unit.after;
        bar.friction.unit.after     = film.friction->rise * rise_bar;
      }
      bar.part       = metal_bar * comes;
      bar.left.after = by_modes(metal_bar, skin.metal[k]) - by_modes(comes_bar, film.both);
      bar.both       = -1. * by_modes(comes_bar, film.left.after);
      bar.metal      = by_modes(metal_bar, film.left.after);
      for (std::size_t e = 0; e < contact.entries.size(); ++e)
      {
        const unsigned int i           = contact.entries[e];
        const double       of_time     = part_of_time(flow, contact, i);
        const double       along_comes = skin_bar.dies[flow.surface.touching[i].die][k] * comes;
        bar.part -= of_time * along_comes;
        double of_time_bar = (1. - part) * along_comes;
        if (film.friction)
          of_time_bar += film.friction->rise *
                         (skin_bar.dies[flow.surface.touching[i].die][k] * film.friction->unit.after);
        contact_bar.entry_weight[e] += of_time_bar / contact.weight;
        contact_bar.weight -= of_time_bar * of_time / contact.weight;
      }
      for (std::size_t d = 0; d < skin_bar.dies.size(); ++d)
      {
        bar.left.after += by_modes(skin_bar.dies[d][k], skin.dies[d][k]);
        skin_bar.dies[d][k] = by_modes(skin_bar.dies[d][k], film.left.after);
      }
      bar.parts.carried.after = comes_bar;
      bar.parts.source.after  = difference * comes_bar;

      const double across     = (T - film.behind - film.shift) / film.drops;
      const double across_bar = reverse_across(film, comes_bar);
      bar.drops               = -across_bar * across / film.drops;
      bar.behind = bar.shift  = -across_bar / film.drops;
      bar.friction.difference = across_bar;
      add_to_modes(across_bar, bar.parts.carried.mean);
      add_to_modes(across_bar * difference, bar.parts.source.mean);
      return bar;
    }

    /// Of the temperature behind the film.
    /// @param difference  T - t
    /// @return derivative in it
    double reverse_shift(const NodeFilm<double> &film,
                         const Skin<double>     &metal,
                         const double            part,
                         const double            difference,
                         const double            warmth,
                         NodeFilmBar            &bar)
    {
      const Skin<double> &mean = film.left.mean, &carried = film.parts.carried.mean;
      const auto   slopes   = slopes_of_kept_between(unbounded_shift(film, metal, part), difference, warmth);
      const double free_bar = bar.shift * slopes.in_shift;
      const Skin<double> own_bar = -free_bar * film.shown;
      bar.warmth += bar.shift * slopes.in_warmth;
      bar.drops += free_bar * drop_of(carried);
      add_to_modes(free_bar * film.drops, bar.parts.carried.mean);
      bar.shown -= free_bar * metals_own(film, metal, part);
      bar.left.mean += by_modes(own_bar, metal) - part * by_modes(own_bar, film.both);
      bar.metal += by_modes(own_bar, mean);
      bar.both -= part * by_modes(own_bar, mean);
      bar.parts.carried.mean += part * own_bar;
      bar.part += own_bar * (carried - by_modes(film.both, mean));
      return bar.shift * slopes.in_difference;
    }

    /// Of what the temperature behind the film has by friction.
    void reverse_frictions_shift(const NodeFilm<double> &film, const double part, NodeFilmBar &bar)
    {
      const FrictionInSkins<double> &friction = *film.friction;
      const Skin<double>            &source   = film.parts.source.mean;
      const double                   driven   = bar.shift * friction.difference; // by both terms of sigma
      bar.friction.difference += bar.shift * (film.drops * drop_of(source) - part * (film.shown * source));
      bar.friction.rise += bar.shift * (film.shown * friction.unit.mean);
      bar.friction.unit.mean += bar.shift * friction.rise * film.shown;
      bar.drops += driven * drop_of(source);
      add_to_modes(driven * film.drops, bar.parts.source.mean);
      bar.parts.source.mean -= driven * part * film.shown;
      bar.part -= driven * (film.shown * source);
      bar.shown += bar.shift * friction.rise * friction.unit.mean - driven * part * source;
    }

    /// Of 1 + R.
    void reverse_drops(const NodeFilm<double> &film, const double part, NodeFilmBar &bar)
    {
      const Skin<double> &source = film.parts.source.mean;
      const double        drops = unbounded_drops(film, part), without = 1. - drop_of(source),
                   drops_bar = bar.drops * slope_of_bounded_drops(drops), shows_bar = -drops_bar / without;
      add_to_modes(drops_bar * drops / without, bar.parts.source.mean);
      bar.parts.source.mean += shows_bar * part * film.shown;
      bar.shown += shows_bar * part * source;
      bar.part += shows_bar * (film.shown * source);
    }

    /// Of what the time makes of the skins.
    /// @return derivative in the time
    double reverse_time(const SkinsOverStep<double> &over,
                        const NodeFilm<double>      &film,
                        const double                 time,
                        NodeFilmBar                 &bar)
    {
      double time_bar = along(slope_of_healing(time), bar.left);
      over.touching(time, [&](const SkinPropagator &beneath) {
        bar.both += beneath.reverse_carried(bar.parts.carried);
        const auto  of_carried = beneath.carried_slopes(film.both);
        const auto &of_source  = beneath.source_slopes();
        bar.rate += along(of_carried[0], bar.parts.carried) + along(of_source[0], bar.parts.source);
        time_bar += along(of_carried[1], bar.parts.carried) + along(of_source[1], bar.parts.source);
      });
      return time_bar;
    }
  } // namespace

  std::vector<double> ReverseContactSkins::reverse_temperatures(const NodeSkins<double> &skin_bar) const
  {
    std::vector<double> T_bar(T_.size(), 0.);
    auto                film = contact_.films_.begin();
    for (const auto &contact : contact_.contacts_)
      if (contact.has_film)
      {
        T_bar[contact.node] =
          reverse_across(*film, reverse_grown(flow_, contact, contact_.over_.part(), skin_bar)) / film->drops;
        ++film;
      }
    return T_bar;
  }

  void ReverseContactSkins::reverse(const std::vector<double> &T_films,
                                    const NodeFilms<double>   &films_bar,
                                    std::vector<double>       &T_bar,
                                    NodeSkins<double>         &skin_bar,
                                    HeatFlowBar               &bar) const
  {
    const SkinsOverStep<double> &over     = contact_.over_;
    const double                 p        = over.part();
    double                       rate_bar = 0., p_bar = 0.;
    std::vector<double>          open_bar(T_.size(), 0.);
    std::vector<double>          open(T_.size(), dt_);
    std::vector<NodeContactBar>  contacts_bar;
    auto                         next = contact_.films_.begin();
    for (const auto &contact : contact_.contacts_)
    {
      const NodeIndex k           = contact.node;
      NodeContactBar &contact_bar = contacts_bar.emplace_back(contact);
      open[k] -= contact.weight * dt_;
      if (!contact.has_film)
        continue;
      const NodeFilm<double> &film = *next++;
      NodeFilmBar             film_bar =
        reverse_advance(flow_, contact, film, p, T_films[k], skin_, skin_bar, contact_bar);

      // A h/(1 + R), and it times t + u.
      const double phi     = contact.area * flow_.contact_film / film.drops,
                   phi_bar = films_bar.conductance[k] + films_bar.source[k] * (film.behind + film.shift);
      film_bar.behind += films_bar.source[k] * phi;
      film_bar.shift += films_bar.source[k] * phi;
      film_bar.drops -= phi_bar * phi / film.drops;
      contact_bar.area += phi_bar * flow_.contact_film / film.drops;
      bar.contact_film += phi_bar * contact.area / film.drops;

      if (film.friction)
        reverse_frictions_shift(film, p, film_bar);
      const double of_difference = reverse_shift(
        film, skin_.metal[k], p, T_[k] - film.behind, drop_of(contact.dies_skin(flow_, skin_)), film_bar);
      T_bar[k] += of_difference;
      contact_bar.die_temperature += film_bar.behind - of_difference;
      reverse_drops(film, p, film_bar);
      contact_bar.depth += reverse_parts_shown(flow_.law, contact.depth(flow_), film_bar.shown, bar.law);
      const double time     = contact.weight * dt_;
      double       time_bar = 0.;
      if (film.friction)
      {
        const auto of_friction = reverse_friction_in_skins(flow_.law,
                                                           flow_.contact_film,
                                                           (*flow_.friction)[k],
                                                           time,
                                                           film.left,
                                                           film_bar.friction,
                                                           bar.law,
                                                           film_bar.left);
        film_bar.part += of_friction.part;
        bar.contact_film += of_friction.film;
        (*bar.friction)[k] += of_friction.flux;
        time_bar += of_friction.time;
      }
      time_bar += reverse_time(over, film, time, film_bar);
      contact_bar.weight += time_bar * dt_;
      bar.dt += time_bar * contact.weight;
      rate_bar += film_bar.rate;
      p_bar += film_bar.part;

      // D = M + N
      skin_bar.metal[k]     = film_bar.metal + film_bar.both;
      Skin<double> dies_bar = film_bar.both;
      add_to_modes(film_bar.warmth, dies_bar);
      for (std::size_t e = 0; e < contact.entries.size(); ++e)
      {
        const unsigned int i = contact.entries[e], die = flow_.surface.touching[i].die;
        skin_bar.dies[die][k] += contact.share(flow_, i) * dies_bar;
        contact_bar.share[e] += dies_bar * skin_.dies[die][k];
      }
    }

    // Skins that healed before.
    for (NodeIndex k = 0; k < T_.size(); ++k)
      if (open[k] > 0.)
      {
        const Skin<double> left = over.healing(open[k]).after, slope = slope_of_healing(open[k]).after;
        const auto         reverse_healed = [&](const Skin<double> &before, Skin<double> &of_skin_bar) {
          open_bar[k] += by_modes(slope, before) * of_skin_bar;
          of_skin_bar = by_modes(of_skin_bar, left);
        };
        reverse_healed(before_.metal[k], skin_bar.metal[k]);
        for (std::size_t d = 0; d < skin_bar.dies.size(); ++d)
          reverse_healed(before_.dies[d][k], skin_bar.dies[d][k]);
        bar.dt += open_bar[k];
      }
    for (std::size_t c = 0; c < contacts_bar.size(); ++c)
    {
      const auto  &contact = contact_.contacts_[c];
      const double of_open = open_bar[contact.node];
      contacts_bar[c].weight -= of_open * dt_;
      bar.dt -= of_open * contact.weight;
      contacts_bar[c].reverse(flow_, contact, bar);
    }

    // rate = h (1/b_m + 1/b_d)
    const HeatLaw<double> &law   = flow_.law;
    const double           metal = metals_effusivity(law), die = law.die_effusivity,
                 per_square = -rate_bar * flow_.contact_film;
    bar.contact_film += rate_bar / joint_effusivity(metal, die);
    reverse_metals_effusivity(law, per_square / (metal * metal), bar.law);
    bar.law.die_effusivity += per_square / (die * die);
    reverse_metals_part(law, p_bar, bar.law);
  }
} // namespace retroforge
