// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/dual.h>
#include <retroforge/core/types.h>

/// @file
/// Derivatives of what depends on a few numbers only, as a cell's or a facet's part of a sum, by dual numbers
/// that carry all of them.
namespace retroforge
{
  template <int n>
  using Partials = Sacado::Fad::SFad<double, n>;

  /// A facet's corners, gaps at seven points, and normals at four: the most that any part depends on.
  inline constexpr int n_partials = 28;

  /// The arguments of a part, each with its place among the derivatives, in the order of their making.
  class LocalArguments
  {
  public:
    using Number = Partials<n_partials>;

    Number operator()(const double x)
    {
      AssertIndexRange(n_, n_partials);
      return Number(n_partials, n_++, x);
    }

    Vector3<Number> operator()(const Vec3 &x)
    {
      Vector3<Number> y;
      for (unsigned int i = 0; i < 3; ++i)
        y[i] = (*this)(x[i]);
      return y;
    }

    template <std::size_t n>
    std::array<Vector3<Number>, n> operator()(const std::array<Vec3, n> &x)
    {
      std::array<Vector3<Number>, n> y;
      for (std::size_t k = 0; k < n; ++k)
        y[k] = (*this)(x[k]);
      return y;
    }

  private:
    int n_ = 0;
  };

  /// Returns three derivatives of a part, from `first` on, times a weight.
  inline Vec3 derivative(const Partials<n_partials> &part, const unsigned int first, const double weight)
  {
    return Vec3({weight * part.dx(first), weight * part.dx(first + 1), weight * part.dx(first + 2)});
  }
} // namespace retroforge
