// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/design/billet_shapes.h>

#include <sstream>

namespace retroforge
{
  namespace
  {
    // x, y, z times the factors.
    NodalVectors<double> scaled(const NodalVectors<double> &X, const double across, const double along)
    {
      NodalVectors<double> field;
      for (const Vec3 &x : X)
        field.push_back(Vec3({across * x[0], across * x[1], along * x[2]}));
      return field;
    }

    std::string not_positive(const std::string &name, const double value)
    {
      if (value > 0.)
        return "";
      std::ostringstream text;
      text << name << " = " << value << " is not above zero";
      return text.str();
    }
  } // namespace

  BilletShapes box_shapes(const BilletParameters &billet, const NodalVectors<double> &X)
  {
    const double a = billet.size[0], height = billet.size[2];
    return {{{"stretch", "mm", 0., a, scaled(X, 2. / a, 0.)},
             {"height", "mm", height, height, scaled(X, 0., 1. / height)}},
            [a](const std::vector<double> &mu) {
              const std::string complaint = not_positive("a/2 + stretch", a / 2. + mu[0]);
              return complaint.empty() ? not_positive("height", mu[1]) : complaint;
            },
            [billet](const std::vector<double> &mu) {
              BilletParameters measured = billet;
              for (unsigned int i = 0; i < 2; ++i)
                measured.size[i] *= 1. + 2. * mu[0] / billet.size[0];
              measured.size[2] = mu[1];
              return measured;
            }};
  }

  BilletShapes cylinder_shapes(const BilletParameters &billet, const NodalVectors<double> &X)
  {
    const double radius = billet.radius, height = billet.height;
    return {{{"radius", "mm", radius, radius, scaled(X, 1. / radius, 0.)},
             {"height", "mm", height, height, scaled(X, 0., 1. / height)}},
            [](const std::vector<double> &mu) {
              const std::string complaint = not_positive("radius", mu[0]);
              return complaint.empty() ? not_positive("height", mu[1]) : complaint;
            },
            [billet](const std::vector<double> &mu) {
              BilletParameters measured = billet;
              measured.radius           = mu[0];
              measured.height           = mu[1];
              return measured;
            }};
  }
} // namespace retroforge
