// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/remeshing/gap_sizes.h>

#include <algorithm>

namespace retroforge
{
  namespace
  {
    // Thinner ones, over the smallest length, count as closed: nothing flows between dies that touch.
    constexpr double closed_gap = 0.1;
  } // namespace

  GapSizes::GapSizes(const std::vector<Die> &dies,
                     std::vector<Plane>      planes,
                     const double            elements,
                     const double            smallest)
      : dies_(dies), planes_(std::move(planes)), elements_(elements), smallest_(smallest)
  {
    Assert(smallest > 0. && elements >= 0., dealii::ExcMessage("lengths are positive"));
  }

  std::vector<GapSizes::Wall>
  GapSizes::walls(const Vec3 &x, const DieStates &states, const double reach) const
  {
    AssertDimension(states.size(), dies_.size());
    std::vector<Wall> found;
    for (unsigned int d = 0; d < dies_.size(); ++d)
      if (states[d].in_press != 0)
        if (const DieFeature feature = dies_[d].closest(x, states[d].displacement, reach); feature.found())
          if (const auto foot = dies_[d].project(x, states[d].displacement, feature); foot.delta <= reach)
            found.push_back({foot.delta, foot.n, false});
    if (!found.empty())
      for (const Plane &plane : planes_)
        if (const double delta = (plane.point - x) * plane.normal; delta <= reach)
          found.push_back({delta, plane.normal, true});
    return found;
  }

  double GapSizes::operator()(const Vec3 &x, const DieStates &states, const double upper) const
  {
    double     thickness = elements_ * upper;
    const auto found     = walls(x, states, thickness);
    for (std::size_t a = 0; a < found.size(); ++a)
      for (std::size_t b = a + 1; b < found.size(); ++b)
        if (!found[a].is_symmetry)
          if (const double c = -(found[a].n * found[b].n); c > 0.5)
          {
            const double t =
              (found[b].is_symmetry ? 2. : 1.) * (found[a].delta + found[b].delta) / (2. * c - 1.);
            if (t > closed_gap * smallest_)
              thickness = std::min(thickness, t);
          }
    return std::max(thickness / elements_, smallest_);
  }

  double
  GapSizes::below(const Vec3 &x, const double distance, const DieStates &states, const double upper) const
  {
    double     sum   = elements_ * upper;
    const auto found = walls(x, states, sum + 2. * distance);
    for (std::size_t a = 0; a < found.size(); ++a)
      for (std::size_t b = a + 1; b < found.size(); ++b)
        if (!found[a].is_symmetry)
          sum = std::min(
            sum, (found[b].is_symmetry ? 2. : 1.) * (found[a].delta + found[b].delta - 2. * distance));
    return std::max(sum / elements_, smallest_);
  }
} // namespace retroforge
