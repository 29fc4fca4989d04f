// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/output/picture_series.h>
#include <retroforge/time/forging.h>

#include <set>

namespace retroforge
{
  /// The shapes of a run with their fields and the dies beside them, for ParaView: fields.pvd with
  /// fields_NNNNNN.vtu and die_NAME_NNNNNN.vtu, from the billet on, and failed.vtu where it failed.
  /// doc/fields.md says what the fields are. fields.pvd is complete after every call, so a run that is killed
  /// leaves one that opens.
  class FieldWriter
  {
  public:
    /// All arguments must live as long.
    /// @param comm  of the ranks that follow the run, of which the first writes
    FieldWriter(MPI_Comm                    comm,
                const std::string          &directory,
                const ForgingModel         &model,
                const Process<double>      &process,
                const TetMesh              &billet,
                const NodalVectors<double> &X_0);

    /// The workpiece before it is forged, the first picture.
    /// @throws Error  if a file cannot be written
    void add_billet();

    /// To be told of every increment, written or not: displacements add up, and are carried through
    /// remeshings as other nodal values are.
    void follow(const IncrementEvent &event);

    /// The end of the increment followed last, with what its last stage found.
    /// @throws Error  if a file cannot be written
    void add(const IncrementEvent &event);

    /// The workpiece where the run failed, with the fields of the last equilibrium. For the first rank alone,
    /// as others may have failed elsewhere.
    void add_failed(const ForgingState &state);

  private:
    struct Workpiece;

    void write(const std::string &file, const Workpiece &workpiece) const;
    void write_billet() const;
    /// @param suffix  of the file's name
    /// @param X       of the workpiece, which the picture of a plane covers
    /// @returns the file
    std::string write_die(unsigned int                d,
                          const Vec3                 &displacement,
                          const std::string          &suffix,
                          const NodalVectors<double> &X);
    /// Replaces the last step where it is at the same time.
    void add_step(const StrokeStep           &at,
                  const std::string          &file,
                  const std::string          &suffix,
                  const NodalVectors<double> &X);

    bool                        is_first_;
    std::string                 directory_;
    const ForgingModel         &model_;
    const Process<double>      &process_;
    const TetMesh              &billet_;
    const NodalVectors<double> &X_0_;
    NodalVectors<double>        displacement_;     ///< since the billet [mm]
    std::size_t                 n_remeshings_ = 0; ///< number of remeshings it has been carried through
    PictureSeries               series_;           ///< at each time the workpiece, then the dies
    std::set<unsigned int>      drawn_still_;      ///< dies that stand still and have their one picture
  };
} // namespace retroforge
