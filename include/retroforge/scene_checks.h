// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/contact/die_approach.h>
#include <retroforge/parameters.h>

namespace retroforge
{
  /// What lies nearer than this touches [mm]: by the whole part, whatever symmetry leaves of it.
  /// @param X  positions of the billet's nodes
  double touching_distance(const Scene &scene, const NodalVectors<double> &X);

  /// How each die stands to the billet at the start, and what becomes of it: of the billet as its measures
  /// give it, whatever its mesh.
  /// @param X  positions of the billet's nodes
  std::vector<DieApproach> find_approaches(const Parameters           &parameters,
                                           const Scene                &scene,
                                           const Process<double>      &process,
                                           const NodalVectors<double> &X);

  /// Whether a forging can come of billet and dies as they stand, before the first increment: sizes that fit
  /// each other, a billet outside of all dies, a die that comes against it, a stroke that ends before planes
  /// meet, and no rigid motion left free.
  /// @param X  positions of the billet's nodes
  /// @return a sentence on each thing that is doubtful     @throws Error
  std::vector<std::string> check_scene(const Parameters           &parameters,
                                       const Scene                &scene,
                                       const Process<double>      &process,
                                       const NodalVectors<double> &X);
} // namespace retroforge
