// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/geometry/triangle_surface.h>

namespace retroforge
{
  enum class StlFormat
  {
    ascii,
    binary
  };

  /// Reads an STL file, ASCII or binary. Corners nearer to each other than 1e-6 of the bounding box's
  /// diagonal become one vertex; vertices are numbered as they first appear. Which side of a facet is outside
  /// follows from the order of its corners; a normal in the file may be zero or no number, but may not
  /// contradict it. What mend() does to the surface, with seams of 1e-5 of the diagonal, or of the rounding
  /// of single precision where that is more, is in the surface's remarks.
  /// @throws Error  for files that cannot be read, are of another format, are cut short or hold bad numbers,
  /// normals against the order of the corners, facets that hang together nowhere, and whatever
  /// TriangleSurface refuses
  TriangleSurface read_stl(const std::string &file_name);

  /// The same, for a setting, whose name errors begin with.
  TriangleSurface read_stl(const std::string &file_name, const std::string &setting);

  /// @throws Error  when the file cannot be written
  /// Binary files hold single precision: their corners are rounded to 6e-8 of their size. ASCII files keep
  /// all digits.
  void write_stl(const std::string &file_name, const TriangleSurface &surface, StlFormat format);
  void write_stl(const std::string           &file_name,
                 const NodalVectors<double>  &vertices,
                 const std::vector<Triangle> &triangles,
                 StlFormat                    format);
} // namespace retroforge
