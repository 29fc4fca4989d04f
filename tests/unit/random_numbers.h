// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/types.h>

#include <random>
#include <vector>

namespace retroforge
{
  /// Numbers in [-1, 1], the same in every run and on every machine.
  class RandomNumbers
  {
  public:
    double scalar() { return 2. * (generator_() / 4294967295.) - 1.; }
    Vec3   vector() { return Vec3({scalar(), scalar(), scalar()}); }

    std::vector<double> scalars(const std::size_t n)
    {
      std::vector<double> values(n);
      for (double &value : values)
        value = scalar();
      return values;
    }

    NodalVectors<double> vectors(const std::size_t n)
    {
      NodalVectors<double> values(n);
      for (Vec3 &value : values)
        value = vector();
      return values;
    }

  private:
    std::mt19937 generator_{1};
  };
} // namespace retroforge
