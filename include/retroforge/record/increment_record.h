// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/contact/contact.h>

namespace retroforge
{
  /// A solved stage: bubbles follow from V and P, cell by cell.
  struct SolveRecord
  {
    NodalVectors<double> V;
    std::vector<double>  P;
    std::vector<char>    active; ///< h > 0 of each pair
  };

  /// What the backward pass and a replay need of one increment. Positions follow from X_0 and the velocities.
  struct IncrementRecord
  {
    double                   stroke = 0.; ///< of the leading die at the start [mm]
    double                   step   = 0.; ///< [mm]
    unsigned int             cuts   = 0;  ///< times the step was halved
    std::vector<ContactPair> pairs;
    std::vector<SolveRecord> solves;                                        ///< one per stage of the scheme
    double                   deformation_energy = 0., friction_energy = 0.; ///< of this increment [mJ]
  };
} // namespace retroforge
