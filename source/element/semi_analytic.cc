// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/element/semi_analytic.h>

namespace retroforge
{
  namespace
  {
    /// @param f  of positions as X is
    template <typename Positions, typename Scalar>
    Positions
    differences(const Positions &X, const double volume, const ShapeDerivatives &how, const Scalar &f)
    {
      const bool   central = how.method == ShapeDerivatives::Method::central;
      const double step    = how.perturbation * std::cbrt(6. * std::abs(volume));
      const double here    = central ? 0. : f(X);
      Positions    slope   = X;
      for (unsigned int a = 0; a < X.size(); ++a)
        for (unsigned int i = 0; i < 3; ++i)
        {
          Positions moved = X;
          moved[a][i] += step;
          // The step as it was rounded, not as it was meant.
          const double plus = moved[a][i], there = f(moved);
          if (!central)
          {
            slope[a][i] = (there - here) / (plus - X[a][i]);
            continue;
          }
          moved[a][i] = X[a][i] - step;
          slope[a][i] = (there - f(moved)) / (plus - moved[a][i]);
        }
      return slope;
    }

    double contraction(const CellValues<double> &r, const CellValues<double> &lambda)
    {
      double sum = r.beta * lambda.beta;
      for (unsigned int a = 0; a < 4; ++a)
        sum += r.V[a] * lambda.V[a] + r.P[a] * lambda.P[a];
      return sum;
    }

    double contraction(const TaylorHoodValues<double> &r, const TaylorHoodValues<double> &lambda)
    {
      double sum = 0.;
      for (unsigned int a = 0; a < 10; ++a)
        sum += r.V[a] * lambda.V[a];
      for (unsigned int a = 0; a < 4; ++a)
        sum += r.P[a] * lambda.P[a];
      return sum;
    }

    double contraction(const QuadratureValues<3, double> &r, const QuadratureValues<3, double> &lambda)
    {
      double sum = 0.;
      for (unsigned int a = 0; a < r.V.size(); ++a)
        sum += r.V[a] * lambda.V[a];
      for (unsigned int a = 0; a < r.P.size(); ++a)
        sum += r.P[a] * lambda.P[a];
      return sum;
    }
  } // namespace

  template <typename Values>
  Four<Vec3> difference_cell_residual(const Four<Vec3>          &X,
                                      const Values              &w,
                                      const Values              &lambda,
                                      const MaterialLaw<double> &law,
                                      const ShapeDerivatives    &how)
  {
    return differences(X, cell_geometry(X).volume, how, [&](const Four<Vec3> &at) {
      return contraction(cell_residual(cell_geometry(at), w, law), lambda);
    });
  }

  template <typename Values>
  Four<Vec3> difference_cell_dissipation(const Four<Vec3>          &X,
                                         const Values              &w,
                                         const MaterialLaw<double> &law,
                                         const double               weight,
                                         const ShapeDerivatives    &how)
  {
    return differences(X, cell_geometry(X).volume, how, [&](const Four<Vec3> &at) {
      return weight * cell_dissipation(cell_geometry(at), w, law);
    });
  }

  CellVectors<3, double> difference_cell_residual(const QuadratureGeometry<3, double> &geometry,
                                                  const QuadratureValues<3, double>   &w,
                                                  const QuadratureValues<3, double>   &lambda,
                                                  const MaterialLaw<double>           &law,
                                                  const ShapeDerivatives              &how)
  {
    return differences(geometry.X, cell_volume(geometry), how, [&](const CellVectors<3, double> &at) {
      const QuadratureGeometry<3, double> moved{geometry.element, at};
      return contraction(cell_residual(moved, w, law), lambda);
    });
  }

  CellVectors<3, double> difference_cell_dissipation(const QuadratureGeometry<3, double> &geometry,
                                                     const QuadratureValues<3, double>   &w,
                                                     const MaterialLaw<double>           &law,
                                                     const double                         weight,
                                                     const ShapeDerivatives              &how)
  {
    return differences(geometry.X, cell_volume(geometry), how, [&](const CellVectors<3, double> &at) {
      const QuadratureGeometry<3, double> moved{geometry.element, at};
      return weight * cell_dissipation(moved, w, law);
    });
  }

#define RETROFORGE_INSTANTIATE(Values)                                      \
  template Four<Vec3> difference_cell_residual(const Four<Vec3> &,          \
                                               const Values &,              \
                                               const Values &,              \
                                               const MaterialLaw<double> &, \
                                               const ShapeDerivatives &);   \
  template Four<Vec3> difference_cell_dissipation(                          \
    const Four<Vec3> &, const Values &, const MaterialLaw<double> &, double, const ShapeDerivatives &);
  RETROFORGE_INSTANTIATE(CellValues<double>)
  RETROFORGE_INSTANTIATE(TaylorHoodValues<double>)
#undef RETROFORGE_INSTANTIATE
} // namespace retroforge
