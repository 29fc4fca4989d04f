// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/scan/line_statistics.h>
#include <retroforge/scan/scan_point.h>

#include <iosfwd>

namespace retroforge
{
  /// A parameter that was varied.
  struct ScanLine
  {
    std::string            parameter, unit;
    double                 nominal; ///< in the middle of the range
    std::vector<ScanPoint> points;
  };

  /// What a scan found, smooth fits included.
  class ScanResults
  {
  public:
    ScanResults(std::vector<ScanLine> lines, unsigned int degree);

    unsigned int n_failed() const;

    /// A row per point: each objective's value, gradient, fit and fit's slope.  @throws Error
    void write_csv(const std::string &file) const;
    /// Statistics of each parameter and objective, see doc/summary_schema.md.  @throws Error
    void write_json(const std::string &file) const;
    /// The table a user reads.
    void print(std::ostream &out) const;

  private:
    struct LineObjective
    {
      std::string                  name, unit;
      ScannedLine                  line;
      std::optional<PolynomialFit> fit;
      LineStatistics               statistics;
    };

    std::vector<ScanLine>                   lines_;
    std::vector<std::vector<LineObjective>> objectives_; ///< the objectives of each line
    unsigned int                            degree_;
  };
} // namespace retroforge
