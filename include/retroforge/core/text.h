// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <cctype>
#include <sstream>
#include <string>

namespace retroforge
{
  /// A number for a message, to six digits: 1e-06 where std::to_string() says 0.000001, and less says
  /// nothing.
  inline std::string as_text(const double x)
  {
    std::ostringstream text;
    text << x;
    return text.str();
  }

  /// Returns a name with underscores for all but letters and digits, as for a field or a folder.
  inline std::string as_identifier(std::string name)
  {
    for (char &c : name)
      if (std::isalnum(static_cast<unsigned char>(c)) == 0)
        c = '_';
    return name;
  }
} // namespace retroforge
