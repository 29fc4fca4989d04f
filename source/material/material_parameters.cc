// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/csv_table.h>
#include <retroforge/core/enum_setting.h>
#include <retroforge/core/error.h>
#include <retroforge/core/nearest_name.h>
#include <retroforge/core/number_checks.h>
#include <retroforge/core/setting_tags.h>
#include <retroforge/core/text.h>
#include <retroforge/material/material_parameters.h>
#include <retroforge/material/temperature_range.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  void MaterialParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    using dealii::Patterns::Double, dealii::Patterns::List;
    prm.enter_subsection("Material");
    prm.add_parameter(
      "law",
      type,
      "Law of the metal at a point, of the strain rate e, the accumulated strain q and the "
      "temperature T. Norton-Hoff, s = 2K (sqrt3 e)^(m-1) eps, is the same everywhere; power: "
      "K (q + q0)^n exp(-beta (T - T0)) and m + m1 (T - T0) in place of K and m; "
      "Hansel-Spittel: flow stress A exp(m1 T) T^m9 q^m2 exp(m4/q) (1+q)^(m5 T + m6) exp(m7 q) "
      "e^(m3 + m8 T), q at least about q0; table: flow stresses from a file. Programs that use the "
      "library may add others. Units: none.");
    prm.add_parameter("consistency",
                      law.K,
                      "K of the laws Norton-Hoff and power, s = 2K (sqrt3 e)^(m-1) eps. Units: MPa s^m.",
                      Double(1e-300));
    prm.add_parameter(
      "strain rate sensitivity",
      law.m,
      "m of the laws Norton-Hoff and power: 1 is a Newtonian fluid, hot steel is near 0.14. Units: none.",
      Double(1e-3, 1.));
    prm.add_parameter("regularising strain rate",
                      law.e0,
                      "e0 in e^2 -> e^2 + e0^2: keeps the viscosity finite where the metal is still. Part of "
                      "the model. 0 takes "
                      "1e-3 or, where the scene is slow, a hundredth of the speed at which the dies close "
                      "over the height of the "
                      "billet. Units: 1/s.",
                      Double(0.));
    prm.add_parameter(
      "further numbers",
      numbers,
      "Numbers that the law has beyond these, as `n: 0.2, q0: 0.01`. power: n, beta, m1 (0 where "
      "left out), q0 (1e-3), T0 (20). Hansel-Spittel: A, which must be given, m1 to m9 (0), q0 (0.02). "
      "table: factor (1), by which all stresses are multiplied. Norton-Hoff has none. Units: those of "
      "the law, T in C.");
    prm.add_parameter("table",
                      table,
                      "File of the law `table': comma-separated, with the columns strain, strain rate [1/s], "
                      "temperature [C] and flow stress [MPa], a row for each combination. Units: none.",
                      dealii::Patterns::Anything());
    prm.add_parameter(
      "temperature",
      temperature,
      "Temperature of the billet before the stroke, which laws that follow it need. Empty: not "
      "given. Units: C.",
      dealii::Patterns::Anything());
    add_enum<Damage>(
      prm,
      "damage",
      damage,
      {{"none", Damage::none}, {"Latham-Cockcroft", Damage::latham_cockcroft}},
      "Damage that the metal collects, for the objective `damage' and pictures; it weakens nothing. "
      "Latham-Cockcroft: the integral of max(sigma_1, 0)/sigma_0 over the strain, sigma_1 the largest "
      "principal stress and sigma_0 the flow stress. Units: none.");
    const std::string range =
      "beyond them a run warns. Files of materials have them. Empty: not told. Units: ";
    prm.add_parameter("valid temperatures",
                      valid_temperatures,
                      "Between which the numbers of the law hold, as `800, 1250'; " + range + "C.",
                      List(Double(), 0, 2));
    prm.add_parameter("valid strain rates",
                      valid_rates,
                      "Between which they hold, as `0.1, 100'; " + range + "1/s.",
                      List(Double(0.), 0, 2));
    prm.leave_subsection();
    tag(prm, "Material", SettingRole::scene);
    tag(prm, "Material/table", SettingTags::Files::one);
    for (const char *entry : {"Material/valid temperatures", "Material/valid strain rates"})
      tag(prm, entry, SettingRole::report);
  }

  namespace
  {
    constexpr double room_temperature = 20.; // [C]

    /// Numbers in their order, with those of the law where none is given.
    std::vector<double> ordered(const std::map<std::string, double> &given,
                                const std::vector<NumberInfo>       &info,
                                const std::string                   &law)
    {
      const std::string        where = "Material/further numbers", owner = "the law '" + law + "'";
      std::vector<std::string> names;
      for (const NumberInfo &number : info)
        names.push_back(number.name);
      for (const auto &[name, value] : given)
        if (std::find(names.begin(), names.end(), name) == names.end())
        {
          const std::string near = nearest_name(name, names, tolerated_edits(name));
          throw Error(where,
                      "names '" + name + "'",
                      names.empty() ? owner + " has no further numbers" : owner + " has " + join(names),
                      names.empty() ? "leave it empty"
                                    : (near.empty() ? "name some of these" : "did you mean '" + near + "'?"));
        }
      std::vector<double> numbers;
      for (const NumberInfo &number : info)
        if (const auto found = given.find(number.name); found != given.end())
          numbers.push_back(found->second);
        else if (number.otherwise)
          numbers.push_back(*number.otherwise);
        else
          throw Error(where,
                      "does not give " + number.name,
                      owner + " has " + join(names) + ", and " + number.name + " has no value of its own",
                      "add " + number.name + ": VALUE" +
                        (number.unit.empty() ? "" : " [" + number.unit + "]"));
      check_numbers(numbers, info, where, owner);
      return numbers;
    }

    /// The temperature of the billet, if it is given [C].
    std::optional<double> temperature_of(const std::string &text)
    {
      if (text.empty())
        return {};
      const auto T = number_in(text);
      if (!T || *T <= absolute_zero || *T > hottest)
        throw Error("Material/temperature",
                    "is '" + legible(text) + "'",
                    "temperatures are numbers in C, above " + as_text(absolute_zero) + " and at most " +
                      as_text(hottest),
                    "give that of the billet; subtract 273.15 from one in K");
      return T;
    }

    void check_range(const std::vector<double> &range, const std::string &entry)
    {
      if (!range.empty() && !(range.size() == 2 && range[0] < range[1]))
        throw Error("Material/" + entry,
                    range.size() == 2 ? "go from " + as_text(range[0]) + " to " + as_text(range[1])
                                      : "has one number",
                    "a range has two, the smaller one first",
                    "give `FROM, TO', or leave it empty");
    }

    std::shared_ptr<const FlowTable> table_of(const std::string &file)
    {
      if (file.empty())
        throw Error(
          "Material/table", "is empty", "the law 'table' takes its stresses from a file", "name the file");
      return std::make_shared<const FlowTable>(read_flow_table(file));
    }

    void check_initial_law(const Material<double> &metal, const std::string &law)
    {
      const MaterialLaw<double> initial = metal.initial_law();
      const std::string         at = " before the stroke, at " + as_text(metal.initial.temperature) + " C";
      if (!(initial.K > 0.) || !std::isfinite(initial.K))
        throw Error("Material/further numbers",
                    "give metal by the law '" + law + "' the consistency " + as_text(initial.K) + at,
                    "stresses are positive",
                    "look at the units of the numbers; Hansel-Spittel's law is for T above 0 C");
      if (!(initial.m > 0.) || initial.m > 1.)
        throw Error("Material/further numbers",
                    "give metal by the law '" + law + "' the strain rate sensitivity " + as_text(initial.m) +
                      at,
                    "it is above 0 and at most 1",
                    "look at the numbers that follow the temperature, which is in C");
    }
  } // namespace

  Material<double> MaterialParameters::metal(const double rate) const
  {
    check_range(valid_temperatures, "valid temperatures");
    check_range(valid_rates, "valid strain rates");
    Material<double> metal(law);
    metal.type               = find_material_type(type, "Material/law");
    metal.damage             = static_cast<unsigned int>(damage);
    const MaterialType &sort = material_type(metal.type);
    metal.numbers            = ordered(numbers, sort.info(), type);
    if (law.e0 == 0.)
      metal.law.e0 = std::min(1e-3, 1e-2 * rate);
    if (sort.reads_table())
      metal.table = table_of(table);
    else if (!table.empty())
      throw Error("Material/table",
                  "names '" + legible(table) + "'",
                  "the law '" + type + "' has no table",
                  "leave it empty, or set law = table");
    const auto T              = temperature_of(temperature);
    metal.initial.temperature = T.value_or(room_temperature);
    if (!T && sort.depends_on_temperature(metal))
      throw Error("Material/temperature",
                  "is not given",
                  "the law '" + type + "' follows the temperature",
                  "give that of the billet, in C");
    check_initial_law(metal, type);
    return metal;
  }
} // namespace retroforge
