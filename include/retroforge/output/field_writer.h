// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/output/pvd_writer.h>
#include <retroforge/time/forging.h>

namespace retroforge
{
  /// The shapes of a run with their fields and the dies beside them, for ParaView: fields.pvd with
  /// fields_NNNNNN.vtu and die_NAME_NNNNNN.vtu, from the billet on, and failed.vtu where it failed.
  /// doc/fields.md says what the fields are.
  class FieldWriter
  {
  public:
    /// What is passed must live as long.
    FieldWriter(const std::string          &directory,
                const ForgingModel         &model,
                const Process<double>      &process,
                const TetMesh              &billet,
                const NodalVectors<double> &X_0);

    /// To be told of every increment, written or not: displacements add up, and are carried through
    /// remeshings as other nodal values are.
    void follow(const IncrementEvent &event);

    /// The end of the increment followed last, with what its last stage found.
    void add(const IncrementEvent &event);

    /// The workpiece where the run failed, with the fields of the last equilibrium.
    void add_failed(const ForgingState &state);

  private:
    struct Workpiece;

    void add_billet();
    void write(const std::string &file, const Workpiece &workpiece) const;
    /// @param suffix  of the file's name
    /// @param X       of the workpiece, which the picture of a plane covers
    PvdWriter::Part
    write_die(unsigned int d, double stroke, const std::string &suffix, const NodalVectors<double> &X) const;
    void add_step(double                      stroke,
                  const std::string          &file,
                  const std::string          &suffix,
                  const NodalVectors<double> &X);

    std::string                 directory_;
    const ForgingModel         &model_;
    const Process<double>      &process_;
    const TetMesh              &billet_;
    const NodalVectors<double> &X_0_;
    NodalVectors<double>        displacement_;     ///< since the billet [mm]
    std::size_t                 n_remeshings_ = 0; ///< that it has been carried through
    PvdWriter                   pvd_;
  };
} // namespace retroforge
