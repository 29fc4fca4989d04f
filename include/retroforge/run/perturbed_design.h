// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/adjoint/objective_sensitivity.h>
#include <retroforge/run/forward_run.h>

namespace retroforge
{
  /// Returns the process at design parameters mu, with the vertices of its dies moved by `shift` from there.
  /// Of dual numbers, `shift` is the derivative of that motion.
  template <typename Number>
  Process<Number>
  process_at(const Case &forging_case, const std::vector<Number> &mu, const ShapePerturbation &shift);

  /// Returns the initial positions of the billet's nodes, moved in the same way [mm].
  template <typename Number>
  NodalVectors<Number>
  positions_at(const Case &forging_case, const std::vector<Number> &mu, const ShapePerturbation &shift);

  /// Returns the derivatives of the combined objectives along (mu_dot, shift_dot) at the case's design, by
  /// one tangent sweep (the direct method) along a run that is done.
  std::vector<double> directional_derivatives(const Case                &forging_case,
                                              const ForwardRun          &run,
                                              const std::vector<double> &mu_dot,
                                              const ShapePerturbation   &shift_dot);
} // namespace retroforge
