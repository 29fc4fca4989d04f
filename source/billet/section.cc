// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/numbers.h>
#include <deal.II/base/quadrature_lib.h>

#include <retroforge/billet/section.h>

namespace retroforge
{
  SplineCurve segment(const Vec2 &from, const Vec2 &to)
  {
    return {{from, to}, 1};
  }

  double volume_of_revolution(const Section &section)
  {
    const dealii::QGauss<1> gauss(10);
    double                  integral = 0.; // of r^2 dz
    for (const Portion &portion : section)
      for (unsigned int span = 0; span < portion.curve.n_spans(); ++span)
        for (unsigned int q = 0; q < gauss.size(); ++q)
        {
          const double t = (span + gauss.point(q)[0]) / portion.curve.n_spans();
          const double r = portion.curve.value(t)[0];
          integral += gauss.weight(q) / portion.curve.n_spans() * r * r * portion.curve.derivative(t)[1];
        }
    return -dealii::numbers::PI * integral; // clockwise: upwards along the bore
  }
} // namespace retroforge
