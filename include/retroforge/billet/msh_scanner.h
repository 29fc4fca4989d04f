// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <cstddef>
#include <string>

namespace retroforge
{
  /// Takes the lines and numbers of a Gmsh file one after the other, from text or, once set_binary() was
  /// called, from bytes in this machine's order. Nothing it returns was made up: what is missing, no number,
  /// or too large for its type throws Error with the line or byte.
  class MshScanner
  {
  public:
    /// Reads the whole file. @throws Error
    explicit MshScanner(const std::string &file_name);

    void set_binary() { binary_ = true; }
    bool is_binary() const { return binary_; }

    /// Name of the next section, without its `$`; empty at the end of the file. Lines between sections are
    /// comments.
    std::string next_section();
    /// Goes past `$End...`, which must follow.
    void end_section(const std::string &name);
    /// Goes past `$End...`, wherever it is.
    void skip_section(const std::string &name);
    /// The rest of a line of text.
    std::string rest_of_line();

    /// Numbers of 4 and 8 bytes, if these are binary.
    int         integer();
    std::size_t size();
    double      real();

    int    integer_in_text();
    double real_in_text();

    /// A number of things to come, each of `numbers` numbers or more: the file must be long enough for them,
    /// so that no memory is asked for in vain.
    std::size_t count(std::size_t numbers);
    std::size_t count_in_text(std::size_t numbers);
    /// Checks that there is room left for this many numbers.
    void check_room(std::size_t things, std::size_t numbers) const;

    /// Skips the given number of numbers of 4 or 8 bytes.
    void skip_integers(std::size_t n);
    void skip_reals(std::size_t n);

    [[noreturn]] void fail(const std::string &what, const std::string &rule) const;

  private:
    void      skip_space();
    long long whole_number();
    void      end_of_number(const char *end, const std::string &rule);
    template <typename Number>
    Number raw();

    const std::string file_name_;
    std::string       bytes_;
    std::size_t       position_ = 0;
    bool              binary_   = false;
  };
} // namespace retroforge
