// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/nearest_name.h>
#include <retroforge/optimization/scenarios.h>

#include <algorithm>
#include <filesystem>
#include <set>

namespace retroforge
{
  namespace
  {
    const char *const entry = "Optimisation/operations";

    std::string stem_of(const std::string &file)
    {
      return std::filesystem::path(file).stem().string();
    }

    std::vector<std::optional<std::size_t>> places_in(const Design &design, const Design &own)
    {
      std::vector<std::optional<std::size_t>> places;
      for (const DesignParameter &parameter : own.parameters())
      {
        places.emplace_back();
        for (std::size_t j = 0; j < design.parameters().size(); ++j)
          if (design.parameters()[j].name == parameter.name)
            places.back() = j;
      }
      return places;
    }
  } // namespace

  std::vector<CommandLine> commands_of_scenarios(const Case &main)
  {
    std::vector<CommandLine> commands;
    for (const std::string &file : main.parameters.optimization.operations)
    {
      if (std::error_code ignored; !std::filesystem::is_regular_file(file, ignored))
        throw Error(entry,
                    "names '" + file + "', which is a file neither in this folder nor in that of the case",
                    "each is the parameter file of a case",
                    "correct its name");
      CommandLine command = main.command;
      command.case_file   = file;
      command.overrides.clear();
      command.at.clear();
      commands.push_back(std::move(command));
    }
    return commands;
  }

  Scenarios::Scenarios(const Case &main, const std::vector<CommandLine> &others, Timings &timings)
      : main_(&main), names_{""}, places_{places_in(main.design, main.design)}
  {
    for (const CommandLine &command : others)
      add(command, timings);
    std::set<std::string> titles;
    for (const NamedObjective &objective : objectives())
      if (!titles.insert(objective.name).second)
        throw Error("Objectives/names",
                    "'" + objective.name + "' would be the name of two objectives",
                    "an objective of another operation is named `OBJECTIVE of OPERATION'",
                    "rename that of the case");
  }

  void Scenarios::add(const CommandLine &command, Timings &timings)
  {
    const std::string name = stem_of(command.case_file);
    if (name == stem_of(main_->command.case_file) ||
        std::find(names_.begin(), names_.end(), name) != names_.end())
      throw Error(entry,
                  "names '" + command.case_file + "', and another file is called " + name + ", too",
                  "operations are told apart by the names of their files, without folders",
                  "rename one");
    if (name.find_first_of(":,") != std::string::npos)
      throw Error(entry,
                  "names '" + command.case_file + "', with ':' or ',' in it",
                  "the name stands in lists of objectives",
                  "rename the file");
    others_.push_back(std::make_unique<const Case>(command, timings, main_->comm));
    names_.push_back(name);
    places_.push_back(places_in(main_->design, others_.back()->design));
    const std::vector<std::string> varied = main_->design.expanded(main_->parameters.design.names);
    const std::vector<std::string> shared = common(size() - 1);
    if (std::find_first_of(varied.begin(), varied.end(), shared.begin(), shared.end()) == varied.end())
      throw Error(entry,
                  "names '" + command.case_file + "', which has no parameter of the design",
                  "an operation has one at least, by its own Design/parameters, of " + join(varied),
                  "name one there, too, or leave the operation out");
  }

  std::vector<std::string> Scenarios::common(const std::size_t o) const
  {
    std::vector<std::string> names;
    for (const std::optional<std::size_t> &place : places_[o])
      if (place)
        names.push_back(main_->design.parameters()[*place].name);
    return names;
  }

  Objectives Scenarios::objectives() const
  {
    Objectives all;
    for (std::size_t o = 0; o < size(); ++o)
      for (NamedObjective &objective : at(o).parameters.make_objectives(at(o).model.dies, at(o).billet))
      {
        if (o > 0)
          objective.name += " of " + name(o);
        all.push_back(std::move(objective));
      }
    return all;
  }

  std::vector<double> Scenarios::values(const std::size_t o, const std::vector<double> &mu) const
  {
    std::vector<double> own = at(o).mu;
    for (std::size_t k = 0; k < own.size(); ++k)
      if (places_[o][k])
        own[k] = mu[*places_[o][k]];
    return own;
  }

  std::vector<double> Scenarios::pull_back(const std::size_t o, const std::vector<double> &by_own) const
  {
    std::vector<double> by_mu(main_->mu.size(), 0.);
    for (std::size_t k = 0; k < by_own.size(); ++k)
      if (places_[o][k])
        by_mu[*places_[o][k]] += by_own[k];
    return by_mu;
  }

  Evaluation Scenarios::joined(const std::vector<double> &mu, const std::vector<Evaluation> &each) const
  {
    if (size() == 1)
      return each.front();
    Evaluation all;
    all.mu         = mu;
    all.increments = each.front().increments;
    for (std::size_t o = 0; o < each.size(); ++o)
    {
      all.seconds += each[o].seconds;
      if (each[o].failed())
      {
        all.failure    = (o == 0 ? "" : "in " + name(o) + ": ") + each[o].failure;
        all.increments = each[o].increments;
        all.values.clear();
        return all;
      }
      all.values.insert(all.values.end(), each[o].values.begin(), each[o].values.end());
    }
    if (std::any_of(each.begin(), each.end(), [](const Evaluation &e) { return e.gradients.empty(); }))
      return all;
    for (std::size_t o = 0; o < each.size(); ++o)
      for (const std::vector<double> &gradient : each[o].gradients)
        all.gradients.push_back(pull_back(o, gradient));
    return all;
  }
} // namespace retroforge
