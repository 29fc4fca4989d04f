// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/heat/skin.h>

#include <deal.II/base/exceptions.h>

#include <array>

namespace retroforge
{
  namespace
  {
    /// u - ln(1+u) without cancellation, u >= 0.
    double log_rest(const double u)
    {
      if (u > 0.05)
        return u - std::log1p(u);
      double sum = 0., power = u;
      for (unsigned int i = 2; i < 14; ++i)
      {
        power *= -u;
        sum -= power / i;
      }
      return sum;
    }

    /// dG/dy
    double slope_of_G(const double y)
    {
      return y * (2. + y) / (1. + y);
    }

    /// d > 0 with  G(y+d) - G(y) = s,  from above by Newton's method: all terms are positive, nothing cancels.
    double rise(const double y, const double s)
    {
      double d = std::sqrt(2. * s);
      for (unsigned int i = 0; i < 100; ++i)
      {
        const double excess = d * (y + 0.5 * d) + d * y / (1. + y) + log_rest(d / (1. + y)) - s;
        const double change = excess / slope_of_G(y + d);
        if (!(change > 1e-15 * d))
          break;
        d -= change;
      }
      return d;
    }

    /// Mean of 1/(1+y) over G from y to y + d: the rise of  Z = y²/(1+y)  over that of G, s.
    double mean_theta(const double y, const double d, const double s)
    {
      const auto Z = [](const double x) { return x * x / (1. + x); };
      if (d > 0.1)
        return (Z(y + d) - Z(y)) / s;
      constexpr std::array<double, 4> point{
        {0.069431844202973712, 0.330009478207571868, 0.669990521792428132, 0.930568155797026288}};
      constexpr std::array<double, 4> weight{
        {0.173927422568726929, 0.326072577431273071, 0.326072577431273071, 0.173927422568726929}};
      double over = 0., under = 0.;
      for (unsigned int i = 0; i < 4; ++i)
      {
        const double x = y + point[i] * d;
        over += weight[i] * slope_of_G(x) / (1. + x);
        under += weight[i] * slope_of_G(x);
      }
      return over / under;
    }

    constexpr double four_thirds = 4. / 3.;
  } // namespace

  SkinStep<double>
  skin_step(const double e, const double h, const double b2, const double dt, SkinDerivatives *derivatives)
  {
    Assert(e >= 0. && h > 0. && b2 > 0. && dt > 0., dealii::ExcMessage("a skin is beneath a film"));
    const double per_e = four_thirds * h / b2, s = per_e * h * dt;
    const double y = skin_biot(e, h, b2), d = rise(y, s), mean = mean_theta(y, d, s);
    if (derivatives)
    {
      // In a = per_e e and s:  a' = a + s mean,  da'/da = (1+y)/(1+y'),  da'/ds = 1/(1+y').
      const double theta = 1. / (1. + y + d), mean_a = -d * theta / s, mean_s = (theta - mean) / s;
      const double a       = per_e * e;
      derivatives->mean_e  = mean_a * per_e;
      derivatives->mean_h  = (mean_a * a + 2. * mean_s * s) / h;
      derivatives->mean_b2 = -(mean_a * a + mean_s * s) / b2;
      derivatives->mean_dt = mean_s * s / dt;
      derivatives->e_e     = 1. + h * dt * derivatives->mean_e;
      derivatives->e_h     = dt * (mean + h * derivatives->mean_h);
      derivatives->e_b2    = h * dt * derivatives->mean_b2;
      derivatives->e_dt    = h * (mean + dt * derivatives->mean_dt);
    }
    return {e + h * dt * mean, mean};
  }

  HealedSkin healed_skin(const double e, const double h, const double b2, const double time)
  {
    Assert(e >= 0. && h > 0. && b2 > 0. && time > 0., dealii::ExcMessage("a skin heals in a time"));
    // dG/da = 1 + y,  a = 4/3 e h/b² = y²/(1+y):  a skin that grows takes the time de (1+y)/h.
    const double y = skin_biot(e, h, b2), scale = b2 / (four_thirds * h * h);
    const double age = scale * (0.5 * y * y + log_rest(y)), age_e = (1. + y) / h;
    const double age_h = (age_e * e - 2. * age) / h, age_b2 = (age - age_e * e) / b2;
    const double whole = age + 2. * time, part = age / whole, by_age = e * 2. * time / (whole * whole);
    return {e * part, part + by_age * age_e, by_age * age_h, by_age * age_b2, -2. * e * part / whole};
  }
} // namespace retroforge
