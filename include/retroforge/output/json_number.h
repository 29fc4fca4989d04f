// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <nlohmann/json.hpp>

#include <cmath>

namespace retroforge
{
  /// Returns a number as a JSON file has it: null where it is not finite, for which JSON has no word.
  template <typename Json = nlohmann::ordered_json>
  Json json_number(const double x)
  {
    return std::isfinite(x) ? Json(x) : Json();
  }
} // namespace retroforge
