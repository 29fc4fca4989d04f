// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The stress of a cell, law not regularised.
// - By hand: upsetting V = s (x/2, y/2, -z) has eps = s diag(1/2, 1/2, -1), e = s, hence
//   s = 2 K (sqrt3 s)^(m-1) eps and sqrt(3/2 s:s) = K 3^((m+1)/2) s^m; simple shear V = s (z, 0, 0) has
//   eps_xz = s/2, 2 eps:eps = s^2, hence s_xz = K s^m and the equivalent stress sqrt3 K s^m.
// - Expansion V = s x, which the discrete flow has only in the small, has no deviator.
// - A bubble's strain rates cancel in the mean, and where m = 1 so do its stresses.
// - At rest: zero, with m < 1 and e0 = 0, too.

#include "element_test_tools.h"
#include <retroforge/element/cell_stress.h>

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

int main()
{
  Random random;
  Errors errors;
  for (const double m : {1., 0.5, 0.139})
    by_hand(random, m, errors);
  with_a_bubble(random, errors);
  errors.print(1e-13);
}
