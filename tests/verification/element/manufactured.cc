// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Convergence to a manufactured flow on unstructured meshes of a cube: velocities given on five faces, the
// traction on the sixth, a body force inside; Newtonian and power-law metal. Expected of a first-order pair
// of elements: the errors of the velocity (bubble included) fall as h^2, of its gradient as h, of the
// pressure as h or faster. Orders are slopes of the line of least squares through the meshes. The file
// `output` holds what is compared: whether the orders are reached.

#include <deal.II/base/mpi.h>

#include <fstream>
#include <iostream>

#include "manufactured_flow.h"

using namespace retroforge;

struct FlowErrors
{
  double h, v_l2, v_h1, p_l2;
};

const std::string               free_patch = "side +x";
const std::vector<SubCellPoint> points     = sub_cell_points();

/// One Newton step; returns its length relative to the velocity.
double newton_step(const ManufacturedFlow                &flow,
                   const TetMesh                         &mesh,
                   const Spaces                          &spaces,
                   const std::vector<CellValues<double>> &loads,
                   const NodalVectors<double>            &traction,
                   NodalSystem                           &system,
                   Field<double>                         &W)
{
  std::vector<CellTangent> tangents(mesh.n_cells());
  std::vector<Vec3>        bubble_rhs(mesh.n_cells());
  NodalVectors<double>     boundary = traction;
  system.assemble([&](const CellIndex c) {
    const auto         geometry = cell_geometry(positions_of_cell(mesh, mesh.X, c));
    const auto         w        = MiniPair::on_cell(spaces, W, c);
    CellValues<double> rhs      = loads[c];
    const auto         residual = cell_residual(geometry, w, flow.law);
    for (unsigned int a = 0; a < 4; ++a)
    {
      const NodeIndex k = mesh.cells[c][a];
      rhs.V[a] += boundary[k] - residual.V[a];
      rhs.P[a] -= residual.P[a];
      boundary[k] = Vec3(); // given to the node's first cell
    }
    rhs.beta -= residual.beta;
    bubble_rhs[c] = rhs.beta;
    compute_cell_tangent(geometry, w, flow.law, tangents[c]);
    return condensed_system(tangents[c], rhs);
  });
  const std::vector<double> x = system.solve();

  Field<double> step(spaces);
  double        step2 = 0., size2 = 0.;
  for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
  {
    step.V[k] = Vec3({x[4 * k], x[4 * k + 1], x[4 * k + 2]});
    step.P[k] = x[4 * k + 3];
    step2 += step.V[k].norm_square();
    size2 += W.V[k].norm_square();
  }
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
  {
    const auto w = MiniPair::on_cell(spaces, step, c);
    step.beta[c] = tangents[c].recover_bubble(bubble_rhs[c], w.V, w.P);
  }
  W.add(1., step);
  return std::sqrt(step2 / size2);
}

FlowErrors errors_of(const TetMesh &mesh, const Spaces &spaces, const Field<double> &W)
{
  FlowErrors e{mean_edge(mesh), 0., 0., 0.};
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
  {
    const auto X        = positions_of_cell(mesh, mesh.X, c);
    const auto geometry = cell_geometry(X);
    const auto w        = MiniPair::on_cell(spaces, W, c);
    for (const SubCellPoint &point : points)
    {
      const Vec3 x  = point.position(X);
      Vec3       dv = point.bubble * w.beta - ManufacturedFlow::velocity_at(x);
      double     dp = -ManufacturedFlow::pressure_at(x);
      auto       dL = ManufacturedFlow::velocity_gradient(std::array<double, 3>{{x[0], x[1], x[2]}});
      for (unsigned int a = 0; a < 4; ++a)
      {
        dv += point.lambda[a] * w.V[a];
        dp += point.lambda[a] * w.P[a];
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int j = 0; j < 3; ++j)
            dL[i][j] -=
              w.V[a][i] * geometry.g[a][j] + (a == point.sub ? 4. * w.beta[i] * geometry.g[a][j] : 0.);
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

FlowErrors solve_on(const ManufacturedFlow &flow, const double element_size, std::ostream &output)
{
  const TetMesh                   mesh = unit_cube(element_size);
  const Spaces                    spaces(mesh, Topology(mesh), ElementPair::mini);
  std::vector<CellValues<double>> loads;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    loads.push_back(flow.body_load(points, positions_of_cell(mesh, mesh.X, c)));
  const auto    traction = flow.traction_load(mesh, free_patch);
  NodalSystem   system(mesh, held_velocities(mesh, free_patch));
  Field<double> W    = flow.interpolant(mesh, spaces);
  double        step = 1.;
  for (unsigned int iteration = 0; iteration < (flow.law.m == 1. ? 1 : 8) && step > 1e-9; ++iteration)
    step = newton_step(flow, mesh, spaces, loads, traction, system, W);
  if (flow.law.m != 1.)
    output << "  Newton converged: " << (step < 1e-9 ? "yes" : "NO") << std::endl;
  const FlowErrors e = errors_of(mesh, spaces, W);
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

void check(const std::string &name, const NortonHoff<double> &law, std::ostream &output)
{
  output << name << std::endl;
  std::vector<FlowErrors> errors;
  for (const double size : {1. / 5., 1. / 7., 1. / 10., 1. / 14.})
    errors.push_back(solve_on({law}, size, output));
  const auto report = [&](const std::string &quantity, double FlowErrors::*error, const double bar) {
    const double value = order(errors, error);
    std::cout << "FIGURE " << name << "_" << quantity << "_order " << value << std::endl;
    output << "  order of " << quantity << " at least " << bar << ": " << (value >= bar ? "yes" : "NO")
           << std::endl;
  };
  report("v_l2", &FlowErrors::v_l2, 1.9);
  report("v_h1", &FlowErrors::v_h1, 0.95);
  report("p_l2", &FlowErrors::p_l2, 1.2);
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  std::ofstream                            output("output");
  check("newtonian", {1., 1., 0.}, output);
  check("power_law", {1., 0.3, 0.5}, output);
}
