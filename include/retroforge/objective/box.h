// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/types.h>

#include <utility>

namespace retroforge
{
  /// Lower and upper corner of a box; points on its faces are inside.
  using Box = std::pair<Vec3, Vec3>;

  inline bool is_inside(const Box &box, const Vec3 &x)
  {
    for (unsigned int i = 0; i < 3; ++i)
      if (x[i] < box.first[i] || x[i] > box.second[i])
        return false;
    return true;
  }
} // namespace retroforge
