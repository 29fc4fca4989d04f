// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <string>
#include <vector>

namespace retroforge
{
  /// The time series of a run (.pvd): which .vtu belong to which time, as parts of one picture. The file is
  /// complete after every call, so a run that is killed leaves one that opens.
  class PvdWriter
  {
  public:
    struct Part
    {
      std::string name; ///< what the part shows
      std::string file; ///< relative to the folder of the .pvd
    };

    struct Step
    {
      double            time;
      std::vector<Part> parts; ///< numbered as they stand here
    };

    explicit PvdWriter(const std::string &file);

    /// Append a time, or replace the last one where it is the same.  @throws Error if the series cannot be
    /// written
    void add(double time, const std::vector<Part> &parts);

    /// Times and files listed so far.
    const std::vector<Step> &steps() const { return steps_; }

  private:
    std::string       file_;
    std::vector<Step> steps_;

    void write() const;
  };
} // namespace retroforge
