// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Cells of quadratic geometry on Discretization<2>: a quarter of a ring between circles of radius 1 and 2, of
// which all nodes of the positions lie on their circles. Proved:
// - with P2-P1 the area is found with order 4, where straight cells have order 2;
// - so is the power of a flow of a power law that spreads from the middle, v = e_r / r, which is held at the
//   inner circle and free at the outer one;
// - of both pairs, derivatives by all nodes of the positions, and by the vertices of straight cells, are each
//   the transpose of what dual numbers say along a direction.

#include "plane_flow.h"

using namespace retroforge;

constexpr double inner = 1., outer = 2.;

/// From the unit square: x is the distance from the inner circle, y the angle.
dealii::Tensor<1, 2> on_ring(const dealii::Tensor<1, 2> &x)
{
  const double r = inner + (outer - inner) * x[0], angle = 0.5 * dealii::numbers::PI * x[1];
  return dealii::Tensor<1, 2>({r * std::cos(angle), r * std::sin(angle)});
}

SimplexMesh<2> ring(const unsigned int n)
{
  auto mesh = unit_square(n, 0., {lower, upper});
  for (auto &x : mesh.X)
    x = on_ring(x);
  mesh.patches[upper].symmetry = Hyperplane<2>{{}, dealii::Tensor<1, 2>({-1., 0.})};
  return mesh;
}

/// Positions of all nodes: those in the middles of edges are where the middles of the square go.
CellVectors<2, double> curved(const Discretization<2> &discretization, const unsigned int n)
{
  const auto             square = unit_square(n, 0., {});
  CellVectors<2, double> X      = square.X;
  for (auto &x : X)
    x = on_ring(x);
  std::map<NodeIndex, dealii::Tensor<1, 2>> middles;
  for (const CellIndex c : discretization.visited_cells())
    for (unsigned int a = 3; a < 6; ++a)
    {
      const NodeIndex k = discretization.geometry_nodes(c)[a];
      const auto [i, j] = discretization.ends_of_geometry_node(k);
      middles[k]        = on_ring(0.5 * (square.X[i] + square.X[j]));
    }
  for (const auto &[k, x] : middles)
    X.push_back(x);
  return X;
}

struct Found
{
  double area, power;
};

Found found(const unsigned int n, const bool is_curved, const double m)
{
  PlaneFlow flow(ring(n), plane_choice(ElementPair::taylor_hood, Kinematics::plane_strain, 2));
  if (is_curved)
    flow.X = curved(flow.discretization, n);
  const auto spreading = [](const dealii::Tensor<1, 2> &x) { return x / x.norm_square(); };
  flow.set_velocity(spreading);
  for (const CellIndex c : flow.discretization.visited_cells())
    for (unsigned int a = 0; a < 6; ++a)
    {
      const NodeIndex k = flow.discretization.geometry_nodes(c)[a];
      const auto      x = position_of_node(flow.discretization, flow.X, k);
      if (k < flow.discretization.condensed_nodes()->n() && x.norm() < inner + 0.1 / n)
      {
        flow.W.V[k] = spreading(x);
        flow.hold(k);
      }
    }
  flow.solve({1., m, 0.});
  Found of{0., flow.power({1., m, 0.})};
  for (const CellIndex c : flow.discretization.cells().owned())
    of.area += cell_volume(flow.geometry_of(c));
  return of;
}

/// Along a direction of positions, of all nodes or of the vertices.
void check_derivatives(const ElementPair pair, const bool is_curved, Errors &errors)
{
  constexpr unsigned int   n = 2;
  PlaneFlow                flow(ring(n), plane_choice(pair, Kinematics::plane_strain, 2));
  const Discretization<2> &discretization = flow.discretization;
  if (is_curved)
    flow.X = curved(discretization, n);
  RandomNumbers random;
  for (auto &v : flow.W.V)
    v = random_vector<2>(random);
  const MaterialLaw<double>         law{1., 0.3, 0.1};
  CellVectors<2, Dual>              x(flow.X.size());
  CellVectors<2, double>            X_bar(flow.X.size());
  double                            backward = 0.;
  std::vector<dealii::Tensor<1, 2>> direction;
  for (std::size_t k = 0; k < x.size(); ++k)
  {
    direction.push_back(random_vector<2>(random));
    for (unsigned int i = 0; i < 2; ++i)
    {
      x[k][i]                 = Dual(flow.X[k][i]);
      x[k][i].fastAccessDx(0) = direction[k][i];
    }
  }
  Dual power(0.);
  for (const CellIndex c : discretization.cells().owned())
  {
    const auto                w = flow.values_of(c);
    QuadratureValues<2, Dual> constant(*flow.pair.element);
    for (unsigned int a = 0; a < w.V.size(); ++a)
      for (unsigned int i = 0; i < 2; ++i)
        constant.V[a][i] = w.V[a][i];
    power += cell_dissipation(flow.pair.positions(discretization, x, c), constant, converted<Dual>(law));
    auto w_bar = flow.pair.no_values();
    add_to_positions(
      discretization, reverse_cell_dissipation(flow.geometry_of(c), w, law, 1., w_bar).X, c, X_bar);
  }
  for (std::size_t k = 0; k < x.size(); ++k)
    backward += X_bar[k] * direction[k];
  errors.compare(is_curved ? "derivatives by all nodes" : "derivatives by vertices", backward, power.dx(0));
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  // eps_rr = -1/r^2 = -eps_tt:  the density of the power is K (2/r^2)^(m+1).
  constexpr double m     = 0.3;
  const double     area  = 0.25 * dealii::numbers::PI * (outer * outer - inner * inner);
  const double     power = 0.5 * dealii::numbers::PI * std::pow(2., m + 1.) / (2. * m) *
                       (std::pow(inner, -2. * m) - std::pow(outer, -2. * m));
  for (const bool is_curved : {false, true})
  {
    constexpr unsigned int n      = 8;
    const Found            coarse = found(n, is_curved, m), fine = found(2 * n, is_curved, m);
    const auto             print =
      [&](const std::string &what, const double expected, const double far, const double near) {
        const double order = std::log2(std::abs(far / near));
        std::cout << "  " << what << ", order " << expected << ": " << (order > expected - 0.2 ? "yes" : "NO")
                  << ", " << order << std::endl;
      };
    std::cout << (is_curved ? "curved" : "straight") << std::endl;
    print("area", is_curved ? 4. : 2., coarse.area / area - 1., fine.area / area - 1.);
    print("power", is_curved ? 4. : 2., coarse.power / power - 1., fine.power / power - 1.);
  }
  for (const ElementPair pair : {ElementPair::mini, ElementPair::taylor_hood})
  {
    Errors errors;
    for (const bool is_curved : {false, true})
      check_derivatives(pair, is_curved, errors);
    std::cout << name_of(pair) << std::endl;
    errors.print(1e-12);
  }
}
