// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/element/semi_analytic.h>

namespace retroforge
{
  namespace
  {
    template <typename Scalar>
    Four<Vec3> differences(const Four<Vec3> &X, const ShapeDerivatives &how, const Scalar &f)
    {
      const bool   central = how.method == ShapeDerivatives::Method::central;
      const double step    = how.perturbation * std::cbrt(6. * std::abs(cell_geometry(X).volume));
      const double here    = central ? 0. : f(X);
      Four<Vec3>   slope;
      for (unsigned int a = 0; a < 4; ++a)
        for (unsigned int i = 0; i < 3; ++i)
        {
          Four<Vec3> moved = X;
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
  } // namespace

  template <typename Values>
  Four<Vec3> difference_cell_residual(const Four<Vec3>          &X,
                                      const Values              &w,
                                      const Values              &lambda,
                                      const MaterialLaw<double> &law,
                                      const ShapeDerivatives    &how)
  {
    return differences(X, how, [&](const Four<Vec3> &at) {
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
    return differences(
      X, how, [&](const Four<Vec3> &at) { return weight * cell_dissipation(cell_geometry(at), w, law); });
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
