// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/dual.h>
#include <retroforge/geometry/vector_algebra.h>
#include <retroforge/mesh/tet_mesh.h>

/// @file
/// The formulas by which remeshing finds positions, each of few vectors of space.
namespace retroforge
{
  /// How a vector of a PositionTape follows from others, its arguments. Numbers are constants. A sum of weights w_i
  /// and vectors may have an offset. Sizes and distances are vectors, too, with the number in the first component.
  enum class PlacingRule : unsigned char
  {
    sum,             ///< of (x_i) with the numbers (w_i):  sum w_i x_i;  with three numbers more, plus these
    constant,        ///< of no vector: the three numbers
    normal,          ///< of (x, a_1, b_1, ...): mean of the normals of the faces (x, a_i, b_i), without the
                     ///< parts along the numbers' unit vectors
    middle_tangent,  ///< of (a, x, b): tangent of a parabola through the three, in the middle
    end_tangent,     ///< of (a, b, t): tangent of an arc over the chord a-b whose other end has the tangent t
    chord,           ///< of (a, b): its direction
    on_face,         ///< of (x, a, b, c, n_a, n_b, n_c): the point of a face next to x, lifted
    on_face_edge,    ///< of (x, a, b, n_a, n_b): that of an edge of a face, lifted by normals
    on_ridge,        ///< of (x, a, b, t_a, t_b): that of an edge of a ridge, lifted by tangents
    push_out,        ///< of (x), with a die and the facet and kind of its feature: x + delta n
    snap,            ///< of (x), with one or two of the tape's planes: the point on them
    size,            ///< of (x, a_1, ...) with the numbers (m_i):  sum m_i |a_i - x| / sum m_i
    rim,             ///< of (a_1, b_1, ...): area vector of what the edges go around
    step_inside,     ///< of (x, size) and the numbers w:  x + size w
    step_on_surface, ///< of (x, size, rim), with an axis, and the numbers (p, q): x + size (p u + q v), u and
                     ///< v the directions across the rim's, u across the axis
    step_on_ridge,   ///< of (x, size, a, b), and the number p: x + size p (b - a)/|b - a|
    outward,  ///< of (a_1, b_1, ..., c, d, e, ...), with the count of a's and b's: direction of the area
              ///< vector of what the edges go around, without its parts across planes with the numbers'
              ///< normals, and across faces (c, d, e)
    distance, ///< that gives a mesh its volume, see PositionTape
    shift,    ///< of (x, distance, u): x + distance u
    n_rules
  };

  /// A vector's rule with what it is of. Refers to a tape.
  struct PlacedBy
  {
    PlacingRule         rule;
    const unsigned int *arguments;
    unsigned int        n_arguments;
    const double       *numbers;
    unsigned int        n_numbers;

    /// Returns how many of the arguments, the first ones, are vectors; the others are indices.
    unsigned int n_vectors() const;

    /// Returns whether the counts of arguments and numbers are those of the rule.
    bool is_sound() const;
  };

  /// Returns the vector that a rule makes of others. Not of push_out and distance, which need dies and meshes.
  /// @param x       the arguments that are vectors
  /// @param planes  of the tape
  /// @tparam Number  double, Dual, or Gradient3
  template <typename Number>
  Vector3<Number>
  placed(const PlacedBy &by, const std::vector<Vector3<Number>> &x, const std::vector<Plane> &planes);

  /// Derivatives by one vector.
  using Gradient3 = Sacado::Fad::SFad<double, 3>;
} // namespace retroforge
