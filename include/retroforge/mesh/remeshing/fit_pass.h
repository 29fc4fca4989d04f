// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/remeshing/remeshing_context.h>
#include <retroforge/mesh/remeshing/remeshing_report.h>

namespace retroforge
{
  /// Brings boundary nodes from `first` on to their places on the old surface, out of the dies, where nodes
  /// behind them were in the way: each goes as far as the cells let it, then its neighbours are moved to
  /// where the cells are best, which is away from it, and again. Counts in the report those that do not
  /// arrive.
  void fit_pass(RemeshingContext &context, NodeIndex first, RemeshingReport &report);
} // namespace retroforge
