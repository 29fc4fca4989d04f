// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

namespace retroforge
{
  /// Four cells at once, one per lane of a vector register: what the assembly of the whole matrix uses.
  typedef double                Pack __attribute__((vector_size(32)));
  inline constexpr unsigned int n_lanes = 4;

  /// What stands for the derivative of the stresses: the derivative, or (Picard) the viscosity at the strain
  /// rates of w alone. Both leave the solution where it is; Newton is the faster one close to it.
  enum class Linearisation
  {
    newton,
    picard
  };
} // namespace retroforge
