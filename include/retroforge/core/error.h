// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <stdexcept>
#include <string>

namespace retroforge
{
  /// The one exception a user can cause. Its message has four parts:
  /// where (parameter path, file, node), what was found, the rule it breaks, and what to do.
  /// Printed as  `where: what; rule; remedy`.
  class Error : public std::runtime_error
  {
  public:
    Error(const std::string &where,
          const std::string &what,
          const std::string &rule,
          const std::string &remedy)
        : std::runtime_error(where + ": " + what + "; " + rule + "; " + remedy)
    {
    }
  };
} // namespace retroforge
