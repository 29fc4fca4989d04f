// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/verification/check.h>

#include <string>
#include <vector>

namespace retroforge
{
  /// The part of a check that is done, kept as it goes on (check.json), so that one that was stopped need not
  /// repeat it. Numbers read back to the same bits.
  struct CheckFile
  {
    std::string           program;      ///< version and commit
    std::string           parameters;   ///< the complete input
    unsigned int          n_increments; ///< of the run that is checked
    double                stroke;       ///< where it ended [mm]
    std::vector<CheckRow> rows;

    /// Replaces `file` in one step.  @throws Error if it cannot be written
    void write(const std::string &file) const;

    /// Without rows where there is no such file, or one that cannot be understood: a check can be repeated.
    static CheckFile read(const std::string &file);
  };
} // namespace retroforge
