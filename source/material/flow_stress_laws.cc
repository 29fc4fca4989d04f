// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/material/flow_stress_laws.h>

namespace retroforge
{
  namespace
  {
    /// A number of any sign that is 0 where it is not given.
    NumberInfo coefficient(const std::string &name, const std::string &unit)
    {
      NumberInfo number{name, unit};
      number.otherwise = 0.;
      number.any_sign  = true;
      return number;
    }

    NumberInfo
    positive(const std::string &name, const std::string &unit, const std::optional<double> otherwise)
    {
      NumberInfo number{name, unit};
      number.otherwise = otherwise;
      return number;
    }
  } // namespace

  std::vector<NumberInfo> PowerMetal::info() const
  {
    return {coefficient("n", ""),
            positive("q0", "", 1e-3),
            coefficient("beta", "1/C"),
            coefficient("m1", "1/C"),
            [] {
              NumberInfo T0 = coefficient("T0", "C");
              T0.otherwise  = 20.;
              return T0;
            }()};
  }

  std::vector<NumberInfo> HanselSpittelMetal::info() const
  {
    return {positive("A", "MPa s^m", {}),
            coefficient("m1", "1/C"),
            coefficient("m2", ""),
            coefficient("m3", ""),
            coefficient("m4", ""),
            coefficient("m5", "1/C"),
            coefficient("m6", ""),
            coefficient("m7", ""),
            coefficient("m8", "1/C"),
            coefficient("m9", ""),
            positive("q0", "", 0.02)};
  }

  std::vector<NumberInfo> TableMetal::info() const
  {
    return {positive("factor", "", 1.)};
  }
} // namespace retroforge
