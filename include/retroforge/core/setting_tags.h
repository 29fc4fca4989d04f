// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/choice.h>

#include <map>
#include <optional>
#include <string>

namespace retroforge
{
  /// The role of a setting.
  enum class SettingRole
  {
    scene,    ///< the forging itself: a run that goes on keeps it
    numerics, ///< the solution of the equations, and their increments and meshes
    results,  ///< evaluations of a forging: objectives and their derivatives
    check,    ///< the check of derivatives
    report    ///< output and the choice of runs: no number of a run depends on it
  };

  /// The tags that the rooms give their settings where they declare them, by path (`Contact/layer`). Of
  /// sections that stand once for each name, as `Die NAME`, the tags are those of the name `*`.
  class SettingTags
  {
  public:
    enum class Files
    {
      none,
      one,
      list ///< separated by commas
    };

    /// Returns the role of a setting, or else that of its section; nothing where neither has one.
    std::optional<SettingRole> role(const std::string &path) const;
    /// Returns whether the value is the name of a file.
    Files files(const std::string &path) const;
    /// Returns what each value reads of the settings beside it, for one that chooses; null for another.
    const ReadBy *choice(const std::string &path) const;

    std::map<std::string, SettingRole> roles; ///< roles of settings and of sections
    std::map<std::string, Files>       named_files;
    std::map<std::string, ReadBy>      choices;
  };

  /// A handler that keeps the tags of what is declared in it; others take no notice of tags.
  class TaggedHandler : public dealii::ParameterHandler
  {
  public:
    SettingTags tags;
  };

  /// Tags a section or a setting with its role.
  void tag(dealii::ParameterHandler &prm, const std::string &path, SettingRole role);
  /// Tags a setting that names a file, or a list of them.
  void tag(dealii::ParameterHandler &prm, const std::string &path, SettingTags::Files files);
  /// Tags a setting that chooses which of the others in its section are read.
  void tag(dealii::ParameterHandler &prm, const std::string &path, const ReadBy &read_by);
} // namespace retroforge
