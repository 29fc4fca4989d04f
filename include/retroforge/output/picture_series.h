// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace retroforge
{
  /// The list of pictures over time that ParaView opens: a PVD file, which grows with every time added. It is
  /// complete after every call, so a run that is killed leaves one that opens.
  class PictureSeries
  {
  public:
    /// Nothing is written before the first time is added.
    explicit PictureSeries(std::string file) : file_(std::move(file)) {}

    bool empty() const { return text_.empty(); }

    /// Adds the pictures of a time. Those of the time added last are replaced where it is the same one.
    /// @param time      [s]
    /// @param pictures  file names, seen from the folder of the list
    /// @throws Error  if the list cannot be written
    void add(double time, const std::vector<std::string> &pictures);

  private:
    std::string file_;
    std::string text_;           ///< but for the closing tags; empty: nothing was added
    std::size_t last_begin_ = 0; ///< of the time added last, in the text
    double      last_time_  = 0.;
  };
} // namespace retroforge
