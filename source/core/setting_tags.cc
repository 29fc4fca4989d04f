// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/setting_tags.h>

namespace retroforge
{
  namespace
  {
    /// `Die NAME/point' becomes `Die */point'.
    std::string of_any_name(const std::string &path)
    {
      const std::size_t blank = path.find(' '), slash = path.find('/');
      if (blank == std::string::npos || blank > slash)
        return path;
      return path.substr(0, blank) + " *" + (slash == std::string::npos ? "" : path.substr(slash));
    }

    /// The tag of a path as it is, or of one that stands for all names.
    template <typename Tag>
    const Tag *find(const std::map<std::string, Tag> &tags, const std::string &path)
    {
      auto found = tags.find(path);
      if (found == tags.end())
        found = tags.find(of_any_name(path));
      return found == tags.end() ? nullptr : &found->second;
    }

    SettingTags *tags_in(dealii::ParameterHandler &prm)
    {
      auto *tagged = dynamic_cast<TaggedHandler *>(&prm);
      return tagged == nullptr ? nullptr : &tagged->tags;
    }
  } // namespace

  std::optional<SettingRole> SettingTags::role(const std::string &path) const
  {
    if (const SettingRole *of_setting = find(roles, path))
      return *of_setting;
    if (const SettingRole *of_section = find(roles, path.substr(0, path.find('/'))))
      return *of_section;
    return {};
  }

  SettingTags::Files SettingTags::files(const std::string &path) const
  {
    const Files *found = find(named_files, path);
    return found == nullptr ? Files::none : *found;
  }

  const ReadBy *SettingTags::choice(const std::string &path) const
  {
    return find(choices, path);
  }

  void tag(dealii::ParameterHandler &prm, const std::string &path, const SettingRole role)
  {
    if (SettingTags *tags = tags_in(prm))
      tags->roles[path] = role;
  }

  void tag(dealii::ParameterHandler &prm, const std::string &path, const SettingTags::Files files)
  {
    if (SettingTags *tags = tags_in(prm))
      tags->named_files[path] = files;
  }

  void tag(dealii::ParameterHandler &prm, const std::string &path, const ReadBy &read_by)
  {
    if (SettingTags *tags = tags_in(prm))
      tags->choices[path] = read_by;
  }
} // namespace retroforge
