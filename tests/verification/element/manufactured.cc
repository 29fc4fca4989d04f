// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Convergence to a manufactured flow on unstructured meshes of a cube: velocities given on five faces, the
// traction on the sixth, a body force inside; Newtonian and power-law metal, both pairs of elements. Expected
// of the mini element: the errors of the velocity (bubble included) fall as h^2, of its gradient as h, of the
// pressure as h or faster; of P2/P1: as h^3, h^2 and h^2. Orders are slopes of the line of least squares
// through the meshes. The file `output` holds what is compared: whether the orders are reached.

#include <deal.II/base/mpi.h>

#include <fstream>
#include <iostream>
#include <type_traits>
#include <utility>

#include "manufactured_flow.h"

using namespace retroforge;

struct FlowErrors
{
  double h, v_l2, v_h1, p_l2;
};

const std::string               free_patch = "side +x";
const std::vector<SubCellPoint> points     = sub_cell_points();

template <typename Pair>
using Values = typename Pair::template Values<double>;

/// One Newton step; returns its length relative to the velocity.
template <typename Pair>
double newton_step(const ManufacturedFlow          &flow,
                   const TetMesh                   &mesh,
                   const Discretization<3>         &discretization,
                   const std::vector<Values<Pair>> &loads,
                   const NodalVectors<double>      &traction,
                   GlobalSystem                    &system,
                   Field<double>                   &W)
{
  std::vector<Values<Pair>> rhs(loads);
  std::vector<CellTangent>  tangents; // of cells with bubbles
  NodalVectors<double>      boundary = traction;
  system.assemble([&](const CellIndex c) {
    const auto geometry = geometry_of_cell(discretization, mesh.X, c);
    const auto w        = Pair::on_cell(discretization, W, c);
    auto       residual = cell_residual(geometry, w, flow.law);
    for (unsigned int a = 0; a < discretization.n_nodes_per_cell(); ++a)
      // Traction is given to the node's first cell.
      rhs[c].V[a] += std::exchange(boundary[discretization.velocity_places(c)[a]], Vec3()) - residual.V[a];
    for (unsigned int a = 0; a < 4; ++a)
      rhs[c].P[a] -= residual.P[a];
    if constexpr (std::is_same_v<Pair, MiniPair>)
      rhs[c].beta -= residual.beta;
    const auto tangent = tangent_of(geometry, w, flow.law);
    if constexpr (std::is_same_v<Pair, MiniPair>)
      tangents.push_back(tangent);
    return cell_system(tangent, rhs[c]);
  });
  const std::vector<double> x = system.solve();

  const Unknowns unknowns(discretization);
  Field<double>  step(discretization);
  double         step2 = 0., size2 = 0.;
  for (NodeIndex k = 0; k < discretization.condensed_nodes()->n(); ++k)
  {
    for (unsigned int i = 0; i < 3; ++i)
      step.V[k][i] = x[unknowns.velocity(k, i)];
    step2 += step.V[k].norm_square();
    size2 += W.V[k].norm_square();
  }
  for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
    step.P[k] = x[unknowns.pressure(k)];
  if constexpr (std::is_same_v<Pair, MiniPair>)
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    {
      const auto w                     = Pair::on_cell(discretization, step, c);
      step.V[discretization.bubble(c)] = tangents[c].recover_bubble(rhs[c].beta, w.V, w.P);
    }
  W.add(1., step);
  return std::sqrt(step2 / size2);
}

template <typename Pair>
FlowErrors errors_of(const TetMesh &mesh, const Discretization<3> &discretization, const Field<double> &W)
{
  FlowErrors e{mean_edge(mesh), 0., 0., 0.};
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
  {
    const auto X        = positions_of_cell(discretization, mesh.X, c);
    const auto geometry = cell_geometry(X);
    auto       w        = Pair::on_cell(discretization, W, c);
    for (const SubCellPoint &point : points)
    {
      const Vec3 x  = point.position(X);
      Vec3       dv = -ManufacturedFlow::velocity_at(x);
      double     dp = -ManufacturedFlow::pressure_at(x);
      auto       dL = ManufacturedFlow::velocity_gradient(std::array<double, 3>{{x[0], x[1], x[2]}});
      for (unsigned int a = 0; a < 4; ++a)
        dp += point.lambda[a] * w.P[a];
      const auto values    = velocity_functions(Pair(), point);
      const auto gradients = velocity_gradients(Pair(), geometry, point);
      for (unsigned int f = 0; f < values.size(); ++f)
      {
        dv += values[f] * coefficient(w, f);
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int j = 0; j < 3; ++j)
            dL[i][j] -= coefficient(w, f)[i] * gradients[f][j];
      }
      const double dx = point.weight * geometry.volume;
      e.v_l2 += dv.norm_square() * dx;
      e.p_l2 += dp * dp * dx;
      for (const auto &row : dL)
        e.v_h1 += (row[0] * row[0] + row[1] * row[1] + row[2] * row[2]) * dx;
    }
  }
  e.v_l2 = std::sqrt(e.v_l2);
  e.v_h1 = std::sqrt(e.v_h1);
  e.p_l2 = std::sqrt(e.p_l2);
  return e;
}

template <typename Pair>
FlowErrors solve_on(const ManufacturedFlow &flow, const double element_size, std::ostream &output)
{
  const TetMesh           mesh = unit_cube(element_size);
  const Discretization<3> discretization(
    mesh, {std::is_same_v<Pair, MiniPair> ? ElementPair::mini : ElementPair::taylor_hood}, MPI_COMM_SELF);
  std::vector<Values<Pair>> loads;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    loads.push_back(flow.body_load(Pair(), points, positions_of_cell(discretization, mesh.X, c)));
  const auto     traction = flow.traction_load(mesh, discretization, free_patch);
  const Unknowns unknowns(discretization);
  GlobalSystem   system(mesh, unknowns, held_velocities(mesh, discretization, free_patch));
  Field<double>  W    = flow.interpolant(mesh, discretization);
  double         step = 1.;
  for (unsigned int iteration = 0; iteration < (flow.law.m == 1. ? 1 : 8) && step > 1e-9; ++iteration)
    step = newton_step<Pair>(flow, mesh, discretization, loads, traction, system, W);
  if (flow.law.m != 1.)
    output << "  Newton converged: " << (step < 1e-9 ? "yes" : "NO") << std::endl;
  const FlowErrors e = errors_of<Pair>(mesh, discretization, W);
  std::cout << mesh.n_nodes() << " nodes: v_l2 " << e.v_l2 << ", v_h1 " << e.v_h1 << ", p_l2 " << e.p_l2
            << std::endl;
  return e;
}

/// Slope of log(error) over log(h).
double order(const std::vector<FlowErrors> &errors, double FlowErrors::*error)
{
  double n = errors.size(), x = 0., y = 0., xx = 0., xy = 0.;
  for (const FlowErrors &e : errors)
  {
    const double lx = std::log(e.h), ly = std::log(e.*error);
    x += lx;
    y += ly;
    xx += lx * lx;
    xy += lx * ly;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

/// What the orders of an element must reach, and the meshes that show it.
struct Expected
{
  double              v_l2, v_h1, p_l2;
  std::vector<double> sizes;
};

template <typename Pair>
void check(const std::string        &name,
           const NortonHoff<double> &law,
           const Expected           &expected,
           std::ostream             &output)
{
  output << name << std::endl;
  std::vector<FlowErrors> errors;
  for (const double size : expected.sizes)
    errors.push_back(solve_on<Pair>({law}, size, output));
  const auto report = [&](const std::string &quantity, double FlowErrors::*error, const double bar) {
    const double value = order(errors, error);
    std::cout << "FIGURE " << name << "_" << quantity << "_order " << value << std::endl;
    output << "  order of " << quantity << " at least " << bar << ": " << (value >= bar ? "yes" : "NO")
           << std::endl;
  };
  report("v_l2", &FlowErrors::v_l2, expected.v_l2);
  report("v_h1", &FlowErrors::v_h1, expected.v_h1);
  report("p_l2", &FlowErrors::p_l2, expected.p_l2);
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  std::ofstream                            output("output");
  const NortonHoff<double>                 newtonian{1., 1., 0.}, power_law{1., 0.3, 0.5};
  const Expected                           mini{1.9, 0.95, 1.2, {1. / 5., 1. / 7., 1. / 10., 1. / 14.}};
  const Expected                           quadratic{2.9, 1.9, 1.9, {1. / 3., 1. / 5., 1. / 7., 1. / 10.}};
  check<MiniPair>("newtonian", newtonian, mini, output);
  check<MiniPair>("power_law", power_law, mini, output);
  check<TaylorHoodPair>("quadratic_newtonian", newtonian, quadratic, output);
  check<TaylorHoodPair>("quadratic_power_law", power_law, quadratic, output);
}
