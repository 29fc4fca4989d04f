// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/case.h>
#include <retroforge/output/summary.h>

namespace retroforge
{
  /// What a summary says of the forging: counts, volumes, restarts.
  void summarise_run(const Case &at, const ForgingState &forged, Summary &summary);

  /// Of the objectives.
  /// @param values  of each
  void summarise_objectives(const Case                &at,
                            const ObjectiveTrace      &trace,
                            const ForgingState        &forged,
                            const std::vector<double> &values,
                            Summary                   &summary);

  /// Of the design parameters, with the gradients.
  void summarise_gradients(const Case &at, const std::vector<Judged> &judged, Summary &summary);

  /// Of a check on its way.
  /// @param remaining  directions
  void summarise_check(const std::vector<CheckRow> &rows, unsigned int remaining, Summary &summary);
} // namespace retroforge
