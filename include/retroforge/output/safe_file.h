// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <string>

namespace retroforge
{
  /// Write the whole file beside its place and rename it: a reader, or a run that is killed, finds the old
  /// contents or the new, never half of them. What is not a regular file (a device, a pipe) is written
  /// directly.
  /// @throws Error naming the file, the reason of the operating system and the remedy
  void write_file(const std::string &file, const std::string &contents);

  /// Writes over the end of a file, at once: a reader, or a run that is killed, finds the old end or the new. For
  /// lists that grow: a file system that brings a file to the disk before it takes the place of another one, as
  /// ext4 does, spends milliseconds of write_file().
  /// @param old_end  which the file has     @param new_end  not shorter
  /// @throws Error  as write_file(); the end is the old one then
  void replace_end(const std::string &file, const std::string &old_end, const std::string &new_end);

  /// Checks that write_file() would succeed, by writing an empty file beside it.  @throws Error
  void check_writable(const std::string &file);

  /// The contents of a file; throws Error if it cannot be read.
  std::string read_file(const std::string &file);

  /// Make sure that the folder exists.  @throws Error
  void make_directory(const std::string &directory);

  /// The Error of an output file that could not be written, for a value of `errno`.
  [[noreturn]] void throw_write_error(const std::string &file, int error_number);
} // namespace retroforge
