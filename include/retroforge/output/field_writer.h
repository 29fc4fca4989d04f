// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/output/pvd_writer.h>
#include <retroforge/time/forging.h>

namespace retroforge
{
  /// The shapes of a run with their fields, for ParaView: fields.pvd and fields_NNNNNN.vtu, from the billet
  /// on, and failed.vtu where it failed.
  class FieldWriter
  {
  public:
    /// What is passed must live as long.
    FieldWriter(const std::string          &directory,
                const ForgingModel         &model,
                const Process<double>      &process,
                const TetMesh              &billet,
                const NodalVectors<double> &X_0);

    /// The end of an increment, with what its last stage found.
    void add(const IncrementEvent &event);

    /// The workpiece where the run failed, with the fields of the last equilibrium.
    void add_failed(const ForgingState &state);

  private:
    void add_billet();

    std::string                 directory_;
    const ForgingModel         &model_;
    const Process<double>      &process_;
    const TetMesh              &billet_;
    const NodalVectors<double> &X_0_;
    PvdWriter                   pvd_;
  };
} // namespace retroforge
