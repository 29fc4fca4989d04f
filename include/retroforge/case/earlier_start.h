// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/case/parameters.h>
#include <retroforge/geometry/die.h>
#include <retroforge/mesh/tet_mesh.h>
#include <retroforge/steps/process.h>

#include <string>
#include <vector>

/// @file
/// A die that touches the nominal billet stands in a higher one. Pushed out at once, the metal would cost no work: energies
/// of designs had a kink there, steeper by the force at first contact on the one side. So the press begins as much earlier as
/// lets the dies that move come to the billet from outside, and ends where it would: designs on both sides differ by a gap.
namespace retroforge
{
  /// How much earlier the first operation begins. A decision: nothing is differentiated by it.
  struct EarlierStart
  {
    double                   path  = 0.; ///< of the leading die, more than its stroke [mm]
    double                   scale = 0.; ///< what its path scale grows by
    std::vector<Vec3>        shifts;     ///< of the dies at the start [mm]
    std::vector<std::string> remarks;    ///< a sentence on each die that would have stood in the billet

    template <typename Number>
    void apply(Process<Number> &process) const
    {
      if (path == 0.)
        return;
      process.operations.front().path_scale += scale;
      for (std::size_t d = 0; d < shifts.size(); ++d)
        for (unsigned int i = 0; i < 3; ++i)
          process.dies[d].displacement[i] += shifts[d][i];
    }
  };

  /// Returns that of a scene. The press does not begin earlier
  /// - where no face of the billet stands in a die by more than touches, nor a part of a die in the billet that pushes
  ///   nodes by less than half its depth;
  /// - where a die at rest stands in the billet, which pushes it out in any case;
  /// - where one of the dies that move stands in a later operation, too, whose place at the start is the same number;
  /// - where a die stands in it by more than a billet may (scene_checks.h), or would have to go back by ten times
  ///   that, as along the wall of a bore.
  /// @param X  positions of the billet's nodes
  EarlierStart earlier_start(const Parameters           &parameters,
                             const TetMesh              &billet,
                             const std::vector<Die>     &dies,
                             const Process<double>      &process,
                             const NodalVectors<double> &X);
} // namespace retroforge
