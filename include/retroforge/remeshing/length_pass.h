// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/remeshing/remeshing_context.h>
#include <retroforge/remeshing/remeshing_report.h>

namespace retroforge
{
  /// Brings edges to the wanted length: those too short are collapsed, shortest first, then those too long
  /// are split, longest first, and so for those that come; until nothing changes. Done before quality is
  /// looked at: bad cells are mostly squeezed or stretched ones, and repairing them by smoothing would move
  /// every node around.
  void length_pass(RemeshingContext &context, RemeshingReport &report);
} // namespace retroforge
