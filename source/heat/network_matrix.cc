// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/lac/solver_cg.h>

#include <retroforge/heat/network_matrix.h>
#include <retroforge/linear_algebra/direct_solver.h>

namespace retroforge
{
  NetworkMatrix::NetworkMatrix(const NetworkEdges &edges,
                               std::vector<double> diagonal,
                               std::vector<double> couplings)
      : edges_(edges), D_(std::move(diagonal)), g_(std::move(couplings))
  {
    dealii::Vector<double> inverse(D_.begin(), D_.end());
    for_each_edge(edges_, [&](const unsigned int e, const NodeIndex a, const NodeIndex b) {
      inverse[a] += g_[e];
      inverse[b] += g_[e];
    });
    for (double &x : inverse)
      x = 1. / x;
    preconditioner_.reinit(inverse);
  }

  void NetworkMatrix::vmult(dealii::Vector<double> &y, const dealii::Vector<double> &x) const
  {
    for (std::size_t i = 0; i < x.size(); ++i)
      y[i] = D_[i] * x[i];
    for_each_edge(edges_, [&](const unsigned int e, const NodeIndex a, const NodeIndex b) {
      const double flow = g_[e] * (x[a] - x[b]);
      y[a] += flow;
      y[b] -= flow;
    });
  }

  std::vector<double> NetworkMatrix::solve(const std::vector<double> &b,
                                           const std::vector<double> &start) const
  {
    constexpr double                         tolerance = 1e-13;
    const dealii::Vector<double>             rhs(b.begin(), b.end());
    dealii::Vector<double>                   x(start.begin(), start.end());
    dealii::SolverControl                    control(10000, tolerance * rhs.l2_norm());
    dealii::SolverCG<dealii::Vector<double>> cg(control);
    try
    {
      cg.solve(*this, x, rhs, preconditioner_);
    }
    catch (const dealii::SolverControl::NoConvergence &failure)
    {
      throw NoLinearSolution("Heat",
                             "conduction was not solved in " + std::to_string(failure.last_step) +
                               " iterations",
                             "capacities and conductances of the metal's cells are positive numbers",
                             "look at Heat/heat capacity and conductivity, or use a better mesh");
    }
    return std::vector<double>(x.begin(), x.end());
  }
} // namespace retroforge
