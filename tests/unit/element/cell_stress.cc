// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The stress of a cell, law not regularised.
// - By hand: upsetting V = s (x/2, y/2, -z) has eps = s diag(1/2, 1/2, -1), e = s, hence
//   s = 2 K (sqrt3 s)^(m-1) eps and sqrt(3/2 s:s) = K 3^((m+1)/2) s^m; simple shear V = s (z, 0, 0) has
//   eps_xz = s/2, 2 eps:eps = s^2, hence s_xz = K s^m and the equivalent stress sqrt3 K s^m.
// - Expansion V = s x, which the discrete flow has only in the small, has no deviator.
// - A bubble's strain rates cancel in the mean, and where m = 1 so do its stresses.
// - At rest: zero, with m < 1 and e0 = 0, too.
// - The largest principal value is that of tensors which are turned from diag(a, b, c), to what its rounding
//   leaves, 0.27 % of the equivalent stress where two coincide; there its slope is zero by what parts them. The positive
//   part that damage is made of is 3/32 w at zero, and meets 0 and the tension with their slopes.

#include "element_test_tools.h"
#include <retroforge/element/cell_stress.h>
#include <retroforge/material/damage_law.h>

using namespace retroforge;

constexpr double K = 1.693, s = 0.8;

/// Nodal velocities of a linear flow.
template <typename Flow>
CellValues<double> flow(const Four<Vec3> &X, const Flow &V)
{
  CellValues<double> w{};
  for (unsigned int a = 0; a < 4; ++a)
    w.V[a] = V(X[a]);
  return w;
}

std::vector<double> as_vector(const SymmetricTensor &t)
{
  return {t.begin(), t.end()};
}

void by_hand(Random &random, const double m, Errors &errors)
{
  const Four<Vec3>         X = random.cell();
  const auto               T = cell_geometry(X);
  const NortonHoff<double> law{K, m, 0.};
  const double             factor = 2. * K * std::pow(std::sqrt(3.) * s, m - 1.);
  const auto               upset  = cell_deviatoric_stress(T,
                                            flow(X,
                                                 [](const Vec3 &x) {
                                                   return s * Vec3({x[0] / 2, x[1] / 2, -x[2]});
                                                 }),
                                            law);
  errors.compare("upsetting", as_vector(upset), {factor * s / 2, factor * s / 2, -factor * s, 0, 0, 0});
  errors.compare("its equivalent stress", von_mises(upset), K * std::pow(3., (m + 1.) / 2.) * std::pow(s, m));
  const auto shear = cell_deviatoric_stress(T,
                                            flow(X,
                                                 [](const Vec3 &x) {
                                                   return Vec3({s * x[2], 0, 0});
                                                 }),
                                            law);
  errors.compare("shear", as_vector(shear), {0, 0, 0, 0, K * std::pow(s, m), 0});
  errors.compare("its equivalent stress, too", von_mises(shear), std::sqrt(3.) * K * std::pow(s, m));
  const auto expansion = cell_deviatoric_stress(T, flow(X, [](const Vec3 &x) { return s * x; }), law);
  errors.compare("expansion", as_vector(expansion), std::vector<double>(6, 0.));
  const auto at_rest = cell_deviatoric_stress(T, CellValues<double>{}, law);
  errors.compare("at rest", as_vector(at_rest), std::vector<double>(6, 0.));
}

void with_a_bubble(Random &random, Errors &errors)
{
  const Four<Vec3> X = random.cell();
  auto             w = flow(X, [](const Vec3 &x) { return s * Vec3({x[0] / 2, x[1] / 2, -x[2]}); });
  w.beta             = random.vector();
  const auto stress  = cell_deviatoric_stress(cell_geometry(X), w, {K, 1., 0.});
  errors.compare("Newtonian, with a bubble", as_vector(stress), {K * s, K * s, -2. * K * s, 0, 0, 0});
}

/// Q diag(a, b, c) Q^T, Q a turn by some angles.
Symmetric<double> with_principal_values(const Vec3 &values, const double first, const double second)
{
  const dealii::Tensor<2, 3> Q(
    dealii::Tensor<2, 3>(
      {{std::cos(first), -std::sin(first), 0.}, {std::sin(first), std::cos(first), 0.}, {0., 0., 1.}}) *
    dealii::Tensor<2, 3>(
      {{1., 0., 0.}, {0., std::cos(second), -std::sin(second)}, {0., std::sin(second), std::cos(second)}}));
  dealii::Tensor<2, 3> D;
  for (unsigned int i = 0; i < 3; ++i)
    D[i][i] = values[i];
  const dealii::Tensor<2, 3> s = Q * D * dealii::transpose(Q);
  return {{s[0][0], s[1][1], s[2][2], s[1][2], s[0][2], s[0][1]}};
}

/// Value and derivative in its components of the largest principal value, along a change of s.
Dual principal_along(const Symmetric<double> &s, const Symmetric<double> &s_dot)
{
  Symmetric<Dual> x;
  for (unsigned int k = 0; k < 6; ++k)
  {
    x[k]                 = Dual(s[k]);
    x[k].fastAccessDx(0) = s_dot[k];
  }
  return largest_principal(x);
}

void principal_values(Errors &near, Errors &exact)
{
  const double c = std::cos(std::acos(-(1. - rounded_corner)) / 3.);
  // Where the two largest coincide, at angles that leave no component zero.
  const auto upset = with_principal_values(Vec3({1., 1., -2.}), 0.4, 1.1);
  exact.compare("upsetting", largest_principal(upset), 2. * c);
  std::cout << "upsetting, larger than it is, of the equivalent stress: "
            << (largest_principal(upset) - 1.) / von_mises(upset) << std::endl;
  near.compare("tension", largest_principal(with_principal_values(Vec3({2., -1., -1.}), 0.4, 1.1)), 2.);
  exact.compare("pure shear", largest_principal(with_principal_values(Vec3({-1., 0., 1.}), 0.4, 1.1)), 1.);
  near.compare("any", largest_principal(with_principal_values(Vec3({3.1, -0.4, -2.7}), 2., 0.3)), 3.1);
  exact.compare("none", largest_principal(Symmetric<double>{}), 0.);
  // Along deviators: the slope of a value by itself is 1, and by what parts two that coincide it is 0.
  const auto own = with_principal_values(Vec3({1., -0.5, -0.5}), 0.4, 1.1),
             two = with_principal_values(Vec3({1., -1., 0.}), 0.4, 1.1);
  near.compare(
    "slope", principal_along(with_principal_values(Vec3({3.1, -0.4, -2.7}), 0.4, 1.1), own).dx(0), 1.);
  exact.compare("slope by what parts two that coincide", principal_along(upset, two).dx(0), 0.);
}

void tension()
{
  const double w = tension_width;
  Errors       errors;
  errors.compare("tension", smooth_tension(0.3), 0.3);
  errors.compare("pressure", smooth_tension(-0.3), 0.);
  errors.compare("where it sets in", smooth_tension(0.), 3. / 32. * w);
  errors.compare("at its ends", {smooth_tension(-0.5 * w), smooth_tension(0.5 * w)}, {0., 0.5 * w});
  for (const double y : {-0.5, 0.5})
  {
    Dual x(y * w * (1. - 1e-9));
    x.fastAccessDx(0) = 1.;
    errors.compare("slope there", smooth_tension(x).dx(0), y > 0. ? 1. : 0.);
  }
  errors.print(1e-13);
}

int main()
{
  Random random;
  Errors errors;
  for (const double m : {1., 0.5, 0.139})
    by_hand(random, m, errors);
  with_a_bubble(random, errors);
  Errors near;
  principal_values(near, errors);
  errors.print(1e-13);
  near.print(2e-4);
  tension();
}
