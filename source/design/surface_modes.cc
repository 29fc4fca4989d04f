// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/design/surface_modes.h>
#include <retroforge/geometry/vector_algebra.h>

#include <deal.II/lac/lapack_full_matrix.h>

#include <cmath>
#include <numeric>

namespace retroforge
{
  Vec3 in_planes(Vec3 d, const std::vector<Vec3> &normals)
  {
    std::vector<Vec3> axes;
    for (Vec3 axis : normals)
    {
      for (const Vec3 &other : axes)
        axis -= (axis * other) * other;
      if (axis.norm() > 1e-6)
        axes.push_back(axis / axis.norm());
    }
    for (const Vec3 &axis : axes)
      d -= (d * axis) * axis;
    return d;
  }

  unsigned int MovingSurface::n_moving() const
  {
    unsigned int n = 0;
    for (unsigned int k = 0; k < points.size(); ++k)
      n += moves(k) ? 1 : 0;
    return n;
  }

  std::vector<double> MovingSurface::masses() const
  {
    std::vector<double> mass(points.size(), 0.);
    for (const Triangle &t : triangles)
      for (const unsigned int k : t)
        mass[k] += facet_vector(points[t[0]], points[t[1]], points[t[2]]).norm() / 6.;
    return mass;
  }

  double MovingSurface::area() const
  {
    const std::vector<double> mass = masses();
    double                    sum  = 0.;
    for (unsigned int k = 0; k < points.size(); ++k)
      sum += moves(k) ? mass[k] : 0.;
    return sum;
  }

  namespace
  {
    /// Moving points among all, and M^-1/2 (L + ties) M^-1/2 over them.
    class ScaledStiffness
    {
    public:
      explicit ScaledStiffness(const MovingSurface &surface)
          : surface_(surface), mass_(surface.masses()), place_(surface.points.size(), invalid_index)
      {
        for (unsigned int k = 0; k < place_.size(); ++k)
          if (surface.moves(k))
            place_[k] = n_++;
      }

      unsigned int place(const unsigned int point) const { return place_[point]; }
      double       mass(const unsigned int point) const { return mass_[point]; }

      /// @param stiffness  of ties, per mass [mm^-2]
      dealii::LAPACKFullMatrix<double> matrix(const double stiffness) const
      {
        dealii::LAPACKFullMatrix<double> A(n_, n_);
        A = 0.;
        for (const Triangle &t : surface_.triangles)
          for (unsigned int i = 0; i < 3; ++i)
            add_edge(t[i], t[(i + 1) % 3], t[(i + 2) % 3], A);
        for (const MovingSurface::Tie &tie : surface_.ties)
          for (const auto &[a, factor_a] : tie)
            for (const auto &[b, factor_b] : tie)
              add(a, b, stiffness * mass_[tie.front().first] * factor_a * factor_b, A);
        return A;
      }

    private:
      void add(const unsigned int                a,
               const unsigned int                b,
               const double                      value,
               dealii::LAPACKFullMatrix<double> &A) const
      {
        if (place_[a] != invalid_index && place_[b] != invalid_index)
          A(place_[a], place_[b]) += value / std::sqrt(mass_[a] * mass_[b]);
      }

      /// The edge from a to b, opposite of a triangle's corner.
      void add_edge(const unsigned int                corner,
                    const unsigned int                a,
                    const unsigned int                b,
                    dealii::LAPACKFullMatrix<double> &A) const
      {
        const Vec3  &x = surface_.points[corner];
        const Vec3   u = surface_.points[a] - x, v = surface_.points[b] - x;
        const double half = 0.5 * (u * v) / cross(u, v).norm();
        add(a, a, half, A);
        add(b, b, half, A);
        add(a, b, -half, A);
        add(b, a, -half, A);
      }

      const MovingSurface            &surface_;
      const std::vector<double>       mass_;
      std::vector<unsigned int>       place_;
      dealii::types::global_dof_index n_ = 0;
    };

    /// With its largest value positive. Of two that are nearly as large the first counts, so that rounding
    /// does not choose the sign.
    std::vector<double> with_sign(std::vector<double> mode)
    {
      double largest = 0.;
      for (const double value : mode)
        if (std::abs(value) > 1.001 * std::abs(largest))
          largest = value;
      if (largest < 0.)
        for (double &value : mode)
          value = -value;
      return mode;
    }
  } // namespace

  std::vector<std::vector<double>>
  surface_modes(const MovingSurface &surface, const unsigned int n, const double length)
  {
    const double               area = surface.area(), l = length > 0. ? length : std::sqrt(area) / 4.;
    const ScaledStiffness      stiffness(surface);
    dealii::Vector<double>     lambda;
    dealii::FullMatrix<double> vectors;
    // By Weyl's law the first n lie below  4 pi n / area,  on surfaces that are not all rim.
    for (double below = 8. * dealii::numbers::PI * (n + 4) / area; lambda.size() < n; below *= 4.)
    {
      auto A = stiffness.matrix(4. * below);
      A.compute_eigenvalues_symmetric(-1e-6 * below, below, 0., lambda, vectors);
    }
    std::vector<std::vector<double>> modes;
    for (unsigned int i = 0; i < n; ++i)
    {
      const double        size = std::sqrt(area / (1. + l * l * std::max(0., lambda(i))));
      std::vector<double> mode(surface.points.size(), 0.);
      for (unsigned int k = 0; k < mode.size(); ++k)
        if (surface.moves(k))
          mode[k] = size * vectors(stiffness.place(k), i) / std::sqrt(stiffness.mass(k));
      modes.push_back(with_sign(std::move(mode)));
    }
    return modes;
  }
} // namespace retroforge
