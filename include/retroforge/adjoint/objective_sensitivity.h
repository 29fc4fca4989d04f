// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/types.h>

#include <string>
#include <vector>

namespace retroforge
{
  /// A perturbation of the shape beyond design parameters: of every node of the billet, every vertex of the
  /// dies [mm].
  struct ShapePerturbation
  {
    NodalVectors<double>              X_0;
    std::vector<NodalVectors<double>> dies; ///< of each die; empty: at rest
  };

  /// An objective's value, and its gradient as the backward sweep has it.
  struct ObjectiveSensitivity
  {
    std::string         name, unit;
    double              value;
    std::vector<double> gradient; ///< one per parameter
    ShapePerturbation   shape;    ///< derivatives in nodes and vertices
    /// How far each derivative holds, in words (run/slope_trust.h); empty where that is not known.
    std::vector<std::string> trust = {};
  };
} // namespace retroforge
