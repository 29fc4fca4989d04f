// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/base/parameter_handler.h>

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace retroforge
{
  /// A line of a parameter file, or an option of the command line, that sets a parameter or opens a section.
  struct ParameterLine
  {
    std::string                where;              ///< file and line
    std::string                path;               ///< path of the parameter or section, as written
    std::optional<std::string> value;              ///< none where a section is opened
    unsigned int               file = 0, line = 0; ///< number of the file among those read, and of the line
  };

  /// All such lines of a parameter file and what it includes, then `overrides` (path and value). Whether
  /// there are parameters of these names is not asked.
  ///
  /// The format is deal.II's: `subsection NAME`, `end`, `set NAME = VALUE`, `include FILE` (relative to the
  /// file it stands in), comments from `#` on, lines continued after a final backslash. Keywords are in upper
  /// or lower case, lines end as on any system, and a byte order mark is passed over.
  /// @throws Error with file and line for unbalanced sections, lines that are none of these, unreadable files
  std::vector<ParameterLine>
  read_parameter_lines(const std::string                                      &file,
                       const std::vector<std::pair<std::string, std::string>> &overrides = {});

  /// The same of a text that includes no files. @param name  of the text, for messages
  std::vector<ParameterLine> parameter_lines_of(const std::string &text, const std::string &name);

  /// Lines that set what is given as path and value.
  /// @throws Error for text that no parameter file may hold
  std::vector<ParameterLine>
  override_lines(const std::vector<std::pair<std::string, std::string>> &overrides);

  /// Values by path; of several lines that set a parameter the last counts.
  std::map<std::string, std::string> parameter_values(const std::vector<ParameterLine> &lines);

  /// Give `prm` the values of these lines, the last one counts. Variables bound by add_parameter() are
  /// updated. `prm` must be at its top level. To set a parameter twice in the same file is an error.
  ///
  /// Nothing is printed, and `prm` is unchanged unless all names are known.
  /// @throws Error with file and line for unknown names (and the nearest known one), values the declared
  /// pattern does not allow, missing required parameters
  void set_parameters(dealii::ParameterHandler &prm, const std::vector<ParameterLine> &lines);

  /// read_parameter_lines() and set_parameters().
  void read_parameters(dealii::ParameterHandler                               &prm,
                       const std::string                                      &file,
                       const std::vector<std::pair<std::string, std::string>> &overrides = {});

} // namespace retroforge
