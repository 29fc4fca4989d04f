// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/contact/contact_kinematics.h>

#include <vector>

/// @file
/// Edges of the surface into which a die bulges, whose middles m are points of contact without a velocity of their own: how
/// they let their ends touch. The bulge of the die into the edge (a, b),
///   b_m = (delta_a + delta_b)/2 - delta_m,
/// says how much of it the edge is.
namespace retroforge
{
  /// Lets nodes touch where edges touch in their place: contact.touched_by_edges and contact.ramps, of which each is that
  /// of the point alone before.
  template <typename Number>
  void let_edges_touch(const Topology &topology, const FrictionRamp &ramp, ContactSet<Number> &contact);

  /// Makes the derivatives in the ramps those in the points' own, and adds those in gaps and scales.
  void reverse_edges_touch(const ContactSet<double> &contact,
                           const FrictionRamp       &ramp,
                           std::vector<double>      &ramps_bar,
                           std::vector<double>      &gaps_bar,
                           std::vector<double>      &scales_bar);
} // namespace retroforge
