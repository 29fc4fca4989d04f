// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <string>

namespace retroforge
{
  /// All bytes of a file that a user names. @throws Error  when it is none, or cannot be read
  /// @param meaning  what it is for: "the file of a die"
  std::string read_input_file(const std::string &file_name, const std::string &meaning);

  /// The text without what programs put around it: a byte order mark is gone, UTF-16 has become bytes (with
  /// '?' for what is not ASCII), and lines that end in a carriage return alone end in a line feed. Other
  /// bytes stay as they are.
  std::string as_plain_lines(std::string bytes);

  /// Returns whether the length is that of a binary STL file with the number of facets in its head.
  bool has_length_of_binary_stl(const std::string &bytes);

  /// The format that a file is read as.
  enum class Wanted
  {
    surface,    ///< triangles, from STL
    volume_mesh ///< tetrahedra, from a Gmsh file
  };

  /// Tells files of other formats by their first bytes: CAD files, other meshes, archives, pointers of Git
  /// LFS, web pages and so on. @throws Error  for one of them, with its name and how to convert it
  void refuse_other_format(const std::string &file_name, const std::string &bytes, Wanted wanted);
} // namespace retroforge
