// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/billet/msh_scanner.h>
#include <retroforge/core/error.h>
#include <retroforge/core/input_file.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>

namespace retroforge
{
  namespace
  {
    bool is_space(const char c)
    {
      return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f';
    }

    const std::string whole_number_rule = "a whole number must follow here";
  } // namespace

  MshScanner::MshScanner(const std::string &file_name)
      : file_name_(file_name), bytes_(as_plain_lines(read_input_file(file_name, "the mesh of the billet")))
  {
    if (bytes_.compare(0, 11, "$MeshFormat") != 0)
      refuse_other_format(file_name, bytes_, Wanted::volume_mesh);
  }

  void MshScanner::fail(const std::string &what, const std::string &rule) const
  {
    const std::size_t position = std::min(position_, bytes_.size());
    const std::string where =
      binary_ ? "byte " + std::to_string(position)
              : "line " + std::to_string(1 + std::count(bytes_.begin(), bytes_.begin() + position, '\n'));
    throw Error(file_name_ + ", " + where,
                what,
                rule,
                "check that the file is complete, or save it anew from Gmsh with `-format msh41'");
  }

  void MshScanner::skip_space()
  {
    while (position_ < bytes_.size() && is_space(bytes_[position_]))
      ++position_;
  }

  std::string MshScanner::rest_of_line()
  {
    const std::size_t end  = std::min(bytes_.find('\n', position_), bytes_.size());
    std::string       line = bytes_.substr(position_, end - position_);
    position_              = std::min(end + 1, bytes_.size());
    line.erase(line.find_last_not_of(" \t\r") + 1);
    return line;
  }

  std::string MshScanner::next_section()
  {
    for (skip_space(); position_ < bytes_.size(); skip_space())
      if (const std::string line = rest_of_line(); line[0] == '$')
        return line.substr(1);
    return "";
  }

  void MshScanner::end_section(const std::string &name)
  {
    skip_space();
    const std::size_t start = position_;
    const std::string line  = rest_of_line();
    if (line == "$End" + name)
      return;
    position_ = start;
    fail(line.empty() ? "the file ends" : "found '" + legible(line.substr(0, 40)) + "'",
         "'$End" + name + "' must follow here");
  }

  void MshScanner::skip_section(const std::string &name)
  {
    const std::size_t end = bytes_.find("$End" + name, position_);
    if (end == std::string::npos)
      fail("the file ends before '$End" + legible(name) + "'", "each section is closed");
    position_ = end;
    rest_of_line();
  }

  void MshScanner::end_of_number(const char *end, const std::string &rule)
  {
    const char *begin = bytes_.data() + position_;
    if (end != begin && (end == bytes_.data() + bytes_.size() || is_space(*end)) && errno != ERANGE)
    {
      position_ = end - bytes_.data();
      return;
    }
    std::size_t stop = position_;
    while (stop < bytes_.size() && !is_space(bytes_[stop]) && stop < position_ + 40)
      ++stop;
    fail(stop == position_ ? "the file ends"
                           : "found '" + legible(bytes_.substr(position_, stop - position_)) + "'",
         rule);
  }

  long long MshScanner::whole_number()
  {
    skip_space();
    char *end             = nullptr;
    errno                 = 0;
    const long long value = std::strtoll(bytes_.c_str() + position_, &end, 10);
    end_of_number(end, whole_number_rule);
    return value;
  }

  int MshScanner::integer_in_text()
  {
    const long long value = whole_number();
    if (value < std::numeric_limits<int>::min() || value > std::numeric_limits<int>::max())
      fail("found " + std::to_string(value), "a whole number of at most 31 bits must stand here");
    return static_cast<int>(value);
  }

  double MshScanner::real_in_text()
  {
    skip_space();
    char        *end   = nullptr;
    const double value = std::strtod(bytes_.c_str() + position_, &end);
    errno              = 0; // what is too small is zero, what is too large infinite
    end_of_number(end, "a number must follow here");
    return value;
  }

  template <typename Number>
  Number MshScanner::raw()
  {
    if (bytes_.size() - position_ < sizeof(Number))
      fail("the file ends", "a number must follow here");
    Number value;
    std::memcpy(&value, bytes_.data() + position_, sizeof(Number));
    position_ += sizeof(Number);
    return value;
  }

  int MshScanner::integer()
  {
    return binary_ ? raw<int>() : integer_in_text();
  }

  std::size_t MshScanner::size()
  {
    if (binary_)
      return raw<std::size_t>();
    const long long value = whole_number();
    if (value < 0)
      fail("found " + std::to_string(value), "a number without sign must stand here");
    return static_cast<std::size_t>(value);
  }

  double MshScanner::real()
  {
    return binary_ ? raw<double>() : real_in_text();
  }

  void MshScanner::check_room(const std::size_t things, const std::size_t numbers) const
  {
    const std::size_t least = std::max<std::size_t>(numbers, 1) * (binary_ ? 4 : 2); // digit and blank
    if (things > (bytes_.size() - position_ + 1) / least)
      fail("announces " + std::to_string(things) + " entries, and " +
             std::to_string(bytes_.size() - position_) + " bytes follow",
           "there must be as many entries as announced");
  }

  std::size_t MshScanner::count(const std::size_t numbers)
  {
    const std::size_t things = size();
    check_room(things, numbers);
    return things;
  }

  std::size_t MshScanner::count_in_text(const std::size_t numbers)
  {
    const int things = integer_in_text();
    if (things < 0)
      fail("found " + std::to_string(things), "a number of entries must stand here");
    rest_of_line();
    check_room(things, numbers);
    return things;
  }

  void MshScanner::skip_integers(const std::size_t n)
  {
    for (std::size_t i = 0; i < n; ++i)
      integer();
  }

  void MshScanner::skip_reals(const std::size_t n)
  {
    for (std::size_t i = 0; i < n; ++i)
      real();
  }
} // namespace retroforge
