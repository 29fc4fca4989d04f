// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/solver/equilibrium.h>

namespace retroforge
{
  /// Returns whether contact pair p is one of a die's, at a point of this rank.
  template <typename Number>
  bool is_of_die(const EquilibriumView<Number> &view, const unsigned int p, const unsigned int die)
  {
    const ContactPair &pair = view.stage.contact.pairs[p];
    return pair.die == die && view.stage.scene.discretization.owns(pair.point.nodes[0]);
  }
} // namespace retroforge
