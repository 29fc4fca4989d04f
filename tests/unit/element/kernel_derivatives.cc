// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The closed forms of the mini element against forward automatic differentiation, on random cells. Proved:
// - the residual is the gradient of the functional;
// - the condensed tangent, its right-hand side and the recovered bubble solve the uncondensed 19 x 19 system,
// whose
//   matrix is the derivative of the residual; both are symmetric, the pressure block is negative
//   semi-definite;
// - the reverse sweeps give the derivatives of lambda·residual and of the dissipation in X, K, m, e0 and the
// unknowns;
// - the bubble found from V and P leaves no residual in its rows; of four cells at once, each is the one that
//   the cell has by itself, to the bit;
// - a Newtonian cell at rest without regularisation (zero to the power zero) gives numbers everywhere.

#include "derivative_checks.h"

using namespace retroforge;
using MiniCase = Case<CellValues>;

/// Entry of the condensed matrix for velocity components 3a + i < 12 and pressures 12 + a.
double condensed(const CellTangent &t, const unsigned int r, const unsigned int s)
{
  if (r < 12 && s < 12)
    return t.A[r / 3][s / 3][r % 3][s % 3];
  if (r < 12)
    return t.B[r / 3][s - 12][r % 3];
  return s < 12 ? t.B[s / 3][r - 12][s % 3] : t.C[r - 12][s - 12];
}

void check_tangent(const MiniCase &c, Errors &errors, Random &random)
{
  const std::vector<double> H = hessian(c);
  std::vector<double>       H_transposed;
  for (unsigned int r = 0; r < 19; ++r)
    for (unsigned int s = 0; s < 19; ++s)
      H_transposed.push_back(H[19 * s + r]);
  errors.compare("symmetry of the uncondensed tangent", H, H_transposed);

  CellTangent t;
  compute_cell_tangent(c.geometry(), c.w, c.law, t);
  // Any solution and its right-hand side H x; the reduced system must hold for its nodal part.
  const CellValues<double>  x      = random.cell_values();
  const std::vector<double> x_flat = flatten(x);
  std::vector<double>       Hx(19, 0.), row_size(3, 0.);
  for (unsigned int r = 0; r < 19; ++r)
    for (unsigned int s = 0; s < 19; ++s)
      Hx[r] += H[19 * r + s] * x_flat[s];
  CellValues<double> rhs;
  for (unsigned int a = 0; a < 4; ++a)
  {
    rhs.V[a] = Vec3({Hx[3 * a], Hx[3 * a + 1], Hx[3 * a + 2]});
    rhs.P[a] = Hx[15 + a];
  }
  rhs.beta          = Vec3({Hx[12], Hx[13], Hx[14]});
  const Vec3 bubble = t.recover_bubble(rhs.beta, x.V, x.P);
  errors.compare("recovered bubble",
                 std::vector<double>(bubble.begin_raw(), bubble.end_raw()),
                 std::vector<double>(x.beta.begin_raw(), x.beta.end_raw()));
  t.condense(rhs);
  std::vector<double> nodal(16, 0.), reduced, transposed, nodal_rhs = flatten(rhs.V);
  nodal_rhs.insert(nodal_rhs.end(), rhs.P.begin(), rhs.P.end());
  for (unsigned int r = 0; r < 16; ++r)
    for (unsigned int s = 0; s < 16; ++s)
    {
      nodal[r] += condensed(t, r, s) * x_flat[s < 12 ? s : s + 3];
      reduced.push_back(condensed(t, r, s));
      transposed.push_back(condensed(t, s, r));
    }
  errors.compare("condensed system", nodal, nodal_rhs);
  errors.compare("symmetry of the condensed tangent", reduced, transposed);
  double pCp = 0.;
  for (unsigned int a = 0; a < 4; ++a)
    for (unsigned int b = 0; b < 4; ++b)
      pCp += x.P[a] * t.C[a][b] * x.P[b];
  errors.compare("sign of the pressure block", pCp < 0. ? 1. : -1., 1.);
}

void check_reverse_geometry(const MiniCase &c, Errors &errors)
{
  const auto geometry = c.independent_geometry();
  Inputs     product  = 0.3 * geometry.volume;
  for (unsigned int a = 0; a < 4; ++a)
    for (unsigned int i = 0; i < 3; ++i)
      product += c.lambda.V[a][i] * geometry.g[a][i];
  Four<Vec3> X_bar = {};
  reverse_cell_geometry(c.geometry(), 0.3, c.lambda.V, X_bar);
  std::vector<double> expected(12);
  for (unsigned int i = 0; i < 12; ++i)
    expected[i] = product.dx(i);
  errors.compare("geometry in X", flatten(X_bar), expected);
}

/// Residual of the bubble rows relative to the pressure's part of them.
void check_bubble(const MiniCase &c, Errors &errors)
{
  CellValues<double> w = c.w;
  w.beta               = solve_bubble(c.geometry(), w, c.law);
  const Vec3   r       = cell_residual(c.geometry(), w, c.law).beta;
  const double scale   = 0.25 * c.geometry().volume * pressure_gradient(c.geometry(), w.P).norm();
  errors.compare("residual of the solved bubble", 1. + r.norm() / scale, 1.);
}

/// Four cells of different laws whose searches take different numbers of steps, the last one none, against
/// each by itself.
void check_bubbles(const MaterialLaw<double> &law, Errors &errors, Random &random)
{
  const LaneLaws                            laws = laws_around(law);
  std::array<CellGeometry<double>, n_lanes> geometry;
  std::array<CellValues<double>, n_lanes>   w;
  for (unsigned int lane = 0; lane < n_lanes; ++lane)
  {
    geometry[lane] = cell_geometry(random.cell());
    w[lane]        = random.cell_values();
    for (Vec3 &v : w[lane].V)
      v *= std::pow(10., -2. * lane);
  }
  w[3].beta     = solve_bubble(geometry[3], w[3], laws[3]);
  const auto by = solve_bubbles(geometry, w, laws);
  for (unsigned int lane = 0; lane < n_lanes; ++lane)
    errors.compare("bubbles of four cells, by bits",
                   by[lane] == solve_bubble(geometry[lane], w[lane], laws[lane]) ? 1. : 0.,
                   1.);
}

void check(const MiniCase &c, Errors &errors, Random &random)
{
  check_residual(c, errors);
  check_tangent(c, errors, random);
  check_reverse_residual(c, errors);
  check_reverse_dissipation(c, errors);
  check_reverse_geometry(c, errors);
  check_bubble(c, errors);
}

int main()
{
  Random random, of_packs;
  double largest = 0.;
  for (const double m : {1., 0.5, 0.139, 0.05})
  {
    Errors errors;
    for (unsigned int n = 0; n < 20; ++n)
      check({random.cell(), random.cell_values(), random.cell_values(), {1.693, m, 0.05}}, errors, random);
    check_bubbles({1.693, m, 0.05}, errors, of_packs);
    std::cout << "m = " << m << std::endl;
    errors.print(1e-13);
    largest = std::max(largest, errors.largest());
  }

  Errors errors;
  for (const bool at_rest : {false, true})
  {
    MiniCase c{random.cell(), random.cell_values(), random.cell_values(), {1.693, 1., 0.}};
    if (at_rest)
    {
      c.w.V    = {};
      c.w.beta = Vec3();
    }
    check(c, errors, random);
  }
  std::cout << "Newtonian without regularisation, moving and at rest" << std::endl;
  errors.print(1e-13);
  largest = std::max(largest, errors.largest());
  std::cout << "FIGURE kernel_derivative_error " << largest << std::endl;
}
