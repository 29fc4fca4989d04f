// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/contact/contact_search.h>

#include <algorithm>

/// @file
/// The metal behind a point of contact, for laws of friction that know its flow stress. A point has the mean
/// of the cells behind the surface faces it is of, each face counted once: it depends on no numbering, and in
/// a sector it is that of the whole, where each face stands beside its images.
///
/// The strain rate e that such a law sees is frozen over an increment, so that friction keeps a potential:
///   e^2 = mean of 2/3 D:D,   D = sym grad v,
/// v the nodes' velocity in the increment before, at the positions at the start of this one, linear on each
/// cell. Where it is not known, as in the first increment of an operation, the dies close over the billet:
///   e = |c| / h,   h^2 = 12 (mean of (x·d)^2 - (mean of x·d)^2),   d = c/|c|,
/// c the velocity by which dies close, means over the volume: h is the height of an upright billet, and
/// differentiable of any.
namespace retroforge
{
  /// The cells behind a point, in the order of its faces.
  std::vector<CellIndex>
  cells_behind(const TetMesh &mesh, const Topology &topology, const ContactPoint &point);

  /// Returns e^2 of each pair [1/s^2], 0 where the die's law does not follow it; empty where none does.
  template <typename Number>
  std::vector<Number> surface_rates(const ContactView<Number> &view, const std::vector<ContactPair> &pairs);

  /// Pull-back of surface_rates: adds to the derivatives in positions, in the velocity of the increment before
  /// where it is known, and else in the velocities of the dies.
  /// @param rates_bar  of each pair
  void reverse_surface_rates(const ContactView<double>      &view,
                             const std::vector<ContactPair> &pairs,
                             const std::vector<double>      &rates_bar,
                             NodalVectors<double>           &X_bar,
                             NodalVectors<double>           &velocity_bar,
                             std::vector<DieState<double>>  &dies_bar);
} // namespace retroforge
