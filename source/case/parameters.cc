// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/case/parameters.h>
#include <retroforge/core/error.h>
#include <retroforge/core/nearest_name.h>
#include <retroforge/material/temperature_range.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace retroforge
{
  namespace
  {
    /// Below it the friction of a sticking node is infinitely stiff, in the dies' closing speed.
    constexpr double least_slip = 1e-20;
  } // namespace

  void Parameters::add_parameters(dealii::ParameterHandler &prm, const NamesOf &names_of)
  {
    billet.add_parameters(prm);
    prm.enter_subsection("Dies");
    prm.declare_entry("names",
                      "",
                      dealii::Patterns::Anything(),
                      "Names of the dies; each has a section `Die NAME`. Units: none.");
    prm.leave_subsection();
    tag(prm, "Dies", SettingRole::scene);
    dies.clear();
    for (const std::string &name : names_of("Die", "Dies/names", ""))
    {
      dies.emplace_back(name);
      const std::string section = dies.back().section();
      for (const std::string &zone : names_of(section + "/Zone", section + "/zones", ""))
        dies.back().zones.emplace_back(zone, section);
    }
    for (DieParameters &die : dies)
      die.add_parameters(prm);
    material.add_parameters(prm);
    press.add_parameters(prm);
    discretization.add_parameters(prm);
    contact.add_parameters(prm);
    heat.add_parameters(prm);
    newton.add_parameters(prm);
    linear_solver.add_parameters(prm);
    remeshing.add_parameters(prm);
    adjoint.add_parameters(prm);
    objectives.all.clear();
    for (const std::string &name : names_of("Objective", "Objectives/names", "energy"))
      objectives.all.emplace_back(name);
    objectives.add_parameters(prm);
    design.add_parameters(prm);
    check.add_parameters(prm);
    scan.add_parameters(prm);
    optimization.add_parameters(prm);
    output.add_parameters(prm);
  }

  const SettingTags &Parameters::tags()
  {
    static const SettingTags all = [] {
      TaggedHandler prm;
      Parameters    parameters;
      parameters.add_parameters(
        prm, [](const auto &, const auto &, const auto &) { return std::vector<std::string>{"*"}; });
      return prm.tags;
    }();
    return all;
  }

  void Parameters::print_template(std::ostream &out)
  {
    dealii::ParameterHandler prm;
    Parameters               parameters;
    parameters.add_parameters(
      prm, [](const std::string &kind, const std::string &, const std::string &by_default) {
        return dealii::Utilities::split_string_list(kind == "Die" ? "lower, upper" : by_default);
      });
    set_parameters(prm,
                   parameter_lines_of(R"(subsection Dies
  set names = lower, upper
end
subsection Die lower
  set facing   = 0, 0, 1
  set friction = 0.3
end
subsection Die upper
  set point    = 0, 0, 50
  set facing   = 0, 0, -1
  set velocity = 0, 0, -100
  set friction = 0.3
end
)",
                                      "template"));
    print_parameters(prm, out);
  }

  namespace
  {
    /// Settings that are read where heat flows.
    bool is_of_conduction(const std::string &path)
    {
      constexpr std::array<std::string_view, 3> others{
        {"Heat/heating", "Heat/heat capacity", "Heat/fraction of work"}};
      const bool of_die = path.rfind("Die ", 0) == 0 && path.substr(path.find('/')) == "/temperature";
      return of_die ||
             (path.rfind("Heat/", 0) == 0 && std::find(others.begin(), others.end(), path) == others.end());
    }
  } // namespace

  void Parameters::find_without_effect(const std::vector<ParameterEntry> &entries)
  {
    for (const ParameterEntry &entry : entries)
      if (const ReadBy *read_by = tags().choice(entry.path()))
        for (const std::string &sentence : settings_without_effect(entries, entry.path(), *read_by))
          without_effect.push_back(sentence);
    const auto find_limits = [&](const std::string &section, const std::string &law) {
      for (const ParameterEntry &entry : entries)
        if (entry.path() == section + "/shear limit" && entry.value != entry.default_value &&
            !interface_law(find_interface_law(law, section + "/friction law")).limit())
          without_effect.push_back(entry.path() + " = " + entry.value + " has no effect: the friction law " +
                                   law + " has no such limit");
    };
    for (const DieParameters &die : dies)
    {
      find_limits(die.section(), die.friction_law);
      for (const DieZoneParameters &zone : die.zones)
        find_limits(zone.section(), zone.friction_law);
    }
    if (heat.heating != Heating::conduction)
      for (const ParameterEntry &entry : entries)
        if (entry.value != entry.default_value && is_of_conduction(entry.path()))
          without_effect.push_back(entry.path() + " = " + entry.value +
                                   " has no effect: Heat/heating is not conduction");
    if (!objectives.combined)
      for (const ParameterEntry &entry : entries)
        if (entry.name == "weight" && entry.value != entry.default_value)
          without_effect.push_back(
            entry.path() + " = " + entry.value +
            " has no effect but in `optimize': Objectives/gradients = each makes no weighted sum");
  }

  void Parameters::check_all()
  {
    billet.check();
    discretization.check();
    contact.check();
    remeshing.check();
    scan.check();
    optimization.check();
    if (dies.empty())
      throw Error(
        "Dies/names", "names no die", "a billet is forged by at least one die", "set names = lower, upper");
    if (objectives.all.empty())
      throw Error("Objectives/names",
                  "names no objective",
                  "a run is judged by at least one",
                  "leave the line out for the energy");
    const MaterialLaw<double> metal = material.metal(1.).initial_law();
    for (unsigned int d = 0; d < dies.size(); ++d)
    {
      dies[d].check();
      const DieState<double> state = initial_state(dies[d]);
      if (contact.slip_fraction < least_slip && needs_regularisation(state, metal))
        throw Error("Contact/slip regularisation",
                    "is " + as_text(contact.slip_fraction) + " with friction after " + dies[d].friction_law +
                      " that does not fall in proportion to the slip",
                    "the friction of a sticking node would be infinitely stiff",
                    "use 1e-2, or 1e-3 for a sharper law");
    }
    leading_die();
    resting_die();
    check_heat();
  }

  void Parameters::check_heat() const
  {
    if (heat.heating != Heating::conduction)
      return;
    if (material.temperature.empty())
      throw Error("Material/temperature",
                  "is not given",
                  "heat flows from a billet whose temperature is known",
                  "set that before transfer, dwell and stroke, in C");
    for (const DieParameters &die : dies)
      if (!(die.temperature > absolute_zero))
        throw Error("Die " + die.name + "/temperature",
                    "is " + as_text(die.temperature),
                    "temperatures are in C, above absolute zero",
                    "use for instance 200 for preheated dies");
    if (heat.dwell > 0. && heat.dwell_film == 0.)
      throw Error("Heat/dwell time",
                  "is " + as_text(heat.dwell) + ", with dwell film = 0",
                  "a workpiece that waits on a die gives it heat",
                  "use transfer time, or a dwell film of 1 to 2");
  }

  unsigned int Parameters::resting_die() const
  {
    unsigned int resting = 0;
    for (unsigned int d = dies.size(); d-- > 0;)
      if (dies[d].velocity.norm() == 0.)
        resting = d;
    if (heat.resting_die.empty())
      return resting;
    std::vector<std::string> names;
    for (unsigned int d = 0; d < dies.size(); ++d)
    {
      if (dies[d].name == heat.resting_die)
        return d;
      names.push_back(dies[d].name);
    }
    throw Error("Heat/resting die",
                "there is no die '" + heat.resting_die + "'",
                "the dies are: " + join(names),
                "name one of them, or leave it empty for the first that stands still");
  }

  unsigned int Parameters::leading_die() const
  {
    for (unsigned int d = 0; d < dies.size(); ++d)
      if (press.leading_die.empty() ? dies[d].velocity.norm() > 0. : dies[d].name == press.leading_die)
      {
        if (dies[d].velocity.norm() == 0.)
          throw Error("Press/leading die",
                      "'" + dies[d].name + "' does not move",
                      "the stroke is the path of the leading die",
                      "give it a velocity or name another");
        return d;
      }
    std::vector<std::string> names;
    for (const DieParameters &die : dies)
      names.push_back(die.name);
    if (press.leading_die.empty())
      throw Error("Dies", "no die moves", "one at least must", "give a die a velocity" + unlisted_dies());
    throw Error("Press/leading die",
                "there is no die '" + press.leading_die + "'",
                "the dies are: " + join(names),
                "name one of them, or leave it empty for the first die that moves");
  }

  void Parameters::leave_out_idle_parameters()
  {
    for (const auto &[name, reason] : idle_parameters(dies, material.metal(1.)))
      if (const auto found = std::find(design.names.begin(), design.names.end(), name);
          found != design.names.end())
      {
        design.names.erase(found);
        without_effect.push_back("Design/parameters: '" + name + "' changes nothing, as " + reason);
      }
  }

  std::string Parameters::unlisted_dies() const
  {
    std::string text;
    for (const std::string &sentence : without_effect)
      if (sentence.rfind("section `Die ", 0) == 0)
        text += "; " + sentence;
    return text;
  }
} // namespace retroforge
