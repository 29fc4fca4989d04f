// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/material/material_law.h>

#include <algorithm>
#include <array>

namespace retroforge
{
  /// Four cells at once, one per lane of a vector register: what the assembly of the whole matrix uses.
  typedef double                Pack __attribute__((vector_size(32)));
  inline constexpr unsigned int n_lanes = 4;

  /// The laws of the cells of a pack, one per lane.
  using LaneLaws = std::array<MaterialLaw<double>, n_lanes>;

  /// Tells whether all of a pack are linear. Where only some are, their slopes vanish by themselves.
  inline bool is_linear(const LaneLaws &laws)
  {
    return std::all_of(
      laws.begin(), laws.end(), [](const MaterialLaw<double> &law) { return law.is_linear(); });
  }

  inline bool is_linear(const MaterialLaw<double> &law)
  {
    return law.is_linear();
  }

  /// The linearisation of the stresses: their derivative (Newton), or the viscosity at the strain rates of w
  /// alone (Picard). Both leave the solution where it is; Newton is the faster one close to it.
  enum class Linearisation
  {
    newton,
    picard
  };
} // namespace retroforge
