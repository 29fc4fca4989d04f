// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/heat/skin.h>

#include <deal.II/base/exceptions.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/lapack_full_matrix.h>

#include <cmath>

namespace retroforge
{
  namespace
  {
    // g_k(z) = integral over s from 0 to 1 of (1-s)^(k-1)/(k-1)! exp(-z s):  g_1 = (1 - exp(-z))/z,  g_2 = (1 - g_1)/z.
    // Of small z by their series sum_n (-z)^n/(n+k)!, where the closed forms cancel.

    template <int k>
    double g(const double z)
    {
      if (z >= 1.)
        return k == 1 ? -std::expm1(-z) / z : (1. + std::expm1(-z) / z) / z;
      double sum = 0., term = k == 1 ? 1. : 0.5;
      for (int n = 0; n < 20; term *= -z / (++n + k))
        sum += term;
      return sum;
    }

    /// dg_k/dz
    template <int k>
    double slope_of_g(const double z)
    {
      if (z >= 1.)
        return k == 1 ? (std::exp(-z) - g<1>(z)) / z : (g<1>(z) - 2. * g<2>(z)) / z;
      double sum = 0., term = k == 1 ? -0.5 : -1. / 6.; // of n = 1, over n
      for (int n = 1; n < 20; term *= -z / (++n + k))
        sum += n * term;
      return sum;
    }

    /// (g_k(a) - g_k(b))/(a - b), a mean slope, without cancellation.
    template <int k>
    double mean_slope_of_g(const double a, const double b)
    {
      if (std::abs(a - b) > 0.5)
        return (g<k>(a) - g<k>(b)) / (a - b);
      constexpr std::array<double, 4> point{
        {0.069431844202973712, 0.330009478207571868, 0.669990521792428132, 0.930568155797026288}};
      constexpr std::array<double, 4> weight{
        {0.173927422568726929, 0.326072577431273071, 0.326072577431273071, 0.173927422568726929}};
      double sum = 0.;
      for (unsigned int i = 0; i < 4; ++i)
        sum += weight[i] * slope_of_g<k>(b + point[i] * (a - b));
      return sum;
    }

    /// (exp(-a) - exp(-b))/(a - b)
    double mean_slope_of_exp(const double a, const double b)
    {
      return -std::exp(-std::min(a, b)) * g<1>(std::abs(a - b));
    }
  } // namespace

  // With n_j = m_j/sqrt(beta_j) the equation is  n' = -S n + rate v,  S = diag(lambda) + rate v v^T,  v = sqrt(beta):
  // a symmetric matrix.

  SkinsBeneathFilm::SkinsBeneathFilm(const double rate) : rate_(rate)
  {
    Assert(rate > 0., dealii::ExcMessage("skins are beneath a film"));
    dealii::LAPACKFullMatrix<double> S(n_skin_modes);
    dealii::FullMatrix<double>       vectors;
    for (unsigned int i = 0; i < n_skin_modes; ++i)
      for (unsigned int j = 0; j < n_skin_modes; ++j)
        S(i, j) = rate * std::sqrt(skin_weights[i] * skin_weights[j]) + (i == j ? skin_rates[i] : 0.);
    // All of them: the largest is below the trace.
    const double           largest = S.trace() * (1. + 1e-12);
    dealii::Vector<double> values;
    S.compute_eigenvalues_symmetric(0., largest, 0., values, vectors);
    AssertDimension(values.size(), n_skin_modes);
    for (unsigned int i = 0; i < n_skin_modes; ++i)
    {
      eigenvalues_[i] = values[i];
      source_[i]      = 0.;
      for (unsigned int j = 0; j < n_skin_modes; ++j)
      {
        eigenvectors_[i][j] = vectors(j, i);
        source_[i] += vectors(j, i) * std::sqrt(skin_weights[j]);
      }
    }
  }

  SkinsBeneathFilm::Modes SkinsBeneathFilm::to_eigenvectors(const Skin<double> &m) const
  {
    Modes x{};
    for (unsigned int i = 0; i < n_skin_modes; ++i)
      for (unsigned int j = 0; j < n_skin_modes; ++j)
        x[i] += eigenvectors_[i][j] * m[j] / std::sqrt(skin_weights[j]);
    return x;
  }

  Skin<double> SkinsBeneathFilm::from_eigenvectors(const Modes &x) const
  {
    Skin<double> m;
    for (unsigned int i = 0; i < n_skin_modes; ++i)
      for (unsigned int j = 0; j < n_skin_modes; ++j)
        m[j] += eigenvectors_[i][j] * x[i] * std::sqrt(skin_weights[j]);
    return m;
  }

  SkinStep<double> SkinsBeneathFilm::carried(const Skin<double> &before, const double time) const
  {
    const Modes x = to_eigenvectors(before);
    Modes       after, mean;
    for (unsigned int i = 0; i < n_skin_modes; ++i)
    {
      const double z = eigenvalues_[i] * time;
      after[i]       = std::exp(-z) * x[i];
      mean[i]        = g<1>(z) * x[i];
    }
    return {from_eigenvectors(after), from_eigenvectors(mean)};
  }

  SkinStep<double> SkinsBeneathFilm::step(const Skin<double> &before, const double time) const
  {
    Assert(time >= 0., dealii::ExcMessage("time goes on"));
    Modes after, mean;
    for (unsigned int i = 0; i < n_skin_modes; ++i)
    {
      const double z = eigenvalues_[i] * time, out = rate_ * time * source_[i];
      after[i] = g<1>(z) * out;
      mean[i]  = g<2>(z) * out;
    }
    const SkinStep<double> kept = carried(before, time);
    return {kept.after + from_eigenvectors(after), kept.mean + from_eigenvectors(mean)};
  }

  std::array<SkinStep<double>, 2> SkinsBeneathFilm::slopes(const Skin<double> &before,
                                                           const double        time) const
  {
    const Modes x = to_eigenvectors(before);
    Modes       after_rate, mean_rate, after_time, mean_time;
    for (unsigned int i = 0; i < n_skin_modes; ++i)
    {
      const double z = eigenvalues_[i] * time, u = source_[i];
      after_rate[i] = time * g<1>(z) * u;
      mean_rate[i]  = time * g<2>(z) * u;
      // S changes by v v^T: a function of it by its mean slopes between eigenvalues.
      for (unsigned int j = 0; j < n_skin_modes; ++j)
      {
        const double z_j = eigenvalues_[j] * time, by = time * u * source_[j],
                     out = rate_ * time * source_[j];
        after_rate[i] += by * (mean_slope_of_exp(z, z_j) * x[j] + mean_slope_of_g<1>(z, z_j) * out);
        mean_rate[i] += by * (mean_slope_of_g<1>(z, z_j) * x[j] + mean_slope_of_g<2>(z, z_j) * out);
      }
      after_time[i] = -eigenvalues_[i] * (std::exp(-z) * x[i] + g<1>(z) * rate_ * time * u) + rate_ * u;
      mean_time[i] = eigenvalues_[i] * slope_of_g<1>(z) * x[i] + rate_ * u * (g<2>(z) + z * slope_of_g<2>(z));
    }
    return {{{from_eigenvectors(after_rate), from_eigenvectors(mean_rate)},
             {from_eigenvectors(after_time), from_eigenvectors(mean_time)}}};
  }

  Skin<double> SkinsBeneathFilm::reverse_carried(const SkinStep<double> &bar, const double time) const
  {
    // Both are functions of S, symmetric in n: of m with the weights on either side the other way round.
    const auto scaled = [](Skin<double> m, const bool up) {
      for (unsigned int j = 0; j < n_skin_modes; ++j)
        m[j] *= up ? skin_weights[j] : 1. / skin_weights[j];
      return m;
    };
    const auto after = carried(scaled(bar.after, true), time), mean = carried(scaled(bar.mean, true), time);
    return scaled(after.after + mean.mean, false);
  }

  SkinStep<Dual>
  skin_step(const SkinsBeneathFilm &film, const Dual &rate, const Skin<Dual> &before, const Dual &time)
  {
    Skin<double> value, dot;
    for (unsigned int j = 0; j < n_skin_modes; ++j)
    {
      value[j] = before[j].val();
      dot[j]   = before[j].dx(0);
    }
    const auto     step = film.step(value, time.val());
    const auto     kept = film.carried(dot, time.val());
    const auto     by   = film.slopes(value, time.val());
    SkinStep<Dual> made;
    const auto     set = [&](const Skin<double> &of,
                         const Skin<double> &d,
                         const Skin<double> &by_rate,
                         const Skin<double> &by_time,
                         Skin<Dual>         &to) {
      for (unsigned int j = 0; j < n_skin_modes; ++j)
      {
        to[j]                 = Dual(of[j]);
        to[j].fastAccessDx(0) = d[j] + by_rate[j] * rate.dx(0) + by_time[j] * time.dx(0);
      }
    };
    set(step.after, kept.after, by[0].after, by[1].after, made.after);
    set(step.mean, kept.mean, by[0].mean, by[1].mean, made.mean);
    return made;
  }
} // namespace retroforge
