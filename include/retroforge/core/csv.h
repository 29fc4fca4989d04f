// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <string>

namespace retroforge
{
  /// `text` as one cell of a CSV file (RFC 4180): in quotes, and its own quotes doubled.
  inline std::string csv_quoted(const std::string &text)
  {
    std::string result = "\"";
    for (const char c : text)
      result += c == '"' ? std::string("\"\"") : std::string(1, c);
    return result + '"';
  }
} // namespace retroforge
