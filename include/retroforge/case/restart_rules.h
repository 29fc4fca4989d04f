// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/record/record_file.h>

namespace retroforge
{
  /// A setting that differs between two complete inputs; (absent) stands for one that an input does not have.
  struct ChangedSetting
  {
    std::string path, before, now;
  };

  /// Returns what differs between a record and the run that goes on from it and may: numerics, that is how
  /// the equations are solved and cut into increments and meshes. Each room tags its settings (SettingRole)
  /// where it declares them.
  ///
  /// Numerics are Press but for the leading die (the stroke may not end before the record does), Newton,
  /// Linear solver, Remeshing but for the first mesh, and of Contact what is measured in increments or
  /// belongs to the mesh. The scene is billet, dies, material, Discretization, and of Contact the law, its
  /// penalty and the regularisation of slip, each of which is one number of the whole run that a gradient
  /// can be taken by. Adjoint, Check, Design, Objective, Optimisation, Output and Scan do not change the
  /// forging at all, and are not reported.
  std::vector<ChangedSetting> changed_numerics(const std::string &before, const std::string &now);

  /// The record that a run goes on from.
  struct Resumption
  {
    RecordHeader                header;
    std::vector<RecordedInput>  inputs;
    unsigned int                n_increments;
    std::vector<ChangedSetting> changes; ///< changes of numerics, against those the record ends with

    /// @param parameters  the complete input of the run that is to go on
    /// @param stroke      that of the first operation [mm]
    /// @throws Error  that names all settings of the scene that differ; also for a record that is missing or
    /// damaged
    Resumption(const std::string &directory, const std::string &parameters, double stroke);

    /// Makes sure that billet and dies are those of the record.  @throws Error
    void
    check_start(const TetMesh &mesh, const NodalVectors<double> &X_0, const std::vector<Die> &dies) const;

    /// Reads all increments, before anything of the folder changes. @throws Error  where one is damaged
    void check_increments() const;

  private:
    std::string directory_;
  };

  /// Facets of each die, and fingerprints of their vertices, as a record's header has them.
  std::vector<unsigned int>  facets(const std::vector<Die> &dies);
  std::vector<std::uint64_t> fingerprints(const std::vector<Die> &dies);

  /// Returns whether two complete inputs give the same results, gradients included: all of them is equal but
  /// for the sections Check, Optimisation, Output and Scan.
  bool make_same_results(const std::string &parameters, const std::string &others);

  /// Returns whether a check of the same record gives the same numbers with both: all is equal but for the
  /// sections Optimisation, Output and Scan.
  bool make_same_check(const std::string &parameters, const std::string &others);
} // namespace retroforge
