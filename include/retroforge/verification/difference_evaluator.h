// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/run/forward_run.h>
#include <retroforge/verification/check.h>

namespace retroforge
{
  /// Makes what evaluates the objectives of a case at other designs: by runs that decide everything anew, by
  /// the recorded decisions, and by the direct method.
  /// @param run  of the case, at its design, which is done; both must live as long
  DifferenceEvaluator make_difference_evaluator(const Case &forging_case, const ForwardRun &run);
} // namespace retroforge
