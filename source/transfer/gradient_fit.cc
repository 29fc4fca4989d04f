// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/dual.h>
#include <retroforge/geometry/vector_algebra.h>
#include <retroforge/transfer/gradient_fit.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace retroforge
{
  namespace
  {
    constexpr unsigned int max_unknowns = 19;

    // eps_2 and eps_3 over the mean entry that the normal matrix has for the gradient.
    constexpr double damping_of_second = 1e-6, damping_of_third = 1e-4;
    // Points on a plane or line do not determine the gradient across it; relative like eps.
    constexpr double least_pivot = 1e-13;
    // Added to |d_b|^4: points that are nearer have no more weight.
    constexpr double least_fourth_power = 1e-12;

    template <typename Number>
    using Monomials = std::array<Number, max_unknowns>;

    constexpr unsigned int n_second(const unsigned int n)
    {
      return n * (n + 1) / 2;
    }

    constexpr unsigned int n_third(const unsigned int n)
    {
      return n * (n + 1) * (n + 2) / 6;
    }

    // The products of three components of d, those of two, then its n components.
    template <typename Number>
    Monomials<Number> monomials(const Vector3<Number> &d, const unsigned int n)
    {
      Monomials<Number> m = {};
      unsigned int      k = 0;
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = i; j < n; ++j)
          for (unsigned int l = j; l < n; ++l)
            m[k++] = d[i] * d[j] * d[l];
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = i; j < n; ++j)
          m[k++] = d[i] * d[j];
      for (unsigned int i = 0; i < n; ++i)
        m[k++] = d[i];
      return m;
    }

    // Their gradients.
    Monomials<Vec3> monomial_gradients(const Vec3 &d, const unsigned int n)
    {
      Monomials<Vec3> g = {};
      unsigned int    k = 0;
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = i; j < n; ++j)
          for (unsigned int l = j; l < n; ++l, ++k)
          {
            g[k][i] += d[j] * d[l];
            g[k][j] += d[i] * d[l];
            g[k][l] += d[i] * d[j];
          }
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = i; j < n; ++j, ++k)
        {
          g[k][i] += d[j];
          g[k][j] += d[i];
        }
      for (unsigned int i = 0; i < n; ++i, ++k)
        g[k][i] = 1.;
      return g;
    }

    // How many components of a symmetric tensor a monomial stands for, in their order: its coefficient is as many
    // times the component.
    std::vector<double> components_of_monomials(const unsigned int n)
    {
      std::vector<double> count;
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = i; j < n; ++j)
          for (unsigned int l = j; l < n; ++l)
            count.push_back(i == l ? 1. : i == j || j == l ? 3. : 6.);
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = i; j < n; ++j)
          count.push_back(i == j ? 1. : 2.);
      return count;
    }

    // Row i of a lower triangle begins here.
    constexpr unsigned int row(const unsigned int i)
    {
      return i * (i + 1) / 2;
    }
  } // namespace

  template <typename Number>
  GradientFit<Number>::GradientFit(const std::vector<Vector3<Number>> &points, const unsigned int n)
      : n_(n)
      , n_third_(n_third(n))
      , first_(n_third(n) + n_second(n))
      , size_(first_ + n)
      , unit_(0.)
      , scale_(0.)
  {
    using std::sqrt;
    for (const Vector3<Number> &d : points)
      unit_ += 2. * (d * d) / double(points.size());
    unit_ = value_of(unit_) > 0. ? Number(sqrt(unit_)) : Number(0.);
    if (value_of(unit_) == 0.)
      return;
    factor_.assign(row(size_), Number(0.));
    for (const Vector3<Number> &d : points)
    {
      points_.push_back(d / unit_);
      const Number square = points_.back() * points_.back();
      weights_.push_back(1. / (square * square + least_fourth_power));
      scale_ += weights_.back() * square / double(n_);
      const auto        m        = monomials(points_.back(), n_);
      Monomials<Number> weighted = m;
      for (Number &entry : weighted)
        entry *= weights_.back();
      for (unsigned int i = 0; i < size_; ++i)
        for (unsigned int j = 0; j <= i; ++j)
          factor_[row(i) + j] += weighted[i] * m[j];
    }
    factorise();
  }

  template <typename Number>
  double GradientFit<Number>::damping(const unsigned int i) const
  {
    static const std::array<std::vector<double>, 3> counts = {
      {components_of_monomials(1), components_of_monomials(2), components_of_monomials(3)}};
    return i < first_ ? (i < n_third_ ? damping_of_third : damping_of_second) / counts[n_ - 1][i] : 0.;
  }

  // Cholesky's factor in place of the damped lower triangle; empty when a pivot is lost.
  template <typename Number>
  void GradientFit<Number>::factorise()
  {
    using std::sqrt;
    const auto A = [&](const unsigned int i, const unsigned int j) -> Number & {
      return factor_[row(i) + j];
    };
    for (unsigned int i = 0; i < first_; ++i)
      A(i, i) += damping(i) * scale_;
    for (unsigned int j = 0; j < size_; ++j)
      for (unsigned int i = j; i < size_; ++i)
      {
        for (unsigned int k = 0; k < j; ++k)
          A(i, j) -= A(i, k) * A(j, k);
        if (i > j)
          A(i, j) /= A(j, j);
        else if (value_of(A(j, j)) > least_pivot * value_of(scale_))
          A(j, j) = sqrt(A(j, j));
        else
        {
          factor_.clear();
          return;
        }
      }
  }

  template <typename Number>
  std::vector<Number> GradientFit<Number>::solved(std::vector<Number> x) const
  {
    const auto L = [&](const unsigned int i, const unsigned int j) -> const Number & {
      return factor_[row(i) + j];
    };
    for (unsigned int i = 0; i < size_; ++i)
    {
      for (unsigned int k = 0; k < i; ++k)
        x[i] -= L(i, k) * x[k];
      x[i] /= L(i, i);
    }
    for (unsigned int i = size_; i-- > 0;)
    {
      for (unsigned int k = i + 1; k < size_; ++k)
        x[i] -= L(k, i) * x[k];
      x[i] /= L(i, i);
    }
    return x;
  }

  template <typename Number>
  std::vector<Number> GradientFit<Number>::solution(const Vector3<Number> &direction,
                                                    std::vector<Number>   &coefficients) const
  {
    std::vector<Number> sum(size_, Number(0.));
    coefficients.assign(points_.size(), Number(0.));
    // Again and again: that removes the rounding of the times before from linear fields.
    for (unsigned int pass = 0; pass < 3; ++pass)
    {
      std::vector<Number> rest(size_, Number(0.));
      for (unsigned int i = 0; i < n_; ++i)
        rest[first_ + i] = direction[i] / unit_;
      for (std::size_t b = 0; b < points_.size(); ++b)
        for (unsigned int i = 0; i < n_; ++i)
          rest[first_ + i] -= coefficients[b] * points_[b][i];
      const auto z = solved(std::move(rest));
      for (unsigned int i = 0; i < size_; ++i)
        sum[i] += z[i];
      for (std::size_t b = 0; b < points_.size(); ++b)
      {
        const auto m = monomials(points_[b], n_);
        for (unsigned int i = 0; i < size_; ++i)
          coefficients[b] += z[i] * Number(m[i] * weights_[b]);
      }
    }
    return sum;
  }

  template <typename Number>
  std::vector<Number> GradientFit<Number>::coefficients(const Vector3<Number> &direction) const
  {
    Assert(is_determined(), dealii::ExcInternalError());
    std::vector<Number> c;
    solution(direction, c);
    return c;
  }

  // With M the damped normal matrix, M z = (0, direction) and M y = sum_b c_bar_b w_b m(d_b), the derivative is that of
  // sum_b (c_bar_b - y·m(d_b)) w_b z·m(d_b)  where y, z and c_bar are held, less that of the damping.
  template <>
  void GradientFit<double>::reverse(const Vec3                &direction,
                                    const std::vector<double> &c_bar,
                                    std::vector<Vec3>         &points_bar,
                                    Vec3                      &direction_bar) const
  {
    AssertDimension(c_bar.size(), points_.size());
    AssertDimension(points_bar.size(), points_.size());
    std::vector<double> c, of_c(size_, 0.);
    const auto          z = solution(direction, c);
    for (std::size_t b = 0; b < points_.size(); ++b)
    {
      const auto m = monomials(points_[b], n_);
      for (unsigned int i = 0; i < size_; ++i)
        of_c[i] += c_bar[b] * weights_[b] * m[i];
    }
    const auto y         = solved(std::move(of_c));
    double     scale_bar = 0.;
    for (unsigned int i = 0; i < first_; ++i)
      scale_bar -= damping(i) * y[i] * z[i];
    double unit_bar = 0.;
    for (std::size_t b = 0; b < points_.size(); ++b)
    {
      const Vec3 &d    = points_[b];
      const auto  m    = monomials(d, n_);
      const auto  dm   = monomial_gradients(d, n_);
      double      of_y = 0., of_z = 0.;
      Vec3        dy, dz;
      for (unsigned int i = 0; i < size_; ++i)
      {
        of_y += y[i] * m[i];
        of_z += z[i] * m[i];
        dy += y[i] * dm[i];
        dz += z[i] * dm[i];
      }
      const double w = weights_[b], square = d.norm_square();
      const Vec3   dw  = -4. * w * w * square * d;
      const Vec3   bar = w * ((c_bar[b] - of_y) * dz - of_z * dy) + (c_bar[b] - of_y) * of_z * dw +
                       scale_bar / n_ * (square * dw + 2. * w * d);
      points_bar[b] += bar / unit_;
      unit_bar -= bar * d / unit_;
    }
    for (unsigned int i = 0; i < n_; ++i)
    {
      direction_bar[i] += y[first_ + i] / unit_;
      unit_bar -= y[first_ + i] * direction[i] / (unit_ * unit_);
    }
    for (std::size_t b = 0; b < points_.size(); ++b)
      points_bar[b] += 2. * unit_bar / points_.size() * points_[b];
  }

  template class GradientFit<double>;
  template class GradientFit<Dual>;
} // namespace retroforge
