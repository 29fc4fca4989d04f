// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/solver/equilibrium.h>

namespace retroforge
{
  /// Takes derivatives of single contact nodes, and hands them on to unknowns, positions, contact data and
  /// physics.
  class ContactPullback
  {
  public:
    ContactPullback(const EquilibriumView<double> &view, EquilibriumBar &bar);

    /// Derivatives of a scalar in what contact_node(p) returned.
    void add(unsigned int p, const ContactNodeBar &node_bar);

    /// Adds the derivatives at fixed velocities: none in the unknowns.
    void add_at_fixed_velocity(unsigned int p, const ContactNodeBar &node_bar);

    /// Passes the areas' derivatives on to the positions. Once, at the end.
    void finish();

  private:
    const EquilibriumView<double> &view_;
    EquilibriumBar                &bar_;
    ContactAreas<double>           areas_bar_;
  };
} // namespace retroforge
