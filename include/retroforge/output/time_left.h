// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

namespace retroforge
{
  /// Estimates the time for the rest of a stroke at the pace of the last increments:  t = (S - s) T / D,
  /// where T and D are the seconds and millimetres of the increments solved, each counted exp(-(s - s_i) /
  /// l), s_i its end and l a tenth of the stroke S. Long past increments no longer count, and short ones
  /// count by what they take of the stroke.
  class TimeLeft
  {
  public:
    /// @param stroke  of the whole run, S [mm]
    explicit TimeLeft(double stroke) : stroke_(stroke) {}

    /// An increment that was solved.
    /// @param step  of the press in it [mm]
    void add(double step, double seconds);

    /// @param stroke  done, s [mm]       @return NaN before the first increment [s]
    double seconds(double stroke) const;

  private:
    double stroke_;
    double time_ = 0., path_ = 0.; ///< T [s], D [mm]
  };
} // namespace retroforge
