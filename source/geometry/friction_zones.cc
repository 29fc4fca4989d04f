// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/dual.h>
#include <retroforge/geometry/friction_zones.h>

#include <deal.II/base/exceptions.h>

namespace retroforge
{
  namespace
  {
    /// s: 0 below -1/2, 1 above 1/2, its first two derivatives continuous.
    template <typename Number>
    Number rise(const Number &y)
    {
      const double at = value_of(y);
      if (at <= -0.5 || at >= 0.5)
        return Number(at < 0. ? 0. : 1.);
      const Number t = y + 0.5;
      return t * t * t * (10. - t * (15. - 6. * t));
    }

    double slope(const double y)
    {
      return y <= -0.5 || y >= 0.5 ? 0. : 30. * (y + 0.5) * (y + 0.5) * (0.5 - y) * (0.5 - y);
    }

    /// Along axis i.
    template <typename Number>
    Number across(const FrictionZones   &zones,
                  const unsigned int     zone,
                  const Vector3<Number> &x,
                  const unsigned int     i)
    {
      const auto &[low, high] = zones.boxes[zone];
      return rise(Number((x[i] - low[i]) / zones.edge)) - rise(Number((x[i] - high[i]) / zones.edge));
    }
  } // namespace

  template <typename Number>
  Number FrictionZones::weight(const unsigned int zone, const Vector3<Number> &x) const
  {
    AssertIndexRange(zone, boxes.size());
    return across(*this, zone, x, 0) * across(*this, zone, x, 1) * across(*this, zone, x, 2);
  }

  Vec3 FrictionZones::gradient(const unsigned int zone, const Vec3 &x) const
  {
    AssertIndexRange(zone, boxes.size());
    const auto &[low, high] = boxes[zone];
    Vec3 gradient;
    for (unsigned int i = 0; i < 3; ++i)
      gradient[i] = (slope((x[i] - low[i]) / edge) - slope((x[i] - high[i]) / edge)) / edge *
                    across(*this, zone, x, (i + 1) % 3) * across(*this, zone, x, (i + 2) % 3);
    return gradient;
  }

  template double FrictionZones::weight(unsigned int, const Vec3 &) const;
  template Dual   FrictionZones::weight(unsigned int, const Vector3<Dual> &) const;
} // namespace retroforge
