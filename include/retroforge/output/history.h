// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace retroforge
{
  /// Statistics of one increment, at its end.
  struct HistoryRow
  {
    unsigned int increment = 0; ///< counted from 1; 0 is the initial state
    double       time      = 0; ///< s
    double       stroke    = 0; ///< mm
    /// Force of the leading die along its path, on the average over the increment, N.
    double force       = 0;
    double energy      = 0; ///< spent so far, mJ
    double volume      = 0; ///< mm^3
    double min_quality = 0; ///< quality of the worst cell, dimensionless
    /// Depth of the surface's deepest point in a die, or of a die's in the metal, mm.
    double       depth  = 0;
    unsigned int newton = 0; ///< Newton iterations of the increment
    unsigned int krylov = 0; ///< iterations of its linear solves

    /// Force, energy and volume of the whole part, of which symmetry may leave a sector.
    double whole_force = 0, whole_energy = 0, whole_volume = 0;

    /// Work of the dies on gaps that close over the energy of the increment, by which the dies' reactions and
    /// what deformation and friction take are apart, dimensionless.
    double balance = 0;
  };

  /// The history of a run as a table (.csv). Each row is on the disk when add() returns; numbers read back to
  /// the same bits.
  class History
  {
  public:
    /// Start a new table.  @throws Error if it cannot be written
    explicit History(const std::string &file);

    /// @throws Error if the row cannot be written
    void add(const HistoryRow &row);

    /// @throws Error, with the line, if the file is not such a table
    static std::vector<HistoryRow> read(const std::string &file);

  private:
    struct Close
    {
      void operator()(std::FILE *stream) const { std::fclose(stream); }
    };

    std::string                       file_;
    std::unique_ptr<std::FILE, Close> stream_;

    void write(const std::string &text);
  };
} // namespace retroforge
