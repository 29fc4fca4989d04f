// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/known_parameters.h>
#include <retroforge/core/nearest_name.h>

#include <algorithm>
#include <utility>

namespace retroforge
{
  namespace
  {
    std::string last_part(const std::string &path)
    {
      return path.substr(path.rfind('/') + 1);
    }

    std::string all_but_last_part(const std::string &path)
    {
      return path.substr(0, path.rfind('/') == std::string::npos ? 0 : path.rfind('/'));
    }

    /// Names directly inside the section that `path` is said to be in.
    std::string siblings(const std::string &path, const std::vector<std::string> &known)
    {
      std::vector<std::string> names;
      for (const std::string &candidate : known)
        if (all_but_last_part(candidate) == all_but_last_part(path))
          names.push_back(last_part(candidate));
      return join(names);
    }

    std::string suggestion(const std::string &path, const std::vector<std::string> &known)
    {
      const std::string name  = last_part(path);
      std::string       meant = nearest_name(path, known, tolerated_edits(name));
      for (const std::string &candidate : known)
        if (meant.empty() && name.size() == last_part(candidate).size() &&
            edit_distance(name, last_part(candidate)) == 0) // right name, wrong section
          meant = candidate;
      return meant;
    }

    [[noreturn]] void throw_unknown(const std::string              &kind,
                                    const std::string              &path,
                                    const std::string              &where,
                                    const std::vector<std::string> &known)
    {
      const std::string section = all_but_last_part(path), names = siblings(path, known),
                        meant = suggestion(path, known);
      const std::string place = section.empty() ? "at the top level" : "in '" + section + "'";
      throw Error(where,
                  "unknown " + kind + " '" + path + "'",
                  names.empty() ? "there is no " + kind + " " + place : "known " + place + ": " + names,
                  meant.empty() ? "retroforge --print-parameters lists all"
                                : "did you mean '" + meant + "'?");
    }
  } // namespace

  KnownParameters::KnownParameters(const dealii::ParameterHandler &prm)
  {
    for (ParameterEntry &entry : declared_parameters(prm))
    {
      if (entry.alias_of.empty())
        paths_.push_back(entry.path());
      for (std::vector<std::string> sections = entry.sections; !sections.empty(); sections.pop_back())
        if (const std::string path = parameter_path(sections);
            std::find(sections_.begin(), sections_.end(), path) == sections_.end())
          sections_.push_back(path);
      entries_.emplace(entry.path(), std::move(entry));
    }
  }

  const ParameterEntry &KnownParameters::entry(const std::string &path, const std::string &where) const
  {
    const auto found = entries_.find(path);
    if (found == entries_.end())
      throw_unknown("parameter", path, where, paths_);
    const ParameterEntry &entry = found->second;
    return entry.alias_of.empty() ? entry : entries_.at(parameter_path(entry.sections, entry.alias_of));
  }

  void KnownParameters::check_section(const std::string &path, const std::string &where) const
  {
    if (std::find(sections_.begin(), sections_.end(), path) == sections_.end())
      throw_unknown("subsection", path, where, sections_);
  }
} // namespace retroforge
