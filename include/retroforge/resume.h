// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/record/record_format.h>

namespace retroforge
{
  /// A run goes on only with what it began with: the same billet, and the same parameters but for those that
  /// change no result (Adjoint, Check, Design, Output).
  /// @param parameters  the complete input of the run that is to go on
  /// @throws Error  that names what differs
  void check_resumable(const RecordHeader         &header,
                       const std::string          &parameters,
                       const TetMesh              &mesh,
                       const NodalVectors<double> &X_0,
                       const std::vector<Die>     &dies,
                       const std::string          &directory);

  /// Whether two complete inputs give the same results, gradients included: all of them is equal but for the
  /// sections Check, Output and Scan.
  bool make_same_results(const std::string &parameters, const std::string &others);
} // namespace retroforge
