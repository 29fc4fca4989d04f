// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Values of the Taylor-Hood element.
// - By hand, linear velocity:  Pi = |T| (K/(m+1) (2 eps:eps + 3 e0^2)^((m+1)/2) - pbar tr L),  and for
//   upsetting V = s (x/2, y/2, -z) strain rates s, dissipation |T| 3/2 factor s^2 and a deviatoric stress
//   factor eps at all points.
// - By hand, m = 1, where the four points are exact:  v = (x^2, 0, 0) has eps_xx = 2x, v = (yz, 0, 0) has
//   eps:eps = (y^2 + z^2)/2; with  int_T f g = |T|/20 (sum_a f_a g_a + sum_a f_a sum_b g_b)  for linear f, g
//   the functional K int eps:eps - int p div v follows, and the dissipation, twice its first part.
// - Against deal.II: residual and tangent as FEValues integrates them in P2^3 x P1 with these four points, on
//   random cells, fields and a power law; the numbering of the nodes is deal.II's.

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_fe.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/full_matrix.h>

#include "element_test_tools.h"

using namespace retroforge;

/// A flow's values at the nodes, random pressures.
template <typename Flow>
TaylorHoodValues<double> interpolant(const Four<Vec3> &X, const Flow &v, Random &random)
{
  TaylorHoodValues<double> w = random.taylor_hood_values();
  for (unsigned int a = 0; a < 4; ++a)
    w.V[a] = v(X[a]);
  for (unsigned int e = 0; e < 6; ++e)
    w.V[4 + e] = v(0.5 * (X[tet_edge_corners[e][0]] + X[tet_edge_corners[e][1]]));
  return w;
}

double sum(const Four<double> &f)
{
  return f[0] + f[1] + f[2] + f[3];
}

/// Integral of the product of two linear functions.
double integral(const double volume, const Four<double> &f, const Four<double> &g)
{
  double diagonal = 0.;
  for (unsigned int a = 0; a < 4; ++a)
    diagonal += f[a] * g[a];
  return volume / 20. * (diagonal + sum(f) * sum(g));
}

void linear_by_hand(Random &random, const double m, Errors &errors)
{
  const Four<Vec3>         X = random.cell();
  const auto               T = cell_geometry(X);
  const NortonHoff<double> law{1.7, m, 0.1};
  const Vec3               v0 = random.vector();
  dealii::Tensor<2, 3>     L;
  for (unsigned int i = 0; i < 3; ++i)
    L[i] = random.vector();
  const auto linear    = [&](const Vec3 &x) -> Vec3 { return v0 + L * x; };
  const auto w         = interpolant(X, linear, random);
  const auto eps       = dealii::symmetrize(L);
  const auto potential = law.K / (m + 1.) * std::pow(2. * (eps * eps) + 3. * law.e0 * law.e0, (m + 1.) / 2.);
  errors.compare(
    "linear velocity", cell_functional(T, w, law), T.volume * (potential - sum(w.P) / 4. * dealii::trace(L)));

  const double s     = 0.8;
  const auto   upset = interpolant(
    X,
    [&](const Vec3 &x) {
      return s * Vec3({x[0] / 2, x[1] / 2, -x[2]});
    },
    random);
  const double factor = law(1.5 * s * s);
  const auto   e      = cell_strain_rates(T, upset);
  const auto   stress = cell_deviatoric_stress(T, upset, law);
  errors.compare("strain rates of upsetting", {e.begin(), e.end()}, {s, s, s, s});
  errors.compare("mean strain rate", cell_strain_rate(T, upset), s);
  errors.compare("dissipation", cell_dissipation(T, upset, law), T.volume * factor * 1.5 * s * s);
  errors.compare(
    "stress", {stress.begin(), stress.end()}, {factor * s / 2, factor * s / 2, -factor * s, 0, 0, 0});
  auto expanding = upset;
  for (unsigned int a = 0; a < 10; ++a) // has no deviator
    expanding.V[a] += a < 4 ? X[a] : 0.5 * (X[tet_edge_corners[a - 4][0]] + X[tet_edge_corners[a - 4][1]]);
  const auto other = cell_deviatoric_stress(T, expanding, law);
  errors.compare("stress has no trace", 1. + trace(other), 1.);
}

void quadratic_by_hand(Random &random, Errors &errors)
{
  const Four<Vec3>         X = random.cell();
  const auto               T = cell_geometry(X);
  const NortonHoff<double> law{1.7, 1., 0.};
  Four<double>             x, y, z;
  for (unsigned int a = 0; a < 4; ++a)
  {
    x[a] = X[a][0];
    y[a] = X[a][1];
    z[a] = X[a][2];
  }
  const auto squares = interpolant(
    X,
    [](const Vec3 &p) {
      return Vec3({p[0] * p[0], 0., 0.});
    },
    random);
  const double stretching = law.K * 4. * integral(T.volume, x, x);
  errors.compare(
    "(x^2, 0, 0)", cell_functional(T, squares, law), stretching - 2. * integral(T.volume, x, squares.P));
  errors.compare("its dissipation", cell_dissipation(T, squares, law), 2. * stretching);
  const auto shear = interpolant(
    X,
    [](const Vec3 &p) {
      return Vec3({p[1] * p[2], 0., 0.});
    },
    random);
  errors.compare("(yz, 0, 0)",
                 cell_functional(T, shear, law),
                 law.K / 2. * (integral(T.volume, y, y) + integral(T.volume, z, z)));
}

/// P2 velocity and P1 pressure of deal.II on one tetrahedron.
class OneCell
{
public:
  explicit OneCell(const Four<Vec3> &X)
      : mapping_(dealii::FE_SimplexP<3>(1))
      , element_(dealii::FE_SimplexP<3>(2), 3, dealii::FE_SimplexP<3>(1), 1)
      , dofs_(triangulation_)
      , values_(mapping_,
                element_,
                four_points(),
                dealii::update_values | dealii::update_gradients | dealii::update_JxW_values)
  {
    dealii::CellData<3>           cell(4);
    std::vector<dealii::Point<3>> points;
    for (unsigned int a = 0; a < 4; ++a)
    {
      cell.vertices[a] = a;
      points.emplace_back(X[a]);
    }
    triangulation_.create_triangulation(points, {cell}, {});
    dofs_.distribute_dofs(element_);
    values_.reinit(dofs_.begin_active());
  }

  /// Of the shape functions i, j in the order of entries().
  void integrate(const TaylorHoodValues<double> &w,
                 const NortonHoff<double>       &law,
                 std::vector<double>            &residual,
                 std::vector<double>            &tangent) const
  {
    const dealii::FEValuesExtractors::Vector velocity(0);
    const dealii::FEValuesExtractors::Scalar pressure(3);
    const auto                               unknowns = flatten(w);
    std::array<unsigned int, 34>             place;
    for (unsigned int i = 0; i < 34; ++i)
    {
      const auto [component, shape] = element_.system_to_component_index(i);
      place[i]                      = component == 3 ? 30 + shape : 3 * shape + component;
    }
    residual.assign(34, 0.);
    tangent.assign(34 * 34, 0.);
    for (unsigned int q = 0; q < 4; ++q)
    {
      dealii::SymmetricTensor<2, 3> eps;
      double                        p = 0.;
      for (unsigned int i = 0; i < 34; ++i)
      {
        eps += unknowns[place[i]] * values_[velocity].symmetric_gradient(i, q);
        p += unknowns[place[i]] * values_[pressure].value(i, q);
      }
      const double eps2 = eps * eps, factor = law(eps2), JxW = values_.JxW(q);
      for (unsigned int i = 0; i < 34; ++i)
      {
        const auto   eps_i = values_[velocity].symmetric_gradient(i, q);
        const double p_i   = values_[pressure].value(i, q);
        residual[place[i]] += (factor * (eps * eps_i) - p * trace(eps_i) - p_i * trace(eps)) * JxW;
        for (unsigned int j = 0; j < 34; ++j)
        {
          const auto   eps_j = values_[velocity].symmetric_gradient(j, q);
          const double p_j   = values_[pressure].value(j, q);
          tangent[34 * place[i] + place[j]] +=
            (factor * (eps_i * eps_j + 2. * law.slope(eps2) * (eps * eps_i) * (eps * eps_j)) -
             p_j * trace(eps_i) - p_i * trace(eps_j)) *
            JxW;
        }
      }
    }
  }

private:
  static dealii::Quadrature<3> four_points()
  {
    const double                  near = 0.58541019662496852, far = 0.13819660112501050;
    std::vector<dealii::Point<3>> points = {
      {far, far, far}, {near, far, far}, {far, near, far}, {far, far, near}};
    return dealii::Quadrature<3>(points, std::vector<double>(4, 1. / 24.));
  }

  dealii::Triangulation<3> triangulation_;
  dealii::MappingFE<3>     mapping_;
  dealii::FESystem<3>      element_;
  dealii::DoFHandler<3>    dofs_;
  dealii::FEValues<3>      values_;
};

void against_deal_ii(Random &random, const double m, Errors &errors)
{
  const Four<Vec3>         X = random.cell();
  const auto               w = random.taylor_hood_values();
  const NortonHoff<double> law{1.7, m, 0.1};
  std::vector<double>      residual, tangent, closed;
  OneCell(X).integrate(w, law, residual, tangent);
  errors.compare("residual of deal.II", flatten(cell_residual(cell_geometry(X), w, law)), residual);

  TaylorHoodTangent t;
  compute_cell_tangent(cell_geometry(X), w, law, Linearisation::newton, t);
  for (unsigned int r = 0; r < 34; ++r)
    for (unsigned int s = 0; s < 34; ++s)
      closed.push_back(r < 30 && s < 30 ? t.A[r / 3][s / 3][r % 3][s % 3]
                       : r < 30         ? t.B[r / 3][s - 30][r % 3]
                       : s < 30         ? t.B[s / 3][r - 30][s % 3]
                                        : 0.);
  errors.compare("tangent of deal.II", closed, tangent);
}

int main()
{
  Random random;
  Errors errors;
  for (unsigned int k = 0; k < 10; ++k)
  {
    for (const double m : {1., 0.139})
    {
      linear_by_hand(random, m, errors);
      against_deal_ii(random, m, errors);
    }
    quadratic_by_hand(random, errors);
  }
  errors.print(1e-12);
}
