// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Kernels by quadrature on random cells, some of them flat. Proved:
// - on straight tetrahedra, values, tangents, eliminated bubbles, solved bubbles and all reverse sweeps are
//   those of the closed forms of both pairs, which share no derivative code with them;
// - a geometry of degree 2 whose edges are straight is that of degree 1.

#include "quadrature_tools.h"
#include <retroforge/element/cell_stress.h>
#include <retroforge/element/corner_rates.h>

using namespace retroforge;

/// What both have, in the order of QuadratureValues.
QuadratureValues<3, double> generic(const CellValues<double> &w)
{
  QuadratureValues<3, double> x;
  x.V.assign(w.V.begin(), w.V.end());
  x.V.push_back(w.beta);
  x.P.assign(w.P.begin(), w.P.end());
  return x;
}

QuadratureValues<3, double> generic(const TaylorHoodValues<double> &w)
{
  QuadratureValues<3, double> x;
  x.V.assign(w.V.begin(), w.V.end());
  x.P.assign(w.P.begin(), w.P.end());
  return x;
}

template <std::size_t n>
std::vector<double> flatten(const std::array<Symmetric<double>, n> &tensors)
{
  std::vector<double> all;
  for (const auto &t : tensors)
    all.insert(all.end(), t.begin(), t.end());
  return all;
}

/// Cells whose edges differ by a factor of 30 are among them.
Four<Vec3> random_cell(Random &random)
{
  Four<Vec3>   X       = random.cell();
  const double stretch = std::pow(30., 0.5 + 0.5 * random.scalar());
  for (Vec3 &x : X)
    x[2] *= stretch;
  return X;
}

template <typename Values>
struct Cell
{
  QuadratureGeometry<3, double> geometry;
  Values                        w, lambda;
  MaterialLaw<double>           law;

  Four<Vec3>           X() const { return {{geometry.X[0], geometry.X[1], geometry.X[2], geometry.X[3]}}; }
  CellGeometry<double> closed() const { return cell_geometry(X()); }
};

template <typename Values>
void check_values(const Cell<Values> &c, Errors &errors)
{
  const auto w = generic(c.w);
  errors.compare("volume", cell_volume(c.geometry), c.closed().volume);
  errors.compare(
    "functional", cell_functional(c.geometry, w, c.law), cell_functional(c.closed(), c.w, c.law));
  errors.compare("residual",
                 flatten(cell_residual(c.geometry, w, c.law)),
                 flatten(generic(cell_residual(c.closed(), c.w, c.law))));
  errors.compare(
    "dissipation", cell_dissipation(c.geometry, w, c.law), cell_dissipation(c.closed(), c.w, c.law));
  errors.compare("strain rate", cell_strain_rate(c.geometry, w), cell_strain_rate(c.closed(), c.w));
  const auto s        = cell_deviatoric_stress(c.geometry, w, c.law),
             s_closed = cell_deviatoric_stress(c.closed(), c.w, c.law);
  errors.compare("stress", {s.begin(), s.end()}, {s_closed.begin(), s_closed.end()});
  errors.compare("strain rates at the corners",
                 flatten(corner_strain_rates(c.geometry, w)),
                 flatten(corner_strain_rates(c.closed(), c.w)));
}

void compare_law(const std::string         &what,
                 const MaterialLaw<double> &found,
                 const MaterialLaw<double> &expected,
                 Errors                    &errors)
{
  std::vector<double> a, b;
  for_each_number(
    [&](const double &x, const double &y) {
      a.push_back(x);
      b.push_back(y);
    },
    found,
    expected);
  errors.compare(what + " in the law", a, b);
}

template <typename Values>
void check_reverse(const Cell<Values> &c, Errors &errors)
{
  const auto            w      = generic(c.w);
  const auto            R      = reverse_cell_residual(c.geometry, w, generic(c.lambda), c.law);
  const CellSensitivity closed = reverse_cell_residual(c.closed(), c.w, c.lambda, c.law);
  errors.compare("lambda·residual in X", flatten<3>(R.X), flatten(closed.X));
  compare_law("lambda·residual", R.law, closed.law, errors);

  Values                      w_bar{};
  QuadratureValues<3, double> w_found(*c.geometry.element);
  const auto                  D        = reverse_cell_dissipation(c.geometry, w, c.law, -0.7, w_found);
  const CellSensitivity       closed_D = reverse_cell_dissipation(c.closed(), c.w, c.law, -0.7, w_bar);
  errors.compare("dissipation in X", flatten<3>(D.X), flatten(closed_D.X));
  errors.compare("dissipation in the unknowns", flatten(w_found), flatten(generic(w_bar)));
  compare_law("dissipation", D.law, closed_D.law, errors);

  // Both add to what is there.
  Four<Vec3>             X_bar = c.X();
  CellVectors<3, double> X_found(c.geometry.X);
  reverse_cell_strain_rate(c.geometry, w, 0.4, w_found, X_found);
  reverse_cell_strain_rate(c.closed(), c.w, 0.4, w_bar, X_bar);
  errors.compare("strain rate in X", flatten<3>(X_found), flatten(X_bar));
  errors.compare("strain rate in the unknowns", flatten(w_found), flatten(generic(w_bar)));
}

/// Entries of the blocks of n velocity nodes.
template <typename Blocks>
void compare_tangents(const QuadratureTangent<3> &t,
                      const Blocks               &closed,
                      const unsigned int          n,
                      Errors                     &errors)
{
  std::vector<double> A, B, A_closed, B_closed;
  for (unsigned int a = 0; a < n; ++a)
    for (unsigned int i = 0; i < 3; ++i)
    {
      for (unsigned int b = 0; b < n; ++b)
        for (unsigned int j = 0; j < 3; ++j)
        {
          A.push_back(t.A(a, b)[i][j]);
          A_closed.push_back(closed.A[a][b][i][j]);
        }
      for (unsigned int b = 0; b < 4; ++b)
      {
        B.push_back(t.B(a, b)[i]);
        B_closed.push_back(closed.B[a][b][i]);
      }
    }
  errors.compare("tangent, of velocities", A, A_closed);
  errors.compare("tangent, of velocities and pressures", B, B_closed);
  errors.compare("viscosity", t.viscosity, closed.viscosity);
  errors.compare("volume of the tangent", t.volume, closed.volume);
}

void check_tangent(const Cell<CellValues<double>> &c, Errors &errors)
{
  auto        t      = cell_tangent(c.geometry, generic(c.w), c.law, Linearisation::newton);
  const auto  bubble = eliminate_bubble(t);
  CellTangent closed;
  compute_cell_tangent(c.closed(), c.w, c.law, closed);
  compare_tangents(t, closed, 4, errors);
  std::vector<double> C, Vb, Pb, M, C_closed, Vb_closed, Pb_closed, M_closed;
  for (unsigned int a = 0; a < 4; ++a)
  {
    for (unsigned int b = 0; b < 4; ++b)
    {
      C.push_back(t.C(a, b));
      C_closed.push_back(closed.C[a][b]);
    }
    for (unsigned int i = 0; i < 3; ++i)
    {
      Pb.push_back(bubble.Pb[a][i]);
      Pb_closed.push_back(closed.Pb[a][i]);
      for (unsigned int j = 0; j < 3; ++j)
      {
        // It vanishes where the stresses are linear: relative to the velocities' entries.
        Vb.push_back(t.A(a, a)[i][j] + bubble.Vb[a][i][j]);
        Vb_closed.push_back(closed.A[a][a][i][j] + closed.Vb[a][i][j]);
        M.push_back(bubble.M[i][j]);
        M_closed.push_back(closed.M[i][j]);
      }
    }
  }
  errors.compare("tangent, of pressures", C, C_closed);
  errors.compare("velocity-bubble", Vb, Vb_closed);
  errors.compare("pressure-bubble", Pb, Pb_closed);
  errors.compare("bubble-bubble", M, M_closed);

  const Vec3 beta        = solve_bubble(c.geometry, generic(c.w), c.law),
             beta_closed = solve_bubble(c.closed(), c.w, c.law);
  errors.compare(
    "solved bubble", {beta.begin_raw(), beta.end_raw()}, {beta_closed.begin_raw(), beta_closed.end_raw()});
}

void check_tangent(const Cell<TaylorHoodValues<double>> &c, Errors &errors)
{
  for (const auto linearisation : {Linearisation::newton, Linearisation::picard})
  {
    TaylorHoodTangent closed;
    compute_cell_tangent(c.closed(), c.w, c.law, linearisation, closed);
    compare_tangents(cell_tangent(c.geometry, generic(c.w), c.law, linearisation), closed, 10, errors);
  }
}

/// Picard's matrix of the mini element: that of the Newtonian law, where the rates are alike in all parts.
void check_picard(const Cell<CellValues<double>> &c, Errors &errors)
{
  CellValues<double> w = c.w;
  w.beta               = Vec3();
  auto t               = cell_tangent(c.geometry, generic(w), c.law, Linearisation::picard);
  eliminate_bubble(t);
  CellTangent  closed;
  const double e = cell_strain_rate(c.geometry, generic(w)), e0 = c.law.e0;
  compute_cell_tangent(c.closed(), w, c.law.newtonian(std::sqrt(e * e + e0 * e0)), closed);
  compare_tangents(t, closed, 4, errors);
}

/// The same edges as a geometry of degree 2.
template <typename Values>
void check_degree_two(const Cell<Values> &c, const ReferenceElement<3> &curved, Errors &errors)
{
  const auto                          w = generic(c.w), lambda = generic(c.lambda);
  const QuadratureGeometry<3, double> geometry{&curved, straight(curved, c.geometry.X)};
  errors.compare("geometry of degree 2, residual",
                 flatten(cell_residual(geometry, w, c.law)),
                 flatten(cell_residual(c.geometry, w, c.law)));
  // A vertex that moves takes the middles beside it along by half.
  constexpr unsigned int edges[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  auto                   X_bar       = reverse_cell_residual(geometry, w, lambda, c.law).X;
  for (unsigned int e = 0; e < 6; ++e)
    for (const unsigned int a : edges[e])
      X_bar[a] += 0.5 * X_bar[4 + e];
  X_bar.resize(4);
  errors.compare("geometry of degree 2, lambda·residual in X",
                 flatten<3>(X_bar),
                 flatten<3>(reverse_cell_residual(c.geometry, w, lambda, c.law).X));
}

template <typename Values>
void check(const Cell<Values> &c, const ReferenceElement<3> &curved, Errors &errors)
{
  check_values(c, errors);
  check_reverse(c, errors);
  check_tangent(c, errors);
  check_degree_two(c, curved, errors);
}

int main()
{
  constexpr auto            solid = Kinematics::three_dimensions;
  const ReferenceElement<3> mini = mini_reference<3>(1, solid), mini_curved = mini_reference<3>(2, solid),
                            quadratic        = taylor_hood_reference<3>(1, solid),
                            quadratic_curved = taylor_hood_reference<3>(2, solid);
  Random random;
  Errors of_mini, of_quadratic;
  for (unsigned int k = 0; k < 40; ++k)
    for (const double m : {1., 0.3, 0.139})
    {
      const MaterialLaw<double>      law{1.693, m, m == 1. ? 0. : 0.05};
      const Four<Vec3>               X = random_cell(random);
      const CellVectors<3, double>   vertices(X.begin(), X.end());
      const Cell<CellValues<double>> cell{{&mini, vertices}, random.cell_values(), random.cell_values(), law};
      check(cell, mini_curved, of_mini);
      check_picard(cell, of_mini);
      check(
        Cell<TaylorHoodValues<double>>{
          {&quadratic, vertices}, random.taylor_hood_values(), random.taylor_hood_values(), law},
        quadratic_curved,
        of_quadratic);
    }
  std::cout << "mini" << std::endl;
  of_mini.print(1e-12);
  std::cout << "P2-P1" << std::endl;
  of_quadratic.print(1e-12);
}
