// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/contact/contact_kinematics.h>
#include <retroforge/remeshing/position_tape.h>
#include <retroforge/transfer/transfer.h>

#include <memory>
#include <optional>
#include <string>

namespace retroforge
{
  /// A solved stage: bubbles follow from V and P, cell by cell.
  struct SolveRecord
  {
    NodalVectors<double> V; ///< of velocity nodes
    std::vector<double>  P;
    std::vector<char>    active; ///< h > 0 of each pair
    /// The velocities of the nodes of the mesh, where they do not move with V.
    std::optional<NodalVectors<double>> vertices = {};

    /// Of the nodes of the mesh.
    const NodalVectors<double> &motion() const { return vertices ? *vertices : V; }
  };

  /// A change of mesh between two increments.
  struct RemeshRecord
  {
    NodalVectors<double> X_before; ///< positions on the old mesh [mm]
    TetMesh              mesh;     ///< the new one; its X are the positions after
    TransferOperator     transfer;
    PositionTape         positions;           ///< how the new ones follow from the old ones and the dies
    double               removed_volume = 0.; ///< metal thinner than an element taken away [mm^3]
  };

  /// What the backward pass and a replay need of one increment. Positions follow from X_0 and the velocities.
  struct IncrementRecord
  {
    double energy() const { return deformation_energy + friction_energy + closing_energy; } // [mJ]

    unsigned int operation = 0;
    double       stroke    = 0.; ///< of the leading die in the operation, at the start [mm]
    double       step      = 0.; ///< [mm]
    unsigned int cuts      = 0;  ///< times the step was halved
    /// The complete input, where other settings hold from this increment on.
    std::optional<std::string> parameters;
    /// Made just before the increment; null when it goes on with the mesh there was.
    std::shared_ptr<const RemeshRecord> remesh;
    std::string                         scheme; ///< in time, by its name
    ContactNumerics                     contact;
    std::vector<ContactPair>            pairs;
    RigidHold                           hold;   ///< of what the pairs leave loose
    std::vector<SolveRecord>            solves; ///< one per stage of the scheme
    /// Spent in this increment [mJ]; the last one is what deformation and friction of the stages lack where
    /// gaps close (spent_power.h).
    double deformation_energy = 0., friction_energy = 0., closing_energy = 0.;
    /// Told, and of no use to the backward pass: work of the dies on gaps that close [mJ], what the hold bears,
    /// force of each die on the workpiece [N], iterations.
    double            closing_work = 0.;
    HoldLoad          hold_load;
    std::vector<Vec3> forces;
    unsigned int      newton = 0, krylov = 0, linear_solves = 0;
  };
} // namespace retroforge
