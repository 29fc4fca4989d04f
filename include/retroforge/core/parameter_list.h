// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/base/parameter_handler.h>

#include <iosfwd>
#include <string>
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

  /// Sections and name joined by '/'; without a name, the path of the innermost section.
  std::string parameter_path(const std::vector<std::string> &sections, const std::string &name = "");

  /// All declared parameters, in the order of their declaration.
  std::vector<ParameterEntry> declared_parameters(const dealii::ParameterHandler &prm);

  /// Write all parameters with their present values, meaning, allowed values and defaults, as a file that
  /// read_parameters() accepts.
  void print_parameters(const dealii::ParameterHandler &prm, std::ostream &out);
} // namespace retroforge
