// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <string>

namespace retroforge
{
  /// Text as it must stand inside a quoted XML attribute.
  inline std::string xml_escaped(const std::string &text)
  {
    std::string escaped;
    for (const char c : text)
      switch (c)
      {
        case '&':
          escaped += "&amp;";
          break;
        case '<':
          escaped += "&lt;";
          break;
        case '>':
          escaped += "&gt;";
          break;
        case '"':
          escaped += "&quot;";
          break;
        default:
          escaped += c;
      }
    return escaped;
  }
} // namespace retroforge
