// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/parameter_list.h>

#include <deal.II/base/parameter_handler.h>

#include <string>
#include <utility>
#include <vector>

namespace retroforge
{
  /// Give `prm` the values of the parameter file, then those of `overrides` (path and value, the last one
  /// counts). Variables bound by add_parameter() are updated. `prm` must be at its top level.
  ///
  /// The format is deal.II's: `subsection NAME`, `end`, `set NAME = VALUE`, `include FILE` (relative to the
  /// file it stands in), comments from `#` on, lines continued after a final backslash. Stricter in one
  /// respect: to set a parameter twice in the same file is an error.
  ///
  /// Nothing is printed, and `prm` is unchanged unless all names are known and the sections are balanced.
  /// @throws Error with file and line for unknown names (and the nearest known one), values the declared
  /// pattern does not allow, unbalanced sections, missing required parameters, unreadable files.
  void read_parameters(dealii::ParameterHandler                               &prm,
                       const std::string                                      &file,
                       const std::vector<std::pair<std::string, std::string>> &overrides = {});

} // namespace retroforge
