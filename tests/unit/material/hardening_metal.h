// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/material/material.h>

namespace retroforge
{
  /// A metal that hardens:  K(q) = K_0 (1 + a q)^n.  It is known to the tests only.
  class HardeningMetal : public MaterialTypeOf<HardeningMetal>
  {
  public:
    static constexpr unsigned int a = 0, n = 1; ///< among Material::numbers

    std::vector<NumberInfo> info() const override { return {{"a", "", true}, {"n", "", false, 1.}}; }

    template <typename Number>
    MaterialLaw<Number> compute_law(const Material<Number> &metal, const PointState<Number> &state) const
    {
      MaterialLaw<Number> law = metal.law;
      law.K *= power(Number(1. + metal.numbers[a] * state.strain), metal.numbers[n]);
      return law;
    }
  };

  /// Makes the metal known as `hardening`, and returns its number.
  inline unsigned int add_hardening_metal()
  {
    add_material_type("hardening", std::make_unique<HardeningMetal>());
    return find_material_type("hardening", "test");
  }
} // namespace retroforge
