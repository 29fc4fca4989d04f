// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/text.h>

#include <stdexcept>
#include <string>

namespace retroforge
{
  /// Returns whether the text is valid UTF-8 without control characters; a tab is allowed.
  bool is_plain_text(const std::string &text);

  /// The text fit for one line of a terminal: control characters and what is not UTF-8 become '?', and of
  /// more than 300 bytes the first ones and '...' are left.
  std::string legible(const std::string &text);

  /// The one exception a user can cause. Its message has four parts:
  /// where (parameter path, file, node), what was found, the rule it breaks, and what to do.
  /// Printed as  `where: what; rule; remedy`, on one line: each part is cleaned as by legible(), and cut
  /// where it has more than 2000 bytes.
  class Error : public std::runtime_error
  {
  public:
    Error(const std::string &where,
          const std::string &what,
          const std::string &rule,
          const std::string &remedy);

    /// Returns the error with one more remedy.
    Error or_else(const std::string &remedy) const;

    /// Returns the error of a file with the setting that names it in front.
    Error in_setting(const std::string &setting) const;

  private:
    explicit Error(const std::string &message) : std::runtime_error(message) {}
  };
} // namespace retroforge
