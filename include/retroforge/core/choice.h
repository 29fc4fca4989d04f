// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/parameter_list.h>

#include <map>

namespace retroforge
{
  /// The settings that each choice reads of those that not all choices read: `radius` for the shape
  /// `cylinder`. The name of a section stands for all in it.
  using ReadBy = std::map<std::string, std::vector<std::string>>;

  /// Settings that have another value than their default, and that the choice made does not read: a sentence
  /// on each, fit for the console.
  /// @param chooser  the parameter that chooses, `Billet/shape`; the settings stand in its section
  std::vector<std::string> settings_without_effect(const std::vector<ParameterEntry> &entries,
                                                   const std::string                 &chooser,
                                                   const ReadBy                      &read_by);
} // namespace retroforge
