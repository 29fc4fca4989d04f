// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The formulas by which remeshing finds positions, each at random vectors. Proved for each: its derivative by dual
// numbers along a random direction is the limit of central differences, and the derivatives vector by vector sum up to
// it; what it is of a few vectors that can be computed by hand is that.

#include <retroforge/core/numbers.h>
#include <retroforge/remeshing/placing_rules.h>

#include "../random_numbers.h"

#include <algorithm>
#include <cstdio>

using namespace retroforge;

namespace
{
  RandomNumbers random_numbers;

  const std::vector<Plane> planes = {{Vec3({0.3, 0.1, 0.}), Vec3({0., 0., 1.})},
                                     {Vec3({0.1, 0.2, 0.4}), Vec3({0.6, 0.8, 0.})}};

  struct Rule
  {
    const char               *name;
    PlacingRule               rule;
    unsigned int              n_vectors;
    std::vector<unsigned int> others  = {}; ///< arguments after the vectors
    std::vector<double>       numbers = {};
  };

  PlacedBy by(const Rule &rule, const std::vector<unsigned int> &arguments)
  {
    return {rule.rule,
            arguments.data(),
            static_cast<unsigned int>(arguments.size()),
            rule.numbers.data(),
            static_cast<unsigned int>(rule.numbers.size())};
  }

  std::vector<unsigned int> arguments_of(const Rule &rule)
  {
    std::vector<unsigned int> arguments(rule.n_vectors);
    for (unsigned int i = 0; i < rule.n_vectors; ++i)
      arguments[i] = i;
    arguments.insert(arguments.end(), rule.others.begin(), rule.others.end());
    return arguments;
  }

  void check(const Rule &rule)
  {
    const std::vector<unsigned int> arguments = arguments_of(rule);
    const PlacedBy                  placed_by = by(rule, arguments);
    const bool                      sound = placed_by.is_sound() && placed_by.n_vectors() == rule.n_vectors;
    // Apart, so that no edge is short and no face flat.
    NodalVectors<double> x     = random_numbers.vectors(rule.n_vectors),
                         x_dot = random_numbers.vectors(rule.n_vectors);
    for (unsigned int i = 0; i < x.size(); ++i)
      x[i] += Vec3({3. * std::cos(2.1 * i), 3. * std::sin(2.1 * i), 0.7 * i});
    const auto at = [&](const double h) {
      NodalVectors<double> y = x;
      for (unsigned int i = 0; i < y.size(); ++i)
        y[i] += h * x_dot[i];
      return placed(placed_by, y, planes);
    };
    NodalVectors<Dual> dual;
    convert(x, dual);
    for_each_number([](Dual &y, const double &d) { y.fastAccessDx(0) = d; }, dual, x_dot);
    const Vector3<Dual> result = placed(placed_by, dual, planes);
    Vec3                derivative, by_vectors;
    for (unsigned int r = 0; r < 3; ++r)
      derivative[r] = result[r].dx(0);
    for (unsigned int i = 0; i < x.size(); ++i)
    {
      std::vector<Vector3<Gradient3>> of;
      convert(x, of);
      for (unsigned int c = 0; c < 3; ++c)
        of[i][c] = Gradient3(3, c, x[i][c]);
      const auto gradient = placed(placed_by, of, planes);
      for (unsigned int r = 0; r < 3; ++r)
        for (unsigned int c = 0; c < 3; ++c)
          by_vectors[r] += gradient[r].dx(c) * x_dot[i][c];
    }
    const double size  = 1. + derivative.norm();
    const auto   error = [&](const double h) {
      return ((at(h) - at(-h)) / (2. * h) - derivative).norm() / size;
    };
    const bool converges = error(1e-4) < 1e-7 && error(1e-5) < 1e-9;
    std::printf("%s: %s, derivative %s, by vectors %s\n",
                rule.name,
                sound ? "sound" : "NOT sound",
                converges ? "exact" : "NOT exact",
                (by_vectors - derivative).norm() < 1e-13 * size ? "the same" : "ANOTHER");
  }

  void print(const char *name, const Vec3 &x)
  {
    std::printf("%s: %.6f %.6f %.6f\n", name, x[0] + 0., x[1] + 0., x[2] + 0.);
  }

  Vec3 value(const Rule &rule, const NodalVectors<double> &x)
  {
    const std::vector<unsigned int> arguments = arguments_of(rule);
    return placed(by(rule, arguments), x, planes);
  }
} // namespace

int main()
{
  using R                       = PlacingRule;
  const std::vector<Rule> rules = {{"sum", R::sum, 3, {}, {0.2, 0.5, -0.3}},
                                   {"sum with an offset", R::sum, 2, {}, {0.5, 0.5, 1., 2., 3.}},
                                   {"constant", R::constant, 0, {}, {1., 2., 3.}},
                                   {"normal", R::normal, 7},
                                   {"normal at a plane", R::normal, 7, {}, {0., 0., 1.}},
                                   {"tangent in the middle", R::middle_tangent, 3},
                                   {"tangent at an end", R::end_tangent, 3},
                                   {"chord", R::chord, 2},
                                   {"on a face", R::on_face, 7},
                                   {"on an edge of a face", R::on_face_edge, 5},
                                   {"on a ridge", R::on_ridge, 5},
                                   {"on a plane", R::snap, 1, {0}},
                                   {"on two planes", R::snap, 1, {0, 1}},
                                   {"size", R::size, 5, {}, {3., 2., 1., 4.}},
                                   {"rim", R::rim, 8},
                                   {"step inside", R::step_inside, 2, {}, {0.1, -0.2, 0.3}},
                                   {"step on the surface", R::step_on_surface, 3, {1}, {0.25, -0.1}},
                                   {"step on a ridge", R::step_on_ridge, 4, {}, {-0.25}},
                                   {"outward", R::outward, 8, {8}},
                                   {"outward in a plane", R::outward, 8, {8}, {0.6, 0., 0.8}},
                                   {"outward in a face", R::outward, 11, {8}},
                                   {"outward in a plane and a face", R::outward, 11, {8}, {0.6, 0., 0.8}},
                                   {"shift", R::shift, 3}};
  for (const Rule &rule : rules)
    check(rule);

  // Of the unit circle, with the exact tangents: half a chord's sagitta is lifted twice by half.
  const double s = std::sqrt(0.5);
  print("middle of a quarter of a circle",
        value({"", R::on_ridge, 5},
              {Vec3({0.5, 0.5, 0.}),
               Vec3({1., 0., 0.}),
               Vec3({0., 1., 0.}),
               Vec3({0., 1., 0.}),
               Vec3({-1., 0., 0.})}));
  print("the same by normals",
        value({"", R::on_face_edge, 5},
              {Vec3({0.5, 0.5, 0.}),
               Vec3({1., 0., 0.}),
               Vec3({0., 1., 0.}),
               Vec3({1., 0., 0.}),
               Vec3({0., 1., 0.})}));
  print("tangent of the other end of an arc",
        value({"", R::end_tangent, 3}, {Vec3({1., 0., 0.}), Vec3({0., 1., 0.}), Vec3({0., 1., 0.})}));
  print("on the line of two planes", value({"", R::snap, 1, {0, 1}}, {Vec3({0.1 + 0.6, 0.2 + 0.8, 5.})}));
  print("direction across",
        value({"", R::outward, 6, {6}},
              {Vec3({1., 0., 0.}),
               Vec3({0., 1., 0.}),
               Vec3({0., 1., 0.}),
               Vec3({-s, -s, 0.}),
               Vec3({-s, -s, 0.}),
               Vec3({1., 0., 0.})}));
}
