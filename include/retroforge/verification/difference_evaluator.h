// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/adjoint/sweep.h>
#include <retroforge/case/case.h>
#include <retroforge/verification/check.h>

namespace retroforge
{
  /// Makes what evaluates the objectives of a case at other designs: by runs that decide everything anew, by
  /// the recorded decisions, and by the direct method.
  /// @param forging   that was recorded; it and the case must live as long
  DifferenceEvaluator make_difference_evaluator(const Case            &forging_case,
                                                const Forging         &forging,
                                                const RecordedForging &recorded);
} // namespace retroforge
