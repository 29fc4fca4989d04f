// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/output/objective_history.h>
#include <retroforge/output/safe_file.h>

#include <cerrno>
#include <cmath>
#include <sstream>

namespace retroforge
{
  ObjectiveHistory::ObjectiveHistory(const std::string &file)
      : file_(file), stream_(std::fopen(file.c_str(), "w"))
  {
    if (!stream_)
      throw_write_error(file_, errno);
  }

  void ObjectiveHistory::add(const double stroke, const std::vector<NamedValue> &columns)
  {
    std::ostringstream text;
    text.precision(17);
    if (!std::exchange(has_header_, true))
    {
      text << "stroke [mm]";
      for (const auto &[title, value] : columns)
        text << ',' << title;
      text << '\n';
    }
    text << stroke;
    for (const auto &[title, value] : columns)
    {
      text << ',';
      if (std::isfinite(value))
        text << value;
    }
    text << '\n';
    write(text.str());
  }

  void ObjectiveHistory::write(const std::string &text)
  {
    if (std::fputs(text.c_str(), stream_.get()) < 0 || std::fflush(stream_.get()) != 0)
      throw_write_error(file_, errno);
  }
} // namespace retroforge
