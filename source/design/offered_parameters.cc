// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
//
// The design parameters that a scene offers, by name.
#include <retroforge/core/error.h>
#include <retroforge/core/nearest_name.h>
#include <retroforge/design/design.h>

#include <algorithm>

namespace retroforge
{
  namespace
  {
    using Kind = DesignParameter::Kind;

    std::string zone_prefix(const DieParameters &die, const DieZoneParameters &zone)
    {
      return "die " + die.name + "/zone " + zone.name + "/";
    }
  } // namespace

  std::vector<std::string> Design::expanded(const std::vector<std::string> &names) const
  {
    const std::vector<DesignParameter> all        = offered();
    const auto                         is_mode_of = [](const std::string &name, const std::string &form) {
      const std::string end = "/free form";
      return form.size() > end.size() && form.substr(form.size() - end.size()) == end &&
             name.rfind(form + " ", 0) == 0;
    };
    std::vector<std::string> single;
    for (const std::string &name : names)
    {
      const std::size_t n = single.size();
      for (const DesignParameter &parameter : all)
        if (is_mode_of(parameter.name, name))
          single.push_back(parameter.name);
      // One that is given a value stands for itself in all of them.
      if (single.size() == n && std::none_of(names.begin(), names.end(), [&](const std::string &form) {
            return is_mode_of(name, form);
          }))
        single.push_back(name);
    }
    return single;
  }

  std::map<std::string, std::string> idle_parameters(const std::vector<DieParameters> &dies,
                                                     const Material<double>           &material)
  {
    std::map<std::string, std::string> idle;
    bool                               own_friction = false, friction = false, by_rate = false;
    for (const DieParameters &die : dies)
    {
      const DieState<double> state = initial_state(die);
      own_friction |= die.friction > 0.;
      friction |= state.rubs();
      by_rate |= follows_rate(state);
      if (die.friction == 0.)
        idle["die " + die.name + "/friction"] = "the friction of die " + die.name + " is 0";
      for (const DieZoneParameters &zone : die.zones)
        if (zone.friction == 0.)
          idle[zone_prefix(die, zone) + "friction"] = "the friction of this zone is 0";
      if (die.velocity.norm() == 0.)
        idle["die " + die.name + "/speed"] = "the velocity of die " + die.name + " is 0";
    }
    if (!own_friction)
      idle["dies/friction"] = "the friction of all dies is 0";
    for (const NumberInfo &number : ContactLaw<double>::info())
      if (!ContactLaw<double>::depends_on(number.name, friction))
        idle["contact/" + number.name] = "the friction of all dies is 0";
    for (const NumberInfo &number : MaterialLaw<double>::info())
      if (!material.depends_on(number.name) && !(by_rate && material_type(material.type).reads_consistency()))
        idle["material/" + number.name] = material_type(material.type).reads_consistency()
                                            ? "the strain rate sensitivity is 1"
                                            : "the law of the metal does not read it";
    return idle;
  }

  bool DesignParameter::overlaps(const DesignParameter &other) const
  {
    const bool same_die = die == other.die || die == invalid_index || other.die == invalid_index;
    return kind == other.kind && same_die && number == other.number && measure == other.measure;
  }

  namespace
  {
    /// The numbers of a law, called GROUP/NAME, those that `offers` names.
    template <typename Law, typename Offers>
    void add_numbers_of(Law                           law,
                        const std::string            &group,
                        const Kind                    kind,
                        const Offers                 &offers,
                        std::vector<DesignParameter> &all)
    {
      const std::vector<NumberInfo> info = law.info();
      for (unsigned int i = 0; i < info.size(); ++i)
        if (offers(info[i].name))
        {
          const double value = number_of(law, i);
          all.push_back({group + "/" + info[i].name,
                         info[i].unit,
                         kind,
                         value,
                         value,
                         invalid_index,
                         i,
                         {},
                         info[i].may_vanish,
                         info[i].largest,
                         info[i].any_sign});
        }
    }

    /// Coefficient and bound of the friction of a die or a zone.
    void add_friction_of(const ZoneFriction<double>                  &given,
                         const std::string                           &prefix,
                         const std::pair<Kind, Kind>                 &kinds,
                         const std::pair<unsigned int, unsigned int> &die_and_zone,
                         std::vector<DesignParameter>                &all)
    {
      if (!(given.friction > 0.))
        return;
      const auto &[d, z]           = die_and_zone;
      const InterfaceLaw &law      = interface_law(given.interface_law);
      const NumberInfo    friction = law.coefficient();
      all.push_back({prefix + "friction",
                     friction.unit,
                     kinds.first,
                     given.friction,
                     given.friction,
                     d,
                     z,
                     {},
                     friction.may_vanish,
                     friction.largest});
      if (const auto limit = law.limit())
        all.push_back({prefix + "shear limit",
                       limit->unit,
                       kinds.second,
                       given.shear_limit,
                       given.shear_limit,
                       d,
                       z,
                       {},
                       limit->may_vanish,
                       limit->largest});
    }

    void add_numbers_of(const DieParameters          &die,
                        const DieFreeForm            &form,
                        const DieState<double>       &state,
                        const unsigned int            d,
                        const double                  width,
                        std::vector<DesignParameter> &all)
    {
      const std::string prefix = "die " + die.name + "/";
      const double      speed  = die.velocity.norm();
      add_friction_of(state.own_friction(), prefix, {Kind::friction, Kind::shear_limit}, {d, 0}, all);
      for (unsigned int z = 0; z < die.zones.size(); ++z)
        add_friction_of(state.zones[z],
                        zone_prefix(die, die.zones[z]),
                        {Kind::zone_friction, Kind::zone_limit},
                        {d, z},
                        all);
      if (speed > 0.)
        all.push_back({prefix + "speed", "mm/s", Kind::speed, speed, speed, d});
      all.push_back({prefix + "offset", "mm", Kind::offset, 0., width, d});
      for (const auto &[key, measure] : die.shape->measures())
        all.push_back({prefix + key, measure.unit, Kind::die_shape, measure.value, measure.value, d, 0, key});
      for (unsigned int i = 0; i < form.n_modes(); ++i)
        all.push_back(
          {prefix + "free form " + std::to_string(i + 1), "mm", Kind::die_free_form, 0., width, d, i});
    }

    bool dwells(const Process<double> &process)
    {
      return std::any_of(process.operations.begin(),
                         process.operations.end(),
                         [](const Operation<double> &operation) { return operation.waiting.dwell > 0.; });
    }

    /// Times before strokes: of the first as parameter files have them, of others by their operation.
    void add_waiting_times(const Process<double> &process, std::vector<DesignParameter> &all)
    {
      for (unsigned int o = 0; o < process.operations.size() && process.heat.conducts(); ++o)
      {
        const Waiting<double> &waiting = process.operations[o].waiting;
        const std::string      prefix  = o == 0 ? "heat/" : "operation " + std::to_string(o + 1) + "/";
        for (const auto &[name, kind, time] :
             {std::make_tuple("transfer time", Kind::transfer, waiting.transfer),
              std::make_tuple("dwell time", Kind::dwell, waiting.dwell)})
          if (time > 0.)
          {
            DesignParameter parameter{prefix + name, "s", kind, time, time, invalid_index, o};
            parameter.may_vanish = true;
            all.push_back(parameter);
          }
      }
    }
  } // namespace

  NumberInfo Design::friction_of(const unsigned int d) const
  {
    return interface_law(process_.dies[d].interface_law).coefficient();
  }

  std::vector<DesignParameter> Design::offered() const
  {
    const auto with_friction =
      std::find_if(dies_.begin(), dies_.end(), [](const DieParameters &die) { return die.friction > 0.; });
    const bool friction =
      std::any_of(process_.dies.begin(), process_.dies.end(), [](const auto &die) { return die.rubs(); });
    const bool by_rate = std::any_of(process_.dies.begin(), process_.dies.end(), follows_rate<double>);
    std::vector<DesignParameter> all;
    add_numbers_of(
      process_.material,
      "material",
      Kind::material,
      [&](const std::string &name) {
        return process_.material.depends_on(name) ||
               (by_rate && material_type(process_.material.type).reads_consistency());
      },
      all);
    if (const Material<double> &metal = process_.material;
        material_type(metal.type).depends_on_temperature(metal) || process_.heat.warms())
    {
      // The metal's initial state follows the numbers of its law: strain, then temperature.
      DesignParameter temperature{"billet/temperature", "C", Kind::material, metal.initial.temperature, 100.};
      temperature.number   = metal.info().size() + 1;
      temperature.any_sign = true;
      all.push_back(temperature);
    }
    if (process_.heat.warms())
      add_numbers_of(
        process_.heat,
        "heat",
        Kind::heat,
        [&](const std::string &name) {
          return process_.heat.reads(name) && (name != "dwell film" || dwells(process_));
        },
        all);
    add_waiting_times(process_, all);
    if (process_.heat.conducts())
      for (unsigned int d = 0; d < dies_.size(); ++d)
      {
        DesignParameter temperature{
          "die " + dies_[d].name + "/temperature", "C", Kind::die_temperature, dies_[d].temperature, 100., d};
        temperature.any_sign = true;
        all.push_back(temperature);
      }
    add_numbers_of(
      process_.contact,
      "contact",
      Kind::contact,
      [&](const std::string &name) { return process_.contact.depends_on(name, friction); },
      all);
    for (unsigned int j = 0; j < billet_map_.parameters().size(); ++j)
    {
      const ShapeParameter &shape = billet_map_.parameters()[j];
      all.push_back(
        {"billet/" + shape.name, shape.unit, Kind::billet, shape.nominal, shape.scale, invalid_index, j});
    }
    for (unsigned int d = 0; d < dies_.size(); ++d)
      add_numbers_of(dies_[d], die_forms_[d], process_.dies[d], d, width_, all);
    if (with_friction != dies_.end())
    {
      const NumberInfo coefficient = friction_of(with_friction - dies_.begin());
      all.push_back({"dies/friction",
                     coefficient.unit,
                     Kind::friction,
                     with_friction->friction,
                     with_friction->friction,
                     invalid_index,
                     0,
                     {},
                     true,
                     coefficient.largest});
    }
    return all;
  }

  void Design::check_offered(const std::string &name, const std::string &where) const
  {
    std::vector<std::string> known;
    for (const DesignParameter &parameter : offered())
      known.push_back(parameter.name);
    if (std::find(known.begin(), known.end(), name) != known.end())
      return;
    const auto idle = idle_parameters(dies_, process_.material);
    if (const auto found = idle.find(name); found != idle.end())
      throw Error(where,
                  "'" + name + "' changes nothing, as " + found->second,
                  "a derivative is taken by what acts",
                  "leave it out, or give that number another value: a friction of 1e-6 is next to none");
    if (const bool is_of_die = name.rfind("die ", 0) == 0 && name.find("/temperature") != std::string::npos;
        !process_.heat.conducts() && (is_of_die || name.rfind("heat/", 0) == 0))
      throw Error(where,
                  "names '" + name + "', and no heat flows: Heat/heating is not conduction",
                  "a derivative is taken by what acts",
                  "set Heat/heating = conduction, or leave it out");
    for (const std::string time : {"transfer time", "dwell time"})
      if (name == "heat/" + time && process_.heat.conducts())
        throw Error(where,
                    "names '" + name + "', and Heat/" + time + " is 0",
                    "a time that is a parameter is there to begin with",
                    "set Heat/" + time + " > 0: 0.01 s is next to none");
    const std::string near = nearest_name(name, known, 6);
    throw Error(where,
                "'" + name + "' is not a parameter of this scene",
                "it offers " + join(known),
                near.empty() ? "name some of these" : "did you mean '" + near + "'?");
  }

  void Design::check_common_friction() const
  {
    const DieParameters *first = nullptr;
    for (const auto &die : dies_)
      if (die.friction > 0.)
      {
        if (first && (first->friction != die.friction || first->friction_law != die.friction_law))
          throw Error("Design/parameters",
                      std::string("'dies/friction' stands for all dies with friction, but their ") +
                        (first->friction_law != die.friction_law ? "laws" : "coefficients") + " differ",
                      "one number must describe them all",
                      "name each die, as in 'die " + die.name + "/friction'");
        first = &die;
      }
  }
} // namespace retroforge
