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

  KeptSkins::KeptSkins(const NodeSkins<double> &skins)
      : n_nodes_(skins.metal.size()), n_dies_(skins.dies.size())
  {
    const Skin<double> none;
    for (NodeIndex k = 0; k < n_nodes_; ++k)
    {
      bool is_there = skins.metal[k] != none;
      for (const auto &die : skins.dies)
        is_there = is_there || die[k] != none;
      if (!is_there)
        continue;
      nodes_.push_back(k);
      skins_.push_back(skins.metal[k]);
      for (const auto &die : skins.dies)
        skins_.push_back(die[k]);
    }
  }

  NodeSkins<double> KeptSkins::all() const
  {
    if (n_nodes_ == 0)
      return {};
    auto skins = NodeSkins<double>::none(n_nodes_, n_dies_);
    auto next  = skins_.begin();
    for (const NodeIndex k : nodes_)
    {
      skins.metal[k] = *next++;
      for (auto &die : skins.dies)
        die[k] = *next++;
    }
    return skins;
  }

  // With n_j = m_j/sqrt(beta_j) the equation is  n' = -S n + rate v,  S = diag(lambda) + rate v v^T,  v = sqrt(beta):
  // a symmetric matrix.

  SkinsBeneathFilm::SkinsBeneathFilm(const double rate) : rate(rate)
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
      eigenvalues[i] = values[i];
      source[i]      = 0.;
      for (unsigned int j = 0; j < n_skin_modes; ++j)
      {
        eigenvectors[i][j] = vectors(j, i);
        source[i] += vectors(j, i) * std::sqrt(skin_weights[j]);
      }
    }
  }

  SkinsBeneathFilm::Modes SkinsBeneathFilm::to_eigenvectors(const Skin<double> &m) const
  {
    Modes x{};
    for (unsigned int j = 0; j < n_skin_modes; ++j)
    {
      const double n = m[j] / std::sqrt(skin_weights[j]);
      for (unsigned int i = 0; i < n_skin_modes; ++i)
        x[i] += eigenvectors[i][j] * n;
    }
    return x;
  }

  Skin<double> SkinsBeneathFilm::from_eigenvectors(const Modes &x) const
  {
    Skin<double> m;
    for (unsigned int j = 0; j < n_skin_modes; ++j)
    {
      for (unsigned int i = 0; i < n_skin_modes; ++i)
        m[j] += eigenvectors[i][j] * x[i];
      m[j] *= std::sqrt(skin_weights[j]);
    }
    return m;
  }

  SkinPropagator::SkinPropagator(const SkinsBeneathFilm &film, const double time) : film_(film), time_(time)
  {
    Assert(time >= 0., dealii::ExcMessage("time goes on"));
    Modes after_source, mean_source;
    for (unsigned int i = 0; i < n_skin_modes; ++i)
    {
      const double z = film.eigenvalues[i] * time, out = film.rate * time * film.source[i];
      after_[i]       = std::exp(-z);
      mean_[i]        = g<1>(z);
      after_source[i] = mean_[i] * out;
      mean_source[i]  = g<2>(z) * out;
    }
    source_ = {film.from_eigenvectors(after_source), film.from_eigenvectors(mean_source)};
  }

  SkinStep<double> SkinPropagator::carried(const Skin<double> &before) const
  {
    const Modes x = film_.to_eigenvectors(before);
    Modes       after, mean;
    for (unsigned int i = 0; i < n_skin_modes; ++i)
    {
      after[i] = after_[i] * x[i];
      mean[i]  = mean_[i] * x[i];
    }
    return {film_.from_eigenvectors(after), film_.from_eigenvectors(mean)};
  }

  Skin<double> SkinPropagator::reverse_carried(const SkinStep<double> &bar) const
  {
    // Both are functions of S, symmetric in n: of m with the weights on either side the other way round.
    const auto scaled = [](Skin<double> m, const bool up) {
      for (unsigned int j = 0; j < n_skin_modes; ++j)
        m[j] *= up ? skin_weights[j] : 1. / skin_weights[j];
      return m;
    };
    const Modes after = film_.to_eigenvectors(scaled(bar.after, true)),
                mean  = film_.to_eigenvectors(scaled(bar.mean, true));
    Modes x;
    for (unsigned int i = 0; i < n_skin_modes; ++i)
      x[i] = after_[i] * after[i] + mean_[i] * mean[i];
    return scaled(film_.from_eigenvectors(x), false);
  }

  const SkinPropagator::Slopes &SkinPropagator::slopes() const
  {
    if (slopes_)
      return *slopes_;
    Slopes &d = slopes_.emplace();
    Modes   after_rate, mean_rate, after_time, mean_time;
    for (unsigned int i = 0; i < n_skin_modes; ++i)
    {
      const double w = film_.eigenvalues[i], z = w * time_, u = film_.source[i];
      after_rate[i]  = time_ * mean_[i] * u;
      mean_rate[i]   = time_ * g<2>(z) * u;
      after_time[i]  = film_.rate * u * after_[i];
      mean_time[i]   = film_.rate * u * (g<2>(z) + z * slope_of_g<2>(z));
      d.mean_time[i] = w * slope_of_g<1>(z);
      // S changes by v v^T: a function of it by its mean slopes between eigenvalues.
      for (unsigned int j = 0; j < n_skin_modes; ++j)
      {
        const double z_j = film_.eigenvalues[j] * time_, by = time_ * u * film_.source[j],
                     out = film_.rate * time_ * film_.source[j], slope = mean_slope_of_g<1>(z, z_j);
        d.after[i][j] = by * mean_slope_of_exp(z, z_j);
        d.mean[i][j]  = by * slope;
        after_rate[i] += by * slope * out;
        mean_rate[i] += by * mean_slope_of_g<2>(z, z_j) * out;
      }
    }
    d.of_source = {{{film_.from_eigenvectors(after_rate), film_.from_eigenvectors(mean_rate)},
                    {film_.from_eigenvectors(after_time), film_.from_eigenvectors(mean_time)}}};
    return d;
  }

  std::array<SkinStep<double>, 2> SkinPropagator::carried_slopes(const Skin<double> &before) const
  {
    const Slopes &d = slopes();
    const Modes   x = film_.to_eigenvectors(before);
    Modes         after_rate{}, mean_rate{}, after_time, mean_time;
    for (unsigned int i = 0; i < n_skin_modes; ++i)
    {
      for (unsigned int j = 0; j < n_skin_modes; ++j)
      {
        after_rate[i] += d.after[i][j] * x[j];
        mean_rate[i] += d.mean[i][j] * x[j];
      }
      after_time[i] = -film_.eigenvalues[i] * after_[i] * x[i];
      mean_time[i]  = d.mean_time[i] * x[i];
    }
    return {{{film_.from_eigenvectors(after_rate), film_.from_eigenvectors(mean_rate)},
             {film_.from_eigenvectors(after_time), film_.from_eigenvectors(mean_time)}}};
  }

  namespace
  {
    /// value + rate_dot slopes[0] + time_dot slopes[1] + what else changes it
    SkinStep<Dual> with_slopes(const SkinStep<double>                &value,
                               const std::array<SkinStep<double>, 2> &slopes,
                               const double                           rate_dot,
                               const double                           time_dot,
                               const SkinStep<double>                &dot = {})
    {
      SkinStep<Dual> made;
      for (unsigned int j = 0; j < n_skin_modes; ++j)
      {
        made.after[j] = Dual(value.after[j]);
        made.mean[j]  = Dual(value.mean[j]);
        made.after[j].fastAccessDx(0) =
          dot.after[j] + slopes[0].after[j] * rate_dot + slopes[1].after[j] * time_dot;
        made.mean[j].fastAccessDx(0) =
          dot.mean[j] + slopes[0].mean[j] * rate_dot + slopes[1].mean[j] * time_dot;
      }
      return made;
    }
  } // namespace

  SkinParts<Dual>
  skin_parts(const SkinPropagator &over, const Dual &rate, const Skin<Dual> &before, const Dual &time)
  {
    Skin<double> value, dot;
    for (unsigned int j = 0; j < n_skin_modes; ++j)
    {
      value[j] = before[j].val();
      dot[j]   = before[j].dx(0);
    }
    return {
      with_slopes(over.carried(value), over.carried_slopes(value), rate.dx(0), time.dx(0), over.carried(dot)),
      with_slopes(over.source(), over.source_slopes(), rate.dx(0), time.dx(0))};
  }

  SkinStep<double> healing(const double time)
  {
    SkinStep<double> left;
    for (unsigned int j = 0; j < n_skin_modes; ++j)
    {
      left.after[j] = std::exp(-skin_rates[j] * time);
      left.mean[j]  = g<1>(skin_rates[j] * time);
    }
    return left;
  }

  SkinStep<double> slope_of_healing(const double time)
  {
    SkinStep<double> slope;
    for (unsigned int j = 0; j < n_skin_modes; ++j)
    {
      slope.after[j] = -skin_rates[j] * std::exp(-skin_rates[j] * time);
      slope.mean[j]  = skin_rates[j] * slope_of_g<1>(skin_rates[j] * time);
    }
    return slope;
  }

  SkinStep<Dual> healing(const Dual &time)
  {
    return with_slopes(healing(time.val()), {{{}, slope_of_healing(time.val())}}, 0., time.dx(0));
  }
} // namespace retroforge
