// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/base/parameter_handler.h>

#include <iosfwd>
#include <string>
#include <utility>
#include <vector>

namespace retroforge
{
  /// One declared parameter, as the user sees it.
  struct ParameterEntry
  {
    std::vector<std::string> sections; ///< from the outermost inwards
    std::string              name;
    std::string              value;
    std::string              default_value;
    std::string              documentation;
    std::string              allowed; ///< in plain words: "a number >= 0"
    std::string alias_of; ///< name, in the same sections, of the entry this is an old name of; else empty

    /// `Contact/Friction/coefficient`
    std::string path() const;
  };

  /// All declared parameters, in the order of their declaration.
  std::vector<ParameterEntry> declared_parameters(const dealii::ParameterHandler &prm);

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

  /// Write all parameters with their present values, meaning, allowed values and defaults, as a file that
  /// read_parameters() accepts.
  void print_parameters(const dealii::ParameterHandler &prm, std::ostream &out);
} // namespace retroforge
