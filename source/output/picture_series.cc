// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/output/picture_series.h>
#include <retroforge/output/safe_file.h>

#include <charconv>
#include <filesystem>

namespace retroforge
{
  namespace
  {
    const std::string opening_tags =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n"
      "  <Collection>\n";
    const std::string closing_tags = "  </Collection>\n</VTKFile>\n";

    /// As few digits as distinguish the number from all others.
    std::string shortest_text(const double x)
    {
      char text[32];
      return std::string(text, std::to_chars(text, text + sizeof text, x).ptr);
    }
  } // namespace

  void PictureSeries::add(const double time, const std::vector<std::string> &pictures)
  {
    const bool     again  = !text_.empty() && time == last_time_;
    std::uintmax_t length = text_.size() + closing_tags.size();
    if (text_.empty())
      text_ = opening_tags;
    else if (again)
      text_.resize(last_begin_);
    last_begin_ = text_.size();
    last_time_  = time;
    for (const std::string &picture : pictures)
      text_ +=
        "    <DataSet timestep=\"" + shortest_text(time) + "\" part=\"0\" file=\"" + picture + "\"/>\n";

    std::error_code none; // no file yet, or one that somebody else removed or changed
    if (!again && std::filesystem::file_size(file_, none) == length)
      replace_end(file_, closing_tags, text_.substr(last_begin_) + closing_tags);
    else
      write_file(file_, text_ + closing_tags);
  }
} // namespace retroforge
