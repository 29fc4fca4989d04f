// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <string>

namespace retroforge
{
  /// A type of element of Gmsh, which are numbered from 1. The corners of an element of higher order are its
  /// first nodes.
  struct MshElement
  {
    enum class Shape
    {
      other, ///< points, lines, quadrilaterals
      triangle,
      tetrahedron,
      hexahedron,
      prism,
      pyramid
    };

    unsigned int n_nodes   = 0; ///< 0: no such type
    Shape        shape     = Shape::other;
    bool         is_linear = true; ///< nodes at its corners only
  };

  MshElement msh_element(int type);

  /// Returns the name of volume elements of a shape, in the plural.
  std::string name_of(MshElement::Shape shape);
} // namespace retroforge
