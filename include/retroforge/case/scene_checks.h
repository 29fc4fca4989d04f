// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/case/parameters.h>
#include <retroforge/contact/die_approach.h>

namespace retroforge
{
  /// Returns the distance below which things touch [mm]: 1e-3 of the cube root of the whole part's volume,
  /// whatever symmetry leaves of it.
  /// @param X  positions of the billet's nodes
  double touching_distance(const TetMesh &billet, const NodalVectors<double> &X);

  /// Returns how deep in a die a billet may begin [mm]: 0.05 of that size.
  double deepest_start(const TetMesh &billet, const NodalVectors<double> &X);

  /// Returns the depth of an overlap up to which the first increment pushes the metal out of a die at rest [mm]: it pushes
  /// nodes; a part of a die that is deeper in the billet than twice what nodes are in it would stay there.
  double deepest_pushed_out(const TetMesh              &billet,
                            const NodalVectors<double> &X,
                            const Die                  &die,
                            const Vec3                 &displacement,
                            const Overlap              &overlap);

  /// What of a die stands in the billet, or the billet in it, and how deep.
  std::string standing_inside(const Overlap &overlap);

  /// Way of a die over the stroke [mm].
  Vec3 path(const Parameters &parameters, const Process<double> &process, unsigned int die);

  /// A place as messages have it: (x, y, z).
  std::string in_brackets(const Vec3 &x);

  /// Returns for each die of the first operation its position relative to the billet at the start and its
  /// first contact, for the billet as its measures define it, whatever its mesh.
  /// @param X  positions of the billet's nodes
  std::vector<DieApproach> find_approaches(const Parameters           &parameters,
                                           const Scene                &scene,
                                           const Process<double>      &process,
                                           const NodalVectors<double> &X);

  /// Checks whether a forging can come of billet and dies as they stand, before the first increment: sizes
  /// that fit each other, a billet outside of all dies of the first operation, a die that comes against it, a
  /// stroke that ends before planes meet, and no rigid motion left free.
  /// @param X  positions of the billet's nodes
  /// @return a sentence on each thing that is doubtful     @throws Error
  std::vector<std::string> check_scene(const Parameters           &parameters,
                                       const Scene                &scene,
                                       const Process<double>      &process,
                                       const NodalVectors<double> &X);
} // namespace retroforge
