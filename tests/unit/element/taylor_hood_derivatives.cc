// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The closed forms of the Taylor-Hood element against forward automatic differentiation, on random cells.
// Proved:
// - the residual is the gradient of the functional, the tangent [A B; B^T 0] the derivative of the residual,
//   and so by Taylor: what residual and tangent leave of the functional is of order 2 and 3 in the step (with
//   m = 1 the functional is quadratic, and nothing is left after the tangent);
// - Picard's matrix is the tangent of the Newtonian law that has the same viscosity at each point;
// - the lanes of a pack are the cells one by one, to rounding;
// - the reverse sweeps give the derivatives of lambda·residual, of the dissipation and of the mean strain
// rate
//   in X, K, m, e0 and the unknowns;
// - a Newtonian cell at rest without regularisation (zero to the power zero) gives numbers everywhere.

#include "derivative_checks.h"

using namespace retroforge;
using TaylorHoodCase = Case<TaylorHoodValues>;

constexpr unsigned int n = 34;

/// The matrix [A B; B^T 0] in the order of the unknowns, row by row.
std::vector<double> matrix(const TaylorHoodTangent &t)
{
  std::vector<double> H(n * n, 0.);
  for (unsigned int r = 0; r < 30; ++r)
  {
    for (unsigned int s = 0; s < 30; ++s)
      H[n * r + s] = t.A[r / 3][s / 3][r % 3][s % 3];
    for (unsigned int a = 0; a < 4; ++a)
      H[n * r + 30 + a] = H[n * (30 + a) + r] = t.B[r / 3][a][r % 3];
  }
  return H;
}

TaylorHoodTangent tangent(const TaylorHoodCase &c, const Linearisation linearisation)
{
  TaylorHoodTangent t;
  compute_cell_tangent(c.geometry(), c.w, c.law, linearisation, t);
  return t;
}

void check_tangent(const TaylorHoodCase &c, Errors &errors)
{
  const auto                t = tangent(c, Linearisation::newton);
  const std::vector<double> H = matrix(t);
  errors.compare("tangent", H, hessian(c));
  std::vector<double> transposed;
  for (unsigned int r = 0; r < n; ++r)
    for (unsigned int s = 0; s < n; ++s)
      transposed.push_back(H[n * s + r]);
  errors.compare("symmetry of the tangent", H, transposed);
  double mean = 0.;
  for (const double e : cell_strain_rates(c.geometry(), c.w))
    mean += c.law(1.5 * e * e) / 8.;
  errors.compare("viscosity and volume", {t.viscosity, t.volume}, {mean, c.geometry().volume});
}

/// Column by column: the pull-back of the strain rates of unit velocities, times the viscosities at w.
void check_picard(const TaylorHoodCase &c, Errors &errors)
{
  const TaylorHoodTangent       t        = tangent(c, Linearisation::picard);
  const auto                    geometry = c.geometry();
  const TaylorHoodRates<double> rates(geometry, c.w.V);
  std::vector<double>           expected, found;
  for (unsigned int s = 0; s < 30; ++s)
  {
    TaylorHoodValues<double> unit{}, column{};
    unit.V[s / 3][s % 3]      = 1.;
    PointRates<double> stress = TaylorHoodRates<double>(geometry, unit.V).eps;
    for (unsigned int q = 0; q < 4; ++q)
      for (double &x : stress[q])
        x *= 0.25 * geometry.volume * c.law(double_contraction(rates.eps[q], rates.eps[q]));
    add_velocity_pullback(geometry, stress, column.V);
    for (unsigned int r = 0; r < 30; ++r)
    {
      expected.push_back(column.V[r / 3][r % 3]);
      found.push_back(t.A[r / 3][s / 3][r % 3][s % 3]);
    }
  }
  errors.compare("Picard", found, expected);
}

void check_lanes(Random &random, const NortonHoff<double> &law, Errors &errors)
{
  const LaneLaws                                laws = laws_around(law);
  std::array<CellGeometry<double>, n_lanes>     geometry;
  std::array<TaylorHoodValues<double>, n_lanes> w;
  for (unsigned int lane = 0; lane < n_lanes; ++lane)
  {
    geometry[lane] = cell_geometry(random.cell());
    w[lane]        = random.taylor_hood_values();
  }
  for (const auto linearisation : {Linearisation::newton, Linearisation::picard})
  {
    TaylorHoodPack pack;
    compute_cell_tangents(geometry, w, laws, linearisation, pack);
    for (unsigned int lane = 0; lane < n_lanes; ++lane)
    {
      TaylorHoodTangent one;
      compute_cell_tangent(geometry[lane], w[lane], laws[lane], linearisation, one);
      std::vector<double> of_pack, of_cell;
      for (unsigned int k = 0; k < sizeof(one) / sizeof(double); ++k)
      {
        of_pack.push_back(reinterpret_cast<const double *>(&pack)[n_lanes * k + lane]);
        of_cell.push_back(reinterpret_cast<const double *>(&one)[k]);
      }
      errors.compare("lanes of a pack", of_pack, of_cell);
    }
  }
}

void check_strain_rate(const TaylorHoodCase &c, Errors &errors)
{
  using Number        = Unknowns<TaylorHoodValues>;
  const double weight = 0.4;
  auto         w_bar  = c.lambda;
  Four<Vec3>   X_bar  = {};
  reverse_cell_strain_rate(c.geometry(), c.w, weight, w_bar, X_bar);
  const Inputs inputs = weight * cell_strain_rate(c.independent_geometry(), constant_values<Inputs>(c.w));
  std::vector<double> in_X = gradient(inputs);
  in_X.resize(12);
  errors.compare("strain rate in X", flatten(X_bar), in_X);
  std::vector<double> expected =
    gradient(Number(weight * cell_strain_rate(constant_geometry<Number>(c.X), independent(c.w))));
  const std::vector<double> before = flatten(c.lambda);
  for (unsigned int i = 0; i < n; ++i)
    expected[i] += before[i];
  errors.compare("strain rate in the unknowns", flatten(w_bar), expected);
}

void check(const TaylorHoodCase &c, Errors &errors)
{
  check_residual(c, errors);
  check_tangent(c, errors);
  check_picard(c, errors);
  check_reverse_residual(c, errors);
  check_reverse_dissipation(c, errors);
  check_strain_rate(c, errors);
}

/// What is left of the functional after residual and tangent, over halvings of a step.
void print_taylor(Random &random, const double m)
{
  const TaylorHoodCase c{
    random.cell(), random.taylor_hood_values(), random.taylor_hood_values(), {1.693, m, 0.05}};
  const auto direction = flatten(c.lambda), R = flatten(cell_residual(c.geometry(), c.w, c.law)),
             H       = matrix(tangent(c, Linearisation::newton));
  const double start = cell_functional(c.geometry(), c.w, c.law);
  double       slope = 0., curvature = 0.;
  for (unsigned int r = 0; r < n; ++r)
  {
    slope += R[r] * direction[r];
    for (unsigned int s = 0; s < n; ++s)
      curvature += direction[r] * H[n * r + s] * direction[s];
  }
  std::cout << "m = " << m << ", order of what residual and tangent leave:";
  double first = 0., second = 0.;
  for (const double step : {0.04, 0.02, 0.01, 0.005})
  {
    auto       w  = c.w;
    const auto at = entries(w);
    for (unsigned int i = 0; i < n; ++i)
      *at[i] += step * direction[i];
    const double after_residual = cell_functional(c.geometry(), w, c.law) - start - step * slope;
    const double after_tangent  = after_residual - 0.5 * step * step * curvature;
    if (first != 0.)
    {
      std::cout << "  " << std::log2(first / after_residual);
      if (std::abs(after_tangent) < 1e-13 * std::abs(start))
        std::cout << " nothing";
      else
        std::cout << " " << std::log2(second / after_tangent);
    }
    first  = after_residual;
    second = after_tangent;
  }
  std::cout << std::endl;
}

int main()
{
  Random random;
  std::cout.precision(2);
  for (const double m : {1., 0.139})
    print_taylor(random, m);
  for (const double m : {1., 0.5, 0.139, 0.05})
  {
    Errors errors;
    for (unsigned int k = 0; k < 20; ++k)
    {
      const NortonHoff<double> law{1.693, m, 0.05};
      check({random.cell(), random.taylor_hood_values(), random.taylor_hood_values(), law}, errors);
      check_lanes(random, law, errors);
    }
    std::cout << "m = " << m << std::endl;
    errors.print(1e-13);
  }

  Errors errors;
  for (const bool at_rest : {false, true})
  {
    TaylorHoodCase c{
      random.cell(), random.taylor_hood_values(), random.taylor_hood_values(), {1.693, 1., 0.}};
    if (at_rest)
      c.w.V = {};
    check(c, errors);
  }
  std::cout << "Newtonian without regularisation, moving and at rest" << std::endl;
  errors.print(1e-13);
}
