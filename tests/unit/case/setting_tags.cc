// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
//
// What the rooms say of their settings: every section has a role, and the settings that differ from their
// section are listed, as are files and choices. A setting whose role is wrong lets a run go on with another
// scene, or refuses one that may go on: the list below is what a reader checks by hand.

#include <retroforge/case/parameters.h>

#include <iostream>

using namespace retroforge;

namespace
{
  std::string in_words(const std::optional<SettingRole> &role)
  {
    if (!role)
      return "NONE";
    switch (*role)
    {
      case SettingRole::scene:
        return "scene";
      case SettingRole::numerics:
        return "numerics";
      case SettingRole::results:
        return "results";
      case SettingRole::check:
        return "check";
      default:
        return "report";
    }
  }
} // namespace

int main()
{
  const SettingTags       &tags = Parameters::tags();
  dealii::ParameterHandler prm;
  Parameters               parameters;
  parameters.add_parameters(prm, [](const std::string &kind, const std::string &, const std::string &) {
    return std::vector<std::string>{kind == "Die" ? "upper" : "energy"};
  });
  std::string section;
  for (const ParameterEntry &entry : declared_parameters(prm))
  {
    if (entry.sections.front() != section)
    {
      section = entry.sections.front();
      std::cout << section << ": " << in_words(tags.role(section)) << '\n';
    }
    const std::string path = entry.path();
    if (tags.role(path) != tags.role(section))
      std::cout << "  " << entry.name << ": " << in_words(tags.role(path)) << '\n';
    if (const auto files = tags.files(path); files != SettingTags::Files::none)
      std::cout << "  " << entry.name << " names " << (files == SettingTags::Files::one ? "a file" : "files")
                << '\n';
    if (const ReadBy *read_by = tags.choice(path))
      std::cout << "  " << entry.name << " chooses among " << read_by->size() << '\n';
  }
  std::cout << "of a record: Die lower/point: " << in_words(tags.role("Die lower/point"))
            << ", Scan/one of before: " << in_words(tags.role("Scan/one of before"))
            << ", Unknown/setting: " << in_words(tags.role("Unknown/setting")) << '\n';
}
