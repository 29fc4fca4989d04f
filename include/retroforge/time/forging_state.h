// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/time/mesh_epoch.h>

#include <optional>

namespace retroforge
{
  /// Velocities and pressures of the last stage of an increment, on all ranks.
  struct LastSolution
  {
    NodalVectors<double> V; ///< of velocity nodes but bubbles [mm/s]
    std::vector<double>  P; ///< [MPa]
  };

  /// Where a run stands between two increments.
  struct ForgingState
  {
    std::shared_ptr<MeshEpoch>  epoch;
    WorkpieceState<3, double>   workpiece;
    std::optional<LastSolution> solution; ///< of the last increment, none before the first
    InitialGuess                next;     ///< where the next increment starts
    unsigned int                operation      = 0;
    double                      stroke         = 0.; ///< of the operation [mm]
    double                      volume         = 0.; ///< at the start of the run [mm^3]
    double                      removed_volume = 0.; ///< metal thinner than an element taken away [mm^3]
    unsigned int                depth          = 0;  ///< an increment is the whole one / 2^depth
    double slip        = 0.; ///< of the last increment: largest one along a curved die, in edges [mm^-1]
    double strain_rate = 0.; ///< of the last increment: mean strain where metal flows [mm^-1]

    /// Where the present numerics began to hold: stroke [mm] and increments before.
    double                     numerics_stroke     = 0.;
    unsigned int               numerics_increments = 0;
    std::optional<std::string> parameters; ///< the complete input, to be recorded with the next increment

    EnergyParts<double>       energy;
    unsigned int              increments = 0, cuts = 0, newton = 0, krylov = 0, linear_solves = 0;
    std::vector<unsigned int> remeshed; ///< the increments, from 0, that began on a new mesh

    /// What the way back needs of the workpiece and does not find in the record, without its motion: at each
    /// change of mesh, on the mesh it left; and of each increment, where its steps read it.
    std::vector<WorkpieceState<3, double>> left_behind;
    std::vector<IncrementMemory>           remembered;
  };
} // namespace retroforge
