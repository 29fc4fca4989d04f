// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace retroforge
{
  /// The time series of a run (.pvd): which .vtu belongs to which time. The file is complete after every
  /// call, so a run that is killed leaves one that opens.
  class PvdWriter
  {
  public:
    explicit PvdWriter(const std::string &file);

    /// Append a file, named relative to the folder of the .pvd.  @throws Error if the series cannot be
    /// written
    void add(double time, const std::string &vtu_file);

    /// Times and files listed so far.
    const std::vector<std::pair<double, std::string>> &steps() const { return steps_; }

  private:
    std::string                                 file_;
    std::vector<std::pair<double, std::string>> steps_;

    void write() const;
  };
} // namespace retroforge
