// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/text.h>
#include <retroforge/objective/smooth_region.h>

namespace retroforge
{
  namespace
  {
    /// Weight of the two sides of the box across axis i.
    template <typename Number>
    Number across(const SmoothRegion &region, const Vector3<Number> &x, const unsigned int i)
    {
      const FrictionRamp ramp{region.width, false};
      return ramp(Number(region.box.first[i] - x[i]), false) *
             ramp(Number(x[i] - region.box.second[i]), false);
    }
  } // namespace

  void SmoothRegion::check(const std::string &where) const
  {
    if (!(width > 0.))
      throw Error(where,
                  "the width of the region's edge is " + as_text(width) + " mm",
                  "it must be positive",
                  "use an element's edge");
    for (unsigned int i = 0; i < 3; ++i)
      if (!(box.first[i] < box.second[i]))
        throw Error(where,
                    "the region goes from " + as_text(box.first[i]) + " to " + as_text(box.second[i]),
                    "its first corner must be the lower one",
                    "give the lower coordinates first");
  }

  template <typename Number>
  Number SmoothRegion::operator()(const Vector3<Number> &x) const
  {
    return across(*this, x, 0) * across(*this, x, 1) * across(*this, x, 2);
  }

  Vec3 SmoothRegion::gradient(const Vec3 &x) const
  {
    const FrictionRamp ramp{width, false};
    Vec3               gradient;
    for (unsigned int i = 0; i < 3; ++i)
    {
      const double below = box.first[i] - x[i], above = x[i] - box.second[i];
      gradient[i] =
        (ramp(below, false) * ramp.derivative(above) - ramp(above, false) * ramp.derivative(below)) *
        across(*this, x, (i + 1) % 3) * across(*this, x, (i + 2) % 3);
    }
    return gradient;
  }

  template double SmoothRegion::operator()(const Vector3<double> &) const;
  template Dual SmoothRegion::operator()(const Vector3<Dual> &) const;
} // namespace retroforge
