// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The accumulated equivalent strain and its reverse, on a mesh of 12 cells about one inner node.
// - By hand: upsetting V = s (x/2, y/2, -z) has eps = s diag(1/2, 1/2, -1) and e = s, simple shear
//   V = s (z, 0, 0) has e = s/sqrt(3); over dt = 0.25 with s = 0.8 each cell gains 0.2 and 0.11547. With
//   bubbles it gains the mean of cell_strain_rates().
// - <A x_dot, y> = <x_dot, A^T y> for all inputs (V, beta, X, q, dt) at once and for each alone, A from Dual.
// - At rest, and where the bubble brings one sub-tetrahedron of a cell to rest, derivatives are finite; in
//   the first case they are zero.

#include <deal.II/base/mpi.h>

#include <retroforge/mesh/mesh_quality.h>

#include "../element/element_test_tools.h"
#include "mini_discretization.h"
#include <retroforge/core/dual.h>
#include <retroforge/discretization/strain_history.h>

using namespace retroforge;

// A cube of edge 2 cut into two tetrahedra per face and the centre, its corners shaken.
TetMesh small_mesh(Random &random)
{
  TetMesh mesh;
  for (unsigned int i = 0; i < 8; ++i)
    mesh.X.push_back(Vec3({i & 1 ? 1. : -1., i & 2 ? 1. : -1., i & 4 ? 1. : -1.}) + 0.2 * random.vector());
  mesh.X.push_back(0.2 * random.vector());
  const unsigned int sides[6][4] = {
    {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto &s : sides)
    for (const auto &cell : {std::array<NodeIndex, 4>{{s[0], s[1], s[2], 8}}, {{s[0], s[2], s[3], 8}}})
    {
      auto &last = mesh.cells.emplace_back(cell);
      if (tet_volume(corners(last, mesh.X)) < 0.)
        std::swap(last[0], last[1]);
    }
  return mesh;
}

/// Everything the update depends on, or a direction in that, or an adjoint of it.
template <typename Number>
struct Inputs
{
  NodalVectors<Number> X;
  Field<Number>        W;
  Number               dt;
  std::vector<Number>  q;

  std::vector<Number *> entries()
  {
    std::vector<Number *> all;
    const auto            add = [&](auto &vectors) {
      for (auto &v : vectors)
        for (unsigned int d = 0; d < 3; ++d)
          all.push_back(&v[d]);
    };
    add(X);
    add(W.V); // bubbles last
    all.push_back(&dt);
    for (Number &value : q)
      all.push_back(&value);
    return all;
  }
};

template <typename Number>
Inputs<Number> empty_inputs(const TetMesh &mesh)
{
  return {NodalVectors<Number>(mesh.n_nodes()),
          Field<Number>(mini_discretization(mesh)),
          Number(0.),
          std::vector<Number>(mesh.n_cells(), Number(0.))};
}

/// The tangent along `direction` against the reverse of y, relative to the sum of absolute products.
double dot_product_defect(const TetMesh             &mesh,
                          Inputs<double>             at,
                          Inputs<double>             direction,
                          const std::vector<double> &y)
{
  auto       dual = empty_inputs<Dual>(mesh);
  const auto in = at.entries(), in_dot = direction.entries();
  const auto in_dual = dual.entries();
  for (std::size_t i = 0; i < in.size(); ++i)
  {
    *in_dual[i]                 = Dual(1, 0, *in[i]);
    in_dual[i]->fastAccessDx(0) = *in_dot[i];
  }
  const auto tangent = accumulate_strain(mini_discretization(mesh), dual.X, dual.W, dual.dt, dual.q);
  auto       bar     = empty_inputs<double>(mesh);
  bar.q              = y;
  bar.dt         = reverse_accumulate_strain(mini_discretization(mesh), at.X, at.W, at.dt, y, bar.W, bar.X);
  double forward = 0., reverse = 0., size = 0.;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
  {
    forward += tangent[c].dx(0) * y[c];
    size += std::abs(tangent[c].dx(0) * y[c]);
  }
  const auto in_bar = bar.entries();
  for (std::size_t i = 0; i < in_bar.size(); ++i)
    reverse += *in_bar[i] * *in_dot[i];
  const double defect = std::abs(forward - reverse) / (size > 0. ? size : 1.);
  return std::isfinite(defect) ? defect : 1e300;
}

Inputs<double> random_inputs(const TetMesh &mesh, Random &random)
{
  auto inputs = empty_inputs<double>(mesh);
  for (double *entry : inputs.entries())
    *entry = random.scalar();
  return inputs;
}

void check_by_hand(const TetMesh &mesh, Random &random)
{
  auto flow = empty_inputs<double>(mesh), shear = flow;
  for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
  {
    const Vec3 &x = mesh.X[k];
    flow.W.V[k]   = 0.8 * Vec3({x[0] / 2, x[1] / 2, -x[2]});
    shear.W.V[k]  = 0.8 * Vec3({x[2], 0, 0});
  }
  Errors     errors;
  const auto q = accumulate_strain(mini_discretization(mesh), mesh.X, flow.W, 0.25, flow.q);
  errors.compare("upsetting", q, std::vector<double>(mesh.n_cells(), 0.2));
  const auto sheared = accumulate_strain(mini_discretization(mesh), mesh.X, shear.W, 0.25, q);
  errors.compare("shear after it", sheared, std::vector<double>(mesh.n_cells(), 0.2 + 0.2 / std::sqrt(3.)));

  const auto          any = random_inputs(mesh, random);
  std::vector<double> expected;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
  {
    const auto e = cell_strain_rates(geometry_of_cell(mini_discretization(mesh), mesh.X, c),
                                     MiniPair::on_cell(mini_discretization(mesh), any.W, c));
    expected.push_back(any.q[c] + any.dt * (e[0] + e[1] + e[2] + e[3]) / 4.);
  }
  errors.compare(
    "with bubbles", accumulate_strain(mini_discretization(mesh), mesh.X, any.W, any.dt, any.q), expected);
  errors.print(1e-14);
}

void check_reverse(const TetMesh &mesh, Random &random)
{
  Errors errors;
  for (unsigned int n = 0; n < 20; ++n)
  {
    auto at              = random_inputs(mesh, random);
    at.X                 = mesh.X;
    const auto y         = random_inputs(mesh, random).q;
    const auto direction = random_inputs(mesh, random);
    const auto zero      = empty_inputs<double>(mesh);
    const auto alone     = [&](const std::string &what, const auto &choose) {
      auto part = zero;
      choose(part);
      errors.compare(what, 1. + dot_product_defect(mesh, at, part, y), 1.);
    };
    alone("dot product, all", [&](auto &part) { part = direction; });
    const auto bubbles = [&](const NodeIndex k) { return k >= mesh.n_nodes(); };
    alone("dot product, V", [&](auto &part) {
      for (NodeIndex k = 0; k < part.W.V.size(); ++k)
        part.W.V[k] = bubbles(k) ? Vec3() : direction.W.V[k];
    });
    alone("dot product, X", [&](auto &part) { part.X = direction.X; });
    alone("dot product, beta", [&](auto &part) {
      for (NodeIndex k = 0; k < part.W.V.size(); ++k)
        part.W.V[k] = bubbles(k) ? direction.W.V[k] : Vec3();
    });
    alone("dot product, dt", [&](auto &part) { part.dt = direction.dt; });
    alone("dot product, q", [&](auto &part) { part.q = direction.q; });
  }
  errors.print(1e-13);
}

/// Largest entry of the reverse in V, beta and X; huge when it is not finite.
double largest_derivative(const TetMesh &mesh, const Field<double> &W)
{
  auto bar = empty_inputs<double>(mesh);
  reverse_accumulate_strain(
    mini_discretization(mesh), mesh.X, W, 0.25, std::vector<double>(mesh.n_cells(), 1.), bar.W, bar.X);
  double largest = 0.;
  for (const double *entry : bar.entries())
    largest = std::isfinite(*entry) ? std::max(largest, std::abs(*entry)) : 1e300;
  return largest;
}

void check_at_rest(const TetMesh &mesh, Random &random)
{
  auto at = empty_inputs<double>(mesh);
  at.X    = mesh.X;
  at.dt   = 0.25;
  Errors errors;
  errors.compare("no derivative at rest", largest_derivative(mesh, at.W), 0.);
  errors.compare("dot product at rest",
                 1. +
                   dot_product_defect(mesh, at, random_inputs(mesh, random), random_inputs(mesh, random).q),
                 1.);
  // On w_0 of cell 0 the bubble's gradient 4 beta (x) g_0 cancels that of the nodes, V_0 (x) g_0.
  const auto  geometry = geometry_of_cell(mini_discretization(mesh), mesh.X, 0);
  const auto &first    = mesh.cells[0];
  const Vec3  beta     = Vec3({0.5, 0.25, -1});
  MiniPair::bubble(mini_discretization(mesh), at.W, 0) = beta;
  at.W.V[first[0]]                                     = -4. * beta;
  const auto e = cell_strain_rates(geometry, MiniPair::on_cell(mini_discretization(mesh), at.W, 0));
  errors.compare("one part of a cell at rest", e[0], 0.);
  errors.print(1e-13);
  std::cout << "  the others move, derivatives finite: "
            << (e[1] > 0.1 && largest_derivative(mesh, at.W) < 100. ? "yes" : "NO") << std::endl;
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  Random                                   random;
  const TetMesh                            mesh = small_mesh(random);
  std::cout << "values" << std::endl;
  check_by_hand(mesh, random);
  std::cout << "reverse" << std::endl;
  check_reverse(mesh, random);
  std::cout << "at rest" << std::endl;
  check_at_rest(mesh, random);
}
