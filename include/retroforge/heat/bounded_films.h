// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/dual.h>

#include <cmath>

/// @file
/// Bounds by which films beneath which skins grow make nothing warmer or colder than what there is, smooth in what they bound.
namespace retroforge
{
  /// A node that is warmer than the metal above it, as where a film has fallen, is so by at most half of the drop across the film.
  template <typename Number>
  Number bounded_drops(const Number &drops)
  {
    using std::exp;
    return value_of(drops) >= 1. ? drops : Number(0.5 + 0.5 * exp(Number(2. * (drops - 1.))));
  }

  inline double slope_of_bounded_drops(const double drops)
  {
    return drops >= 1. ? 1. : std::exp(2. * (drops - 1.));
  }

  /// The positive part, smooth over the width, and not above it.
  template <typename Number>
  Number positive(const Number &x, const Number &width)
  {
    if (value_of(x) <= 0.)
      return Number(0.);
    return value_of(x) >= value_of(width) ? x : Number(x * x * (2. - x / width) / width);
  }

  /// A width for a bound: a degree, or less than the bound where that is near.
  template <typename Number>
  Number width_of(const Number &bound)
  {
    return bound / (1. + bound);
  }

  /// A shift of the die's temperature kept in the range of 0 and two others: the difference to the node's, and by how much the
  /// die's surface is warmer. Within it, it stays what it is.
  template <typename Number>
  Number kept_between(const Number &shift, const Number &difference, const Number &warmth)
  {
    Number upper(0.), lower(0.);
    for (const Number *x : {&difference, &warmth})
    {
      if (value_of(*x) > value_of(upper))
        upper = *x;
      if (value_of(*x) < value_of(lower))
        lower = *x;
    }
    const Number below = upper - positive(Number(upper - shift), width_of(upper));
    return lower + positive(Number(below - lower), width_of(Number(-lower)));
  }

  struct ShiftSlopes
  {
    double in_shift, in_difference, in_warmth;
  };

  inline ShiftSlopes slopes_of_kept_between(const double shift, const double difference, const double warmth)
  {
    using Partial    = Sacado::Fad::SFad<double, 3>;
    const Partial of = kept_between(Partial(3, 0, shift), Partial(3, 1, difference), Partial(3, 2, warmth));
    return {of.dx(0), of.dx(1), of.dx(2)};
  }
} // namespace retroforge
