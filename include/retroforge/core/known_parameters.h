// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/parameter_list.h>

#include <deal.II/base/parameter_handler.h>

#include <map>
#include <string>
#include <vector>

namespace retroforge
{
  /// Looks up what a user calls a parameter or subsection, and suggests what was meant where there is no such
  /// name: one within a few typing errors, or the same name in another section.
  class KnownParameters
  {
  public:
    explicit KnownParameters(const dealii::ParameterHandler &prm);

    /// The entry of this path (`Contact/Friction/coefficient`); an old name leads to the present one.
    /// @param where  file and line, for the message     @throws Error if there is none
    const ParameterEntry &entry(const std::string &path, const std::string &where) const;

    /// @throws Error if no entry is declared in this subsection or below it
    void check_section(const std::string &path, const std::string &where) const;

  private:
    std::vector<std::string>              paths_, sections_; // in the order of their declaration
    std::map<std::string, ParameterEntry> entries_;          // by path, old names included
  };
} // namespace retroforge
