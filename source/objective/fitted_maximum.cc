// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/objective/fitted_maximum.h>

#include <deal.II/base/exceptions.h>

#include <algorithm>
#include <array>

namespace retroforge
{
  namespace
  {
    /// Exponents of M over that of its root.
    constexpr double above = 12., below = 11.;

    /// Over M(F): where damping begins, and by how much more a fit can be.
    constexpr double damped_from = 1.05, damped_over = 0.1;

    /// Of the determinant over the square of the first moment, below which there is one point to fit.
    constexpr double one_point = 1e-12;

    /// Sums of l (1 - D_r²) times F^4, F^4 D, F^4 D², F^3, F^3 D.
    template <typename Number>
    using Moments = std::array<Number, 5>;

    double kernel(const double D)
    {
      return std::abs(D) < 1. ? 1. - D * D : 0.;
    }

    /// D and 1 - D_r² of increment j in the fit at i.
    template <typename Number>
    Number distance(const std::size_t i, const std::size_t j, const ForcePath<Number> &path)
    {
      return (path.place[j] - path.recorded[i]) / path.reach;
    }
    template <typename Number>
    double weight(const std::size_t i, const std::size_t j, const ForcePath<Number> &path)
    {
      return kernel((path.recorded[j] - path.recorded[i]) / path.reach);
    }

    template <typename Number>
    Moments<Number> moments_at(const std::size_t i, const ForcePath<Number> &path, const double scale)
    {
      Moments<Number> m;
      m.fill(Number(0.));
      for (std::size_t j = 0; j < path.size(); ++j)
        if (const double w = weight(i, j, path); w > 0. && value_of(path.force[j]) > 0.)
        {
          const Number D = distance(i, j, path), F = path.force[j] / scale;
          const Number w3 = w * path.length[j] * F * F * F, w4 = w3 * F;
          m[0] += w4;
          m[1] += w4 * D;
          m[2] += w4 * D * D;
          m[3] += w3;
          m[4] += w3 * D;
        }
      return m;
    }

    void reverse_moments(const std::size_t        i,
                         const ForcePath<double> &path,
                         const double             scale,
                         const Moments<double>   &bar,
                         ForcePath<double>       &path_bar)
    {
      for (std::size_t j = 0; j < path.size(); ++j)
        if (const double w = weight(i, j, path); w > 0. && path.force[j] > 0.)
        {
          const double D = distance(i, j, path), F = path.force[j] / scale, F3 = F * F * F;
          const double of_w4 = bar[0] + D * (bar[1] + D * bar[2]), of_w3 = bar[3] + D * bar[4];
          path_bar.force[j] += w * path.length[j] * F * F * (4. * F * of_w4 + 3. * of_w3) / scale;
          path_bar.length[j] += w * F3 * (F * of_w4 + of_w3);
          path_bar.place[j] +=
            w * path.length[j] * F3 * (F * (bar[1] + 2. * D * bar[2]) + bar[4]) / path.reach;
        }
    }

    /// F̃ over the scale.
    template <typename Number>
    Number fitted(const Moments<Number> &m, const Number &limit)
    {
      using std::exp;
      const Number determinant = m[0] * m[2] - m[1] * m[1];
      const bool   is_line     = value_of(determinant) > one_point * value_of(m[0]) * value_of(m[0]);
      const Number a    = is_line ? Number((m[3] * m[2] - m[4] * m[1]) / determinant) : Number(m[3] / m[0]);
      const Number part = limit * a;
      if (value_of(part) >= 1. / damped_from)
        return 1. / a;
      constexpr double width = damped_over / (damped_from * damped_from);
      return limit * (damped_from + damped_over * (1. - exp(Number((part - 1. / damped_from) / width))));
    }

    template <typename Number>
    double largest_of(const std::vector<Number> &x)
    {
      double largest = 0.;
      for (const Number &y : x)
        largest = std::max(largest, value_of(y));
      return largest;
    }

    /// Whether fits have something to be made of.
    template <typename Number>
    bool is_fitted(const ForcePath<Number> &path)
    {
      return path.reach > 0. && largest_of(path.force) > 0.;
    }

    template <typename Number>
    std::vector<Number> fitted_forces(const ForcePath<Number> &path, const Number &limit, const double scale)
    {
      std::vector<Number> forces = path.force;
      for (std::size_t i = 0; i < path.size(); ++i)
        if (const auto m = moments_at(i, path, scale); value_of(m[0]) > 0.)
          forces[i] = scale * fitted<Number>(m, limit / scale);
      return forces;
    }

    /// Adds what follows from the fitted forces.  @return the derivative in the limit
    double reverse_fitted_forces(const ForcePath<double>   &path,
                                 const double               limit,
                                 const double               scale,
                                 const std::vector<double> &fitted_bar,
                                 ForcePath<double>         &path_bar)
    {
      double limit_bar = 0.;
      for (std::size_t i = 0; i < path.size(); ++i)
      {
        const Moments<double> m = moments_at(i, path, scale);
        if (!(m[0] > 0.))
        {
          path_bar.force[i] += fitted_bar[i];
          continue;
        }
        Moments<Dual> at;
        std::copy(m.begin(), m.end(), at.begin());
        Dual       L(limit / scale);
        const auto derivative = [&](Dual &input) {
          input.fastAccessDx(0) = 1.;
          const double slope    = fitted<Dual>(at, L).dx(0);
          input.fastAccessDx(0) = 0.;
          return slope;
        };
        Moments<double> bar;
        for (std::size_t k = 0; k < bar.size(); ++k)
          bar[k] = scale * fitted_bar[i] * derivative(at[k]);
        limit_bar += fitted_bar[i] * derivative(L);
        reverse_moments(i, path, scale, bar, path_bar);
      }
      return limit_bar;
    }

    SmoothMaximum sharper(SmoothMaximum maximum, const double factor)
    {
      maximum.sharpness *= factor;
      return maximum;
    }
  } // namespace

  FittedMaximum::FittedMaximum(const SmoothMaximum &maximum)
      : maximum_(maximum), upper_(sharper(maximum, above)), lower_(sharper(maximum, below))
  {
  }

  template <typename Number>
  Number FittedMaximum::largest(const std::vector<Number> &x, const std::vector<Number> &length) const
  {
    const double scale = largest_of(x);
    Number       sum(0.), weights(0.);
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      sum += upper_.term(x[i], length[i], scale);
      weights += lower_.term(x[i], length[i], scale);
    }
    return maximum_.combine(sum, weights, scale);
  }

  void FittedMaximum::reverse_largest(const std::vector<double> &x,
                                      const std::vector<double> &length,
                                      const double               bar,
                                      std::vector<double>       &x_bar,
                                      std::vector<double>       &length_bar) const
  {
    const double scale = largest_of(x);
    Dual         sum(0.), weights(0.);
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      sum += upper_.term(x[i], length[i], scale);
      weights += lower_.term(x[i], length[i], scale);
    }
    sum.fastAccessDx(0)      = 1.;
    const double sum_bar     = bar * maximum_.combine(sum, weights, scale).dx(0);
    sum.fastAccessDx(0)      = 0.;
    weights.fastAccessDx(0)  = 1.;
    const double weights_bar = bar * maximum_.combine(sum, weights, scale).dx(0);
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      x_bar[i] += length[i] * (sum_bar * upper_.slope(x[i], scale) + weights_bar * lower_.slope(x[i], scale));
      length_bar[i] += sum_bar * upper_.term(x[i], 1., scale) + weights_bar * lower_.term(x[i], 1., scale);
    }
  }

  template <typename Number>
  Number FittedMaximum::value(const ForcePath<Number> &path) const
  {
    AssertDimension(path.length.size(), path.size());
    AssertDimension(path.place.size(), path.size());
    AssertDimension(path.recorded.size(), path.size());
    const Number limit = largest(path.force, path.length);
    return is_fitted(path) ? largest(fitted_forces(path, limit, largest_of(path.force)), path.length) : limit;
  }

  ForcePath<double> FittedMaximum::reverse(const ForcePath<double> &path) const
  {
    const std::vector<double> none(path.size(), 0.);
    ForcePath<double>         bar{none, none, none, {}, 0.};
    double                    limit_bar = 1.;
    if (is_fitted(path))
    {
      const double              limit = largest(path.force, path.length), scale = largest_of(path.force);
      const std::vector<double> forces = fitted_forces(path, limit, scale);
      std::vector<double>       fitted_bar(path.size(), 0.);
      reverse_largest(forces, path.length, 1., fitted_bar, bar.length);
      limit_bar = reverse_fitted_forces(path, limit, scale, fitted_bar, bar);
    }
    reverse_largest(path.force, path.length, limit_bar, bar.force, bar.length);
    return bar;
  }

  template double FittedMaximum::value(const ForcePath<double> &) const;
  template Dual   FittedMaximum::value(const ForcePath<Dual> &) const;
} // namespace retroforge
