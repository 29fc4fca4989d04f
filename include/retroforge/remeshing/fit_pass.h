// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/remeshing/remeshing_context.h>

namespace retroforge
{
  /// Brings boundary nodes from `first` on to their places on the old surface, out of the dies, where nodes
  /// behind them were in the way: each goes as far as the cells let it, then its neighbours are moved to
  /// where the cells are best, which is away from it, and again; if that does not do, the neighbour next to
  /// its place is collapsed. Returns those that do not arrive: contact would throw out a node inside a die.
  std::vector<NodeIndex> fit_pass(RemeshingContext &context, NodeIndex first);
} // namespace retroforge
