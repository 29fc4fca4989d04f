// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/output/warnings.h>

#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>

namespace retroforge
{
  namespace
  {
    [[gnu::format(printf, 1, 2)]] std::string formatted(const char *format, ...)
    {
      std::array<char, 1000> text;
      std::va_list           numbers;
      va_start(numbers, format);
      std::vsnprintf(text.data(), text.size(), format, numbers);
      va_end(numbers);
      return text.data();
    }

    std::string of_depth(const Summary::Depth &deepest)
    {
      return formatted(
        "the surface was up to %.3g mm (%.1f %% of the element size) inside die %s, at (%.4g, %.4g, %.4g) "
        "and "
        "stroke %.5g: what is inside does no work. More increments, a smaller Contact/edge sinking or "
        "Remeshing/chord error hold it out.",
        deepest.depth,
        100. * deepest.relative,
        deepest.die.c_str(),
        deepest.place[0],
        deepest.place[1],
        deepest.place[2],
        deepest.stroke);
    }

    std::string of_spanned(const Summary::Spanned &spanned)
    {
      return formatted(
        "up to %u of the %u surface edges that touched curved dies spanned their corners, worst at (%.4g, "
        "%.4g, %.4g) of die %s and stroke %.5g, where it bulges by %.0f %% of the edge's length: quadratic "
        "velocities ripple there. A smaller Remeshing/chord error or Remeshing/element size, or "
        "Discretization/element=mini, keeps to the die.",
        spanned.spanning,
        spanned.touching,
        spanned.place[0],
        spanned.place[1],
        spanned.place[2],
        spanned.die.c_str(),
        spanned.stroke,
        100. * spanned.bulge);
    }

    std::string of_volume(const double change)
    {
      return formatted(
        "the workpiece has %s %.2g %% of its volume over the stroke, and forces and energies at the end are "
        "of "
        "%s metal. Smaller elements (Remeshing/element size) where it is thinner than they are, more "
        "increments, or a shorter stroke keep it.",
        change < 0. ? "lost" : "won",
        100. * std::abs(change),
        change < 0. ? "less" : "more");
    }
    /// Of edges that touch, which span corners.
    constexpr double many = 0.05;
  } // namespace

  bool is_in_die(const Summary::Depth &deepest, const Summary::Spanned &spanned, const double largest_depth)
  {
    return deepest.relative > largest_depth || spanned.share() > many;
  }

  std::vector<std::string>
  warnings_of(const Summary &summary, const double largest_depth, const std::vector<std::string> &untouched)
  {
    constexpr double         much = 0.002;
    std::vector<std::string> warnings;
    if (std::abs(summary.volume_change()) > much)
      warnings.push_back(of_volume(summary.volume_change()));
    if (summary.deepest.relative > largest_depth)
      warnings.push_back(of_depth(summary.deepest));
    if (summary.spanned.share() > many)
      warnings.push_back(of_spanned(summary.spanned));
    for (const std::string &die : untouched)
      warnings.push_back("the stroke pressed no node against die " + die);
    return warnings;
  }
} // namespace retroforge
