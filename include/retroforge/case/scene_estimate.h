// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/case/case.h>

namespace retroforge
{
  /// Estimates of a forging, to a factor of two and without solving anything.
  ///
  /// Forces are those of the slab method on a disc of the billet's volume V between flat dies, of the whole
  /// part:  F = A (sigma + sum over the faces of tau R / ((m + 3) h)),  A = V/h,  R^2 = A/pi,  with the
  /// traction of Norton friction at the rim, tau = alpha K (e R/2)^m, and at most that of sticking,
  /// sigma/sqrt3. At m = 0 it is Siebel's  F = A sigma (1 + mu d/(3 h)). What a bore or a cavity holds
  /// together takes several times that.
  struct SceneEstimate
  {
    double speed  = 0.; ///< at which the dies close, in the direction in which they face the billet [mm/s]
    double height = 0.; ///< height of the model in that direction [mm]
    double strain_rate = 0.; ///< e = speed / height [1/s]
    double flow_stress = 0.; ///< sigma, of the law at that rate [MPa]
    double first_force = 0.; ///< force where the dies first press [N]
    double final_force = 0.; ///< at the height that the dies leave it, if the metal is free to spread [N]

    /// A sentence on each quantity out of all proportion, which begins with the name of the setting.
    std::vector<std::string> warnings;
  };

  /// Estimates a sound scene (check_scene), before its first increment.
  /// @param X  positions of the billet's nodes
  SceneEstimate estimate_scene(const Parameters           &parameters,
                               const Scene                &scene,
                               const Process<double>      &process,
                               const NodalVectors<double> &X);

  /// Estimates a case as it begins. Collective.
  SceneEstimate estimate_scene(const Case &forging_case);
} // namespace retroforge
