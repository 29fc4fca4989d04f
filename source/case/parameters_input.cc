// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/case/parameters.h>
#include <retroforge/core/error.h>
#include <retroforge/core/nearest_name.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <set>
#include <sstream>

namespace retroforge
{
  namespace
  {
    /// Names become sections of the parameter file, names of files, and parts of the names of parameters.
    void check_name(const std::string &where, const std::string &name)
    {
      const bool is_sound = !name.empty() && name.size() <= 64 &&
                            std::all_of(name.begin(), name.end(), [](const unsigned char c) {
                              return std::isalnum(c) != 0 || c == ' ' || c == '_' || c == '-' || c == '.';
                            });
      if (!is_sound)
        throw Error(where,
                    "holds the name '" + legible(name) + "'",
                    "a name has 1 to 64 of the characters a-z, A-Z, 0-9, blank, '_', '-' and '.'",
                    "rename it and its section");
    }

    /// The names that a parameter lists. They must be known before their sections can be declared.
    std::vector<std::string> names_in(const std::map<std::string, std::string> &values,
                                      const std::string                        &where,
                                      const std::string                        &by_default)
    {
      const auto                     given = values.find(where);
      const std::vector<std::string> all =
        dealii::Utilities::split_string_list(given == values.end() ? by_default : given->second);
      constexpr std::size_t most = 100;
      if (all.size() > most)
        throw Error(where,
                    "holds " + std::to_string(all.size()) + " names",
                    "there may be " + std::to_string(most),
                    "name each once");
      for (unsigned int i = 0; i < all.size(); ++i)
      {
        check_name(where, all[i]);
        if (std::find(all.begin(), all.begin() + i, all[i]) != all.begin() + i)
          throw Error(where, "'" + all[i] + "' stands twice", "names must differ", "rename one");
      }
      return all;
    }

    /// A name without a section that sets its type is one of a type.
    void check_objective_names(const std::map<std::string, std::string> &values,
                               const std::vector<std::string>           &names)
    {
      const std::string              where = "Objectives/names";
      const std::vector<std::string> types = ObjectiveParameters::types();
      for (const std::string &name : names)
        if (std::find(types.begin(), types.end(), name) == types.end() &&
            values.count("Objective " + name + "/type") == 0)
        {
          const std::string meant = nearest_name(name, types, tolerated_edits(name));
          throw Error(where,
                      "'" + name + "' is no type of objective, and `Objective " + name + "' sets none",
                      "the types are " + join(types),
                      meant.empty() ? "name one of them, or set the type in that section"
                                    : "did you mean '" + meant + "'?");
        }
    }

    /// Names of sections of one kind, and the list they are from.
    struct NamedSections
    {
      std::string              kind, list;
      std::vector<std::string> names;
    };

    /// Sections `Die NAME', `Die NAME/Zone NAME' or `Objective NAME' of files whose name is not in the list: left there for a
    /// time. One that may be meant by a name of the list that has no section is none of them, but misspelt.
    std::vector<std::string> unlisted_sections(const std::vector<ParameterLine> &lines,
                                               const std::string                &kind,
                                               const std::vector<std::string>   &names)
    {
      std::vector<std::string> sections, without_section;
      for (const ParameterLine &line : lines)
        if (!line.value && line.path.rfind(kind + " ", 0) == 0 &&
            line.path.find('/', kind.size()) == std::string::npos)
          sections.push_back(line.path);
      const auto has_section = [&](const std::string &path) {
        return std::find(sections.begin(), sections.end(), path) != sections.end();
      };
      for (const std::string &name : names)
        if (!has_section(kind + " " + name))
          without_section.push_back(name);
      std::vector<std::string> unlisted;
      for (const std::string &section : sections)
        if (const std::string name = section.substr(kind.size() + 1);
            std::find(names.begin(), names.end(), name) == names.end() &&
            std::find(unlisted.begin(), unlisted.end(), section) == unlisted.end() &&
            nearest_name(name, without_section, tolerated_edits(name)).empty())
          unlisted.push_back(section);
      return unlisted;
    }

    std::vector<ParameterLine> without_section(std::vector<ParameterLine> lines, const std::string &section)
    {
      lines.erase(std::remove_if(lines.begin(),
                                 lines.end(),
                                 [&](const ParameterLine &line) {
                                   return line.path == section || line.path.rfind(section + "/", 0) == 0;
                                 }),
                  lines.end());
      return lines;
    }

    /// Leaves out settings that are not declared and would change nothing of the forging.
    std::vector<ParameterLine> without_outdated(std::vector<ParameterLine>      lines,
                                                const dealii::ParameterHandler &prm)
    {
      std::set<std::string> known;
      for (const ParameterEntry &entry : declared_parameters(prm))
        known.insert(entry.path());
      const auto is_outdated = [&](const ParameterLine &line) {
        const SettingRole role = Parameters::tags().role(line.path).value_or(SettingRole::scene);
        return line.value && known.count(line.path) == 0 && role != SettingRole::scene &&
               role != SettingRole::numerics;
      };
      lines.erase(std::remove_if(lines.begin(), lines.end(), is_outdated), lines.end());
      return lines;
    }

    /// A relative name of a file that stands beside the case's parameter file is that file, wherever the
    /// program is started; others are left as they are.
    std::string beside(const std::string &case_file, const std::filesystem::path &name)
    {
      const std::filesystem::path there = std::filesystem::path(case_file).parent_path() / name;
      std::error_code             ignored;
      return !name.empty() && name.is_relative() && std::filesystem::is_regular_file(there, ignored)
               ? there.lexically_normal().string()
               : name.string();
    }

    /// A relative name of a file that is there, for a parameter file in another folder; others are left as
    /// they are.
    std::string name_seen_from(const std::string &folder, const std::filesystem::path &name)
    {
      std::error_code             failed;
      const std::filesystem::path there =
        !name.empty() && name.is_relative() && std::filesystem::is_regular_file(name, failed)
          ? std::filesystem::relative(name, folder, failed)
          : std::filesystem::path();
      return failed || there.empty() ? name.string() : there.string();
    }

    /// Names of files, each of which becomes another; one name has the commas that it may have.
    template <typename Rename>
    std::string renamed(const SettingTags::Files files, const std::string &names, const Rename &one)
    {
      if (files == SettingTags::Files::one)
        return one(names);
      std::vector<std::string> all = dealii::Utilities::split_string_list(names);
      std::transform(all.begin(), all.end(), all.begin(), one);
      return join(all);
    }

    /// Gives other names to the files that parameters name.
    template <typename Rename>
    void rename_files(dealii::ParameterHandler &prm, const Rename &rename)
    {
      for (const ParameterEntry &entry : declared_parameters(prm))
        if (const SettingTags::Files files = Parameters::tags().files(entry.path());
            files != SettingTags::Files::none)
        {
          for (const std::string &section : entry.sections)
            prm.enter_subsection(section);
          prm.set(entry.name, renamed(files, entry.value, rename));
          for (std::size_t i = 0; i < entry.sections.size(); ++i)
            prm.leave_subsection();
        }
    }

    std::string text_of(const dealii::ParameterHandler &prm)
    {
      std::ostringstream text;
      print_parameters(prm, text);
      return text.str();
    }
  } // namespace

  Parameters Parameters::read(const std::string                                      &file,
                              const std::vector<std::pair<std::string, std::string>> &overrides,
                              std::string                                            &echo)
  {
    return of_lines(file, read_parameter_lines(file, overrides), echo);
  }

  Parameters Parameters::read(const CommandLine &command, std::string &echo)
  {
    if (command.case_text.empty())
      return read(command.case_file, command.settings(), echo);
    std::vector<ParameterLine>       lines = parameter_lines_of(command.case_text, command.case_file);
    const std::vector<ParameterLine> more  = override_lines(command.settings());
    lines.insert(lines.end(), more.begin(), more.end());
    return of_lines("", lines, echo);
  }

  Parameters Parameters::of_record(const std::string &text)
  {
    std::string ignored;
    return of_lines("", parameter_lines_of(text, "parameters of the record"), ignored, Origin::record);
  }

  void
  Parameters::assign(std::vector<ParameterLine> lines, dealii::ParameterHandler &prm, const Origin origin)
  {
    const auto                 values = parameter_values(lines);
    std::vector<NamedSections> named;
    add_parameters(prm, [&](const std::string &kind, const std::string &list, const std::string &by_default) {
      named.push_back({kind, list, names_in(values, list, by_default)});
      if (kind == "Objective")
        check_objective_names(values, named.back().names);
      return named.back().names;
    });
    for (const auto &[kind, list, names] : named)
      for (const std::string &section : unlisted_sections(lines, kind, names))
      {
        lines = without_section(std::move(lines), section);
        without_effect.push_back("section `" + section + "' is not read, as " + list + " does not name it");
      }
    if (origin == Origin::record)
      lines = without_outdated(std::move(lines), prm);
    set_parameters(prm, lines);
  }

  Parameters Parameters::of_lines(const std::string         &file,
                                  std::vector<ParameterLine> lines,
                                  std::string               &echo,
                                  const Origin               origin)
  {
    Parameters               parameters;
    dealii::ParameterHandler prm;
    parameters.assign(std::move(lines), prm, origin);
    rename_files(prm, [&](const std::string &name) { return beside(file, name); });
    parameters.check_all();
    parameters.find_without_effect(declared_parameters(prm));
    echo = text_of(prm);
    return parameters;
  }

  std::string Parameters::seen_from(const std::string                                      &folder,
                                    const std::string                                      &echo,
                                    const std::vector<std::pair<std::string, std::string>> &changes)
  {
    Parameters               parameters;
    dealii::ParameterHandler prm;
    parameters.assign(parameter_lines_of(echo, "parameters"), prm);
    rename_files(prm, [&](const std::string &name) { return name_seen_from(folder, name); });
    set_parameters(prm, override_lines(changes));
    return text_of(prm);
  }
} // namespace retroforge
