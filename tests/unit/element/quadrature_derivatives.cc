// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Derivatives of the kernels by quadrature, on curved cells of both pairs in space, in plane strain and
// around an axis. Proved:
// - by hand: a uniform flow of strain rate s dissipates  K 3^((m+1)/2) s^(m+1)  per volume in compression of
//   space and of a ring (whose volume is 2 pi r_c times the area of a triangle, r_c its centroid's radius),
//   K 2^(m+1) s^(m+1)  in plane strain; its rates are those at the corners, one of them on the axis;
// - the residual is the gradient of the functional, and by Taylor: what residual and tangent leave of the
//   functional is of order 2 and 3 in the step;
// - the tangent, forward by dual numbers through the whole kernel, and the reverse sweeps are transposes of
//   each other in positions, unknowns and the law:  <A x, y> = <x, A^T y>;
// - the reverse sweep in the unknowns is the tangent's matrix times lambda;
// - an eliminated bubble leaves the same system; a solved one no residual.

#include "quadrature_tools.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_simplex_p_bubbles.h>

using namespace retroforge;

template <int dim>
using Input = CellInput<dim, double>;

template <int dim, typename Number>
QuadratureGeometry<dim, Number> geometry_of(const ReferenceElement<dim> &e, const CellInput<dim, Number> &x)
{
  return {&e, x.X};
}

/// Numbers near the laws of metals; edges that are bent by a tenth of their length.
template <int dim>
Input<dim> random_input(const ReferenceElement<dim> &element, const double m, RandomNumbers &random)
{
  Input<dim> x{
    straight(element, random_simplex<dim>(random)), QuadratureValues<dim, double>(element), {1.693, m, 0.05}};
  for (auto &position : x.X)
    position += 0.1 * random_vector<dim>(random);
  for (auto &v : x.w.V)
    v = random_vector<dim>(random);
  for (double &p : x.w.P)
    p = random.scalar();
  return x;
}

template <int dim>
Input<dim> random_direction(const Input<dim> &at, RandomNumbers &random)
{
  Input<dim> direction = at;
  direction.visit([&](double &x) { x = random.scalar(); });
  return direction;
}

template <int dim>
CellInput<dim, Dual> along(const Input<dim> &at, const Input<dim> &direction)
{
  CellInput<dim, Dual>      x{CellVectors<dim, Dual>(at.X.size()), {}, {}};
  const std::vector<double> values = at.numbers(), dots = direction.numbers();
  x.w.V.resize(at.w.V.size());
  x.w.P.resize(at.w.P.size());
  unsigned int n = 0;
  x.visit([&](Dual &number) {
    number                 = Dual(1, 0, values[n]);
    number.fastAccessDx(0) = dots[n++];
  });
  return x;
}

/// Zeros.
template <int dim>
Input<dim> no_derivatives(const ReferenceElement<dim> &element)
{
  return {CellVectors<dim, double>(element.n_positions()), QuadratureValues<dim, double>(element), {}};
}

template <int dim>
void check_transposes(const ReferenceElement<dim> &element,
                      const Input<dim>            &at,
                      RandomNumbers               &random,
                      Errors                      &errors)
{
  const auto       geometry  = geometry_of(element, at);
  const Input<dim> direction = random_direction(at, random);
  const auto       x         = along(at, direction);
  const auto       dots      = direction.numbers();
  const auto       lambda    = random_direction(at, random).w;

  const auto residual = flatten(cell_residual(geometry_of(element, x), x.w, x.law));
  Dual       product(0.);
  for (unsigned int i = 0; i < residual.size(); ++i)
    product += flatten(lambda)[i] * residual[i];
  Input<dim> bar = no_derivatives(element);
  const auto compare =
    [&](const std::string &what, const QuadratureSensitivity<dim> &s, const double expected) {
      bar.X   = s.X;
      bar.law = s.law;
      errors.compare(what, dot(bar.numbers(), dots), expected);
      bar = no_derivatives(element);
    };
  compare("residual", reverse_cell_residual(geometry, at.w, lambda, at.law, bar.w), product.dx(0));
  compare("dissipation",
          reverse_cell_dissipation(geometry, at.w, at.law, -0.7, bar.w),
          -0.7 * cell_dissipation(geometry_of(element, x), x.w, x.law).dx(0));
  reverse_cell_strain_rate(geometry, at.w, 0.4, bar.w, bar.X);
  errors.compare(
    "strain rate", dot(bar.numbers(), dots), 0.4 * cell_strain_rate(geometry_of(element, x), x.w).dx(0));

  bar                              = no_derivatives(element);
  const Symmetric<double> s_bar    = {{0.3, -0.2, 0.5, 0.7, -0.4, 0.1}};
  const Symmetric<Dual>   stress   = cell_deviatoric_stress(geometry_of(element, x), x.w, x.law);
  double                  expected = 0.;
  for (unsigned int k = 0; k < 6; ++k)
    expected += (k < 3 ? 1. : 2.) * s_bar[k] * stress[k].dx(0);
  compare("stress", reverse_cell_deviatoric_stress(geometry, at.w, at.law, s_bar, bar.w), expected);

  Input<dim> of_w = no_derivatives(element); // in the unknowns alone
  of_w.w          = direction.w;
  const auto y    = along(at, of_w);
  errors.compare("residual and functional",
                 dot(flatten(cell_residual(geometry, at.w, at.law)), flatten(of_w.w)),
                 cell_functional(geometry_of(element, y), y.w, y.law).dx(0));
}

/// The matrix of a tangent in the order of the unknowns, row by row.
template <int dim>
dealii::FullMatrix<double> matrix(const QuadratureTangent<dim> &t)
{
  const unsigned int         n = dim * t.A.n_rows(), m = t.B.n_cols();
  dealii::FullMatrix<double> H(n + m, n + m);
  for (unsigned int r = 0; r < n; ++r)
  {
    for (unsigned int s = 0; s < n; ++s)
      H(r, s) = t.A(r / dim, s / dim)[r % dim][s % dim];
    for (unsigned int b = 0; b < m; ++b)
      H(r, n + b) = H(n + b, r) = t.B(r / dim, b)[r % dim];
  }
  for (unsigned int a = 0; a < m; ++a)
    for (unsigned int b = 0; b < m; ++b)
      H(n + a, n + b) = t.C(a, b);
  return H;
}

std::vector<double> product(const dealii::FullMatrix<double> &H, const std::vector<double> &x)
{
  dealii::Vector<double> from(x.begin(), x.end()), to(H.m());
  H.vmult(to, from);
  return {to.begin(), to.end()};
}

template <int dim>
void check_tangent(const ReferenceElement<dim> &element,
                   const Input<dim>            &at,
                   RandomNumbers               &random,
                   Errors                      &errors)
{
  const auto                    geometry = geometry_of(element, at);
  const auto                    lambda   = random_direction(at, random).w;
  auto                          tangent  = cell_tangent(geometry, at.w, at.law, Linearisation::newton);
  const auto                    rhs      = product(matrix(tangent), flatten(lambda));
  QuadratureValues<dim, double> w_bar(element);
  reverse_cell_residual(geometry, at.w, lambda, at.law, w_bar);
  errors.compare("tangent times lambda", rhs, flatten(w_bar));
  if (!element.has_bubble())
    return;
  const unsigned int     n = lambda.V.size() - 1, m = lambda.P.size();
  const auto             bubble = eliminate_bubble(tangent);
  dealii::Tensor<1, dim> rhs_b;
  for (unsigned int i = 0; i < dim; ++i)
    rhs_b[i] = rhs[dim * n + i];
  std::vector<double> nodal = flatten(lambda), expected = rhs;
  for (auto *vector : {&nodal, &expected})
    vector->erase(vector->begin() + dim * n, vector->begin() + dim * (n + 1));
  for (unsigned int a = 0; a < n; ++a)
    for (unsigned int i = 0; i < dim; ++i)
      expected[dim * a + i] -= (bubble.Vb[a] * (bubble.M * rhs_b))[i];
  for (unsigned int b = 0; b < m; ++b)
    expected[dim * n + b] -= bubble.Pb[b] * (bubble.M * rhs_b);
  errors.compare("condensed system", product(matrix(tangent), nodal), expected);

  auto w     = at.w;
  w.V.back() = solve_bubble(geometry, w, at.law);
  // Of a force that the pressures alone would be.
  auto at_rest = w;
  for (auto &v : at_rest.V)
    v = dealii::Tensor<1, dim>();
  errors.compare("residual of the solved bubble",
                 1. + cell_residual(geometry, w, at.law).V.back().norm() /
                        cell_residual(geometry, at_rest, at.law).V.back().norm(),
                 1.);
}

/// What is left of the functional after residual and tangent, over halvings of a step.
template <int dim>
void print_taylor(const ReferenceElement<dim> &element, const Input<dim> &at, RandomNumbers &random)
{
  const auto   geometry  = geometry_of(element, at);
  const auto   direction = random_direction(at, random).w;
  const auto   tangent   = matrix(cell_tangent(geometry, at.w, at.law, Linearisation::newton));
  const double start     = cell_functional(geometry, at.w, at.law),
               slope     = dot(flatten(cell_residual(geometry, at.w, at.law)), flatten(direction)),
               curvature = dot(product(tangent, flatten(direction)), flatten(direction));
  double first = 0., second = 0.;
  for (const double step : {0.02, 0.01, 0.005, 0.0025})
  {
    auto w = at.w;
    for (unsigned int a = 0; a < w.V.size(); ++a)
      w.V[a] += step * direction.V[a];
    for (unsigned int b = 0; b < w.P.size(); ++b)
      w.P[b] += step * direction.P[b];
    const double after_residual = cell_functional(geometry, w, at.law) - start - step * slope,
                 after_tangent  = after_residual - 0.5 * step * step * curvature;
    if (first != 0.)
      std::cout << "  " << std::log2(first / after_residual) << " " << std::log2(second / after_tangent);
    first  = after_residual;
    second = after_tangent;
  }
  std::cout << std::endl;
}

/// v = s (c_0 x_0, c_1 x_1, ...), without divergence.
template <int dim>
void check_uniform(const ReferenceElement<dim>           &element,
                   const std::vector<dealii::Point<dim>> &nodes,
                   const double                           m,
                   RandomNumbers                         &random,
                   Errors                                &errors)
{
  const double s = 0.8, K = 1.693;
  Input<dim>   at{
    straight(element, random_simplex<dim>(random)), QuadratureValues<dim, double>(element), {K, m, 0.}};
  dealii::Tensor<1, dim> rate, centroid;
  for (unsigned int a = 0; a <= dim; ++a)
    centroid += at.X[a] / (dim + 1.);
  for (unsigned int i = 0; i < dim; ++i)
    rate[i] = i == dim - 1 ? -s : element.kinematics() == Kinematics::plane_strain ? s : 0.5 * s;
  for (unsigned int a = 0; a < nodes.size(); ++a)
    for (unsigned int i = 0; i < dim; ++i)
    {
      at.w.V[a][i] = rate[i] * at.X[0][i];
      for (unsigned int j = 0; j < dim; ++j)
        at.w.V[a][i] += rate[i] * nodes[a][j] * (at.X[j + 1] - at.X[0])[i];
    }
  const bool             plane    = element.kinematics() == Kinematics::plane_strain;
  const auto             geometry = geometry_of(element, at);
  dealii::Tensor<2, dim> edges;
  for (unsigned int j = 0; j < dim; ++j)
    edges[j] = at.X[j + 1] - at.X[0];
  double volume = determinant(edges) / (dim == 2 ? 2. : 6.);
  if (element.kinematics() == Kinematics::axisymmetric)
    volume *= 2. * dealii::numbers::PI * centroid[0];
  const double density =
    plane ? K * std::pow(2. * s, m + 1.) : K * std::pow(3., 0.5 * (m + 1.)) * std::pow(s, m + 1.);
  errors.compare("volume", cell_volume(geometry), volume);
  errors.compare("uniform strain rate", cell_strain_rate(geometry, at.w), plane ? 2. / std::sqrt(3.) * s : s);
  errors.compare("its dissipation", cell_dissipation(geometry, at.w, at.law), volume * density);

  if (nodes.size() == element.n_velocities() && element.has_bubble())
    return; // the vertices' functions do not sum to one
  // At the vertices, one of them on the axis.
  const double shift = at.X[0][0];
  for (auto &x : at.X)
    x[0] -= shift;
  for (unsigned int a = 0; a < nodes.size(); ++a)
    at.w.V[a][0] -= rate[0] * shift;
  const double across = dim == 3 ? rate[dim - 1] : plane ? 0. : rate[0];
  for (const Symmetric<double> &eps : corner_strain_rates(geometry_of(element, at), at.w))
    errors.compare(
      "uniform strain rate at the corners", {eps.begin(), eps.end()}, {rate[0], rate[1], across, 0., 0., 0.});
}

template <int dim>
void check(const std::string                     &name,
           const ReferenceElement<dim>           &element,
           const std::vector<dealii::Point<dim>> &nodes)
{
  Random random;
  Errors errors;
  for (const double m : {1., 0.3, 0.139})
    for (unsigned int k = 0; k < 10; ++k)
    {
      const Input<dim> at = random_input(element, m, random);
      check_transposes(element, at, random, errors);
      check_tangent(element, at, random, errors);
      check_uniform(element, nodes, m, random, errors);
    }
  std::cout << name << std::endl << "  orders of what residual and tangent leave:";
  print_taylor(element, random_input(element, 0.3, random), random);
  errors.print(1e-12);
}

template <int dim>
void check_pairs(const std::string &name, const Kinematics kinematics)
{
  const auto mini_nodes      = dealii::FE_SimplexP<dim>(1).get_unit_support_points();
  const auto quadratic_nodes = dealii::FE_SimplexP<dim>(2).get_unit_support_points();
  for (const unsigned int degree : {1, 2})
  {
    const std::string geometry = ", " + name + ", geometry of degree " + std::to_string(degree);
    check("mini" + geometry, mini_reference<dim>(degree, kinematics), mini_nodes);
    check("P2-P1" + geometry, taylor_hood_reference<dim>(degree, kinematics), quadratic_nodes);
  }
}

int main()
{
  std::cout.precision(2);
  check_pairs<3>("space", Kinematics::three_dimensions);
  check_pairs<2>("plane strain", Kinematics::plane_strain);
  check_pairs<2>("around an axis", Kinematics::axisymmetric);
  // A pair without closed form, that of Crouzeix and Raviart, on curved cells.
  const dealii::FE_SimplexP_Bubbles<2> velocity(2);
  check("P2+-P1dc, around an axis, geometry of degree 2",
        ReferenceElement<2>(dealii::FE_SimplexP<2>(2),
                            velocity,
                            dealii::FE_SimplexDGP<2>(1),
                            dealii::QGaussSimplex<2>(3),
                            Kinematics::axisymmetric),
        velocity.get_unit_support_points());
}
