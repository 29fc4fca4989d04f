// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/choice.h>
#include <retroforge/core/nearest_name.h>

#include <algorithm>

namespace retroforge
{
  namespace
  {
    bool is_among(const std::string &setting, const std::vector<std::string> &names)
    {
      return std::any_of(names.begin(), names.end(), [&](const std::string &name) {
        return setting == name || setting.rfind(name + "/", 0) == 0;
      });
    }

    bool is_read_by_some(const std::string &setting, const ReadBy &read_by)
    {
      return std::any_of(
        read_by.begin(), read_by.end(), [&](const auto &choice) { return is_among(setting, choice.second); });
    }
  } // namespace

  std::vector<std::string> settings_without_effect(const std::vector<ParameterEntry> &entries,
                                                   const std::string                 &chooser,
                                                   const ReadBy                      &read_by)
  {
    const std::string section = chooser.substr(0, chooser.rfind('/') + 1);
    const auto        choice  = std::find_if(
      entries.begin(), entries.end(), [&](const ParameterEntry &entry) { return entry.path() == chooser; });
    const auto                     found = read_by.find(choice->value);
    const std::vector<std::string> read = found == read_by.end() ? std::vector<std::string>() : found->second;
    std::vector<std::string>       sentences;
    for (const ParameterEntry &entry : entries)
      if (entry.path().rfind(section, 0) == 0 && entry.value != entry.default_value)
        if (const std::string setting = entry.path().substr(section.size());
            is_read_by_some(setting, read_by) && !is_among(setting, read))
          sentences.push_back(entry.path() + " = " + entry.value + " has no effect: " + choice->name + " = " +
                              choice->value + " reads " +
                              (read.empty() ? "no settings of its own" : join(read)));
    return sentences;
  }
} // namespace retroforge
