// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/base/parameter_handler.h>

namespace retroforge
{
  /// The section Contact.
  struct ContactParameters
  {
    /// The way in which friction and the force on a node set in as the node arrives at a die.
    enum class Arrival
    {
      smooth, ///< over a ramp of the gap
      sharp   ///< decided once per increment
    };

    Arrival law            = Arrival::smooth;
    double  approach       = 1.;
    double  layer          = 0.45;
    double  ramp_width     = 2.;
    double  ramp_at_walls  = 0.05;
    double  penetration    = 3e-7;
    double  penalty        = 0.;
    double  slip_fraction  = 1e-2;
    bool    edges_touch    = true;
    bool    counts_closing = true;
    bool    holds_loose    = true;
    double  edge_sinking   = 0.01;
    double  largest_depth  = 0.05;

    void add_parameters(dealii::ParameterHandler &prm);
    /// @throws Error
    void check() const;
  };
} // namespace retroforge
