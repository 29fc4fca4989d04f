// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/material/norton_hoff.h>

namespace retroforge
{
  /// The law of the metal: isotropic and viscous,  s = factor(eps:eps) eps. All kernels know it by this name,
  /// and need of a law what NortonHoff has: an aggregate of numbers (core/numbers.h) whose call operator is
  /// the factor, with is_linear(), potential_ratio(), slope(), reverse(), shear_stress() with its reverse, newtonian(), and for users info()
  /// and depends_on().
  template <typename Number>
  using MaterialLaw = NortonHoff<Number>;
} // namespace retroforge
