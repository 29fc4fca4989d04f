// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/design/billet_shapes.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  namespace
  {
    // 0 up to `from`, 1 from `to` on, linear between.
    double ramp(const double x, const double from, const double to)
    {
      return std::clamp((x - from) / (to - from), 0., 1.);
    }

    // 0 up to `from`, 1 at `peak`, 0 from `to` on, linear between.
    double hat(const double x, const double from, const double peak, const double to)
    {
      return std::min(ramp(x, from, peak), 1. - ramp(x, peak, to));
    }

    // Derivatives of r in mu2 and mu4, and of z in mu1 and mu3, at a point of the section.
    //
    // z: nothing moves below the fixed height; mu3 is taken along linearly from there to its line and back to
    // zero at the top, mu1 from the line of mu3 to the top.
    // r: above the line of mu3, mu2 is a hat with its peak on its own line, and mu4 begins at the line of
    // mu2, so that the parabola there scales in r. Below the fixed height mu4 begins at the end r6 of the
    // base, so that the parabola below scales in r. Between these heights one goes over into the other.
    struct SectionRates
    {
      double z_mu1, r_mu2, z_mu3, r_mu4;
    };

    SectionRates rates(const RingProfile &ring, const double r, const double z)
    {
      const auto  &mu     = ring.mu;
      const double fixed  = ring.fixed_height();
      const double upper  = ramp(z, fixed, mu[2]);
      const double r_base = ramp(r, ring.base_outer_radius, mu[3]), r_top = ramp(r, mu[1], mu[3]);
      return {ramp(z, mu[2], mu[0]),
              upper * hat(r, ring.base_inner_radius, mu[1], mu[3]),
              hat(z, fixed, mu[2], mu[0]),
              (1. - upper) * r_base + upper * r_top};
    }
  } // namespace

  BilletShapes ring_shapes(const BilletParameters &billet, const NodalVectors<double> &X)
  {
    const RingProfile           ring = billet.ring;
    std::vector<ShapeParameter> parameters;
    for (unsigned int j = 0; j < 4; ++j)
      parameters.push_back({"mu" + std::to_string(j + 1), "mm", ring.mu[j], ring.mu[j], {}});
    for (const Vec3 &x : X)
    {
      const double       r        = std::hypot(x[0], x[1]); // above the bore's radius: not zero
      const SectionRates rate     = rates(ring, r, x[2]);
      const Vec3         outwards = Vec3({x[0] / r, x[1] / r, 0.}), upwards = Vec3({0., 0., 1.});
      parameters[0].direction.push_back(rate.z_mu1 * upwards);
      parameters[1].direction.push_back(rate.r_mu2 * outwards);
      parameters[2].direction.push_back(rate.z_mu3 * upwards);
      parameters[3].direction.push_back(rate.r_mu4 * outwards);
    }
    return {parameters,
            [ring](const std::vector<double> &mu) {
              return ring.complaint({{mu[0], mu[1], mu[2], mu[3]}});
            },
            [billet](const std::vector<double> &mu) {
              BilletParameters measured = billet;
              std::copy_n(mu.begin(), 4, measured.ring.mu.begin());
              return measured;
            }};
  }
} // namespace retroforge
