// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/output/objective_history.h>
#include <retroforge/output/safe_file.h>

#include <algorithm>
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
    if (titles_.empty())
    {
      text << "stroke [mm]";
      for (const auto &[title, value] : columns)
        text << ',' << titles_.emplace_back(title);
      text << '\n';
    }
    text << stroke;
    for (const std::string &title : titles_)
    {
      text << ',';
      const auto column = std::find_if(
        columns.begin(), columns.end(), [&](const NamedValue &named) { return named.first == title; });
      if (column != columns.end() && std::isfinite(column->second))
        text << column->second;
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
