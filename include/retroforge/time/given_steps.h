// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <string>
#include <vector>

namespace retroforge
{
  /// Increments that a run is to make instead of choosing them.
  struct GivenSteps
  {
    /// Strokes at which they end, ascending, over all operations [mm]; empty: the run chooses.
    std::vector<double> ends;
    double              stretch = 1.; ///< by which they are longer than in the file they are from

    bool empty() const { return ends.empty(); }
  };

  /// Returns `step` [mm], changed in its last digits so that it is the difference of the strokes at its ends,
  /// to the bit: so a list of strokes tells the steps between them.
  inline double told_by_strokes(const double stroke, const double step)
  {
    return (stroke + step) - stroke;
  }

  /// Reads a table whose column `stroke` has the ends of increments, as the history of a run, and stretches
  /// them to end at a stroke [mm].  @throws Error  with the line
  GivenSteps read_steps(const std::string &file, double stroke);

  /// Returns the text of such a table.
  std::string table_of_steps(const std::vector<double> &ends);
} // namespace retroforge
