// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/solver/saddle_matrix.h>

namespace retroforge
{
  /// Adds to x what makes the residual r vanish in the penalised rows of A, or of A^T, all other unknowns
  /// held: exactly where these rows share no entries, or the system is unsymmetric; else as well as a few
  /// steps of conjugate gradients can. Entries that another rank owns are held, too. Where unsymmetric rows
  /// are singular, x stays as it is.
  /// @param r, x  by local rows of A
  void
  solve_penalised_rows(const SaddleSystem &system, Transposition transposition, const double *r, double *x);
} // namespace retroforge
