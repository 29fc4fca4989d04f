// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The inf-sup constants of both pairs in the plane: the root of the smallest eigenvalue, that of constants
// aside, of  B^T A^-1 B p = beta^2 M p  with M the mass matrix of the pressures, A the energy of 2 eps:eps,
// and v = 0 on the whole boundary of the unit square. They must not fall as the mesh is refined. Linear
// velocities without the bubble are the control: theirs is zero.

#include "plane_flow.h"

#include <deal.II/lac/lapack_full_matrix.h>

using namespace retroforge;

/// beta^2 in ascending order.
std::vector<double> eigenvalues(const PlanePair &pair, const unsigned int n)
{
  dealii::Triangulation<2> triangulation;
  make_square(triangulation, n, 0.2);
  const PlaneFlow   flow(triangulation, pair, Kinematics::plane_strain);
  std::vector<char> held(flow.dofs.n_dofs(), 0), is_pressure(flow.dofs.n_dofs(), 0);
  flow.for_each_node([&](const dealii::Point<2> &x, const std::array<unsigned int, 2> &node) {
    if (std::min(x[0], x[1]) < 1e-9 || std::max(x[0], x[1]) > 1. - 1e-9)
      held[node[0]] = held[node[1]] = 1;
  });
  for (const auto &cell : flow.dofs.active_cell_iterators())
  {
    const auto indices = flow.indices_of(cell);
    for (unsigned int i = 0; i < indices.size(); ++i)
      is_pressure[indices[i]] = flow.fe.system_to_component_index(i).first == 2;
  }
  std::vector<unsigned int> place(held.size());
  unsigned int              n_v = 0, n_p = 0;
  for (unsigned int i = 0; i < held.size(); ++i)
    place[i] = is_pressure[i] ? n_p++ : held[i] ? dealii::numbers::invalid_unsigned_int : n_v++;

  dealii::LAPACKFullMatrix<double> A(n_v, n_v), B(n_v, n_p), S(n_p, n_p), M(n_p, n_p);
  for (const auto &cell : flow.dofs.active_cell_iterators())
  {
    const auto   indices = flow.indices_of(cell);
    const auto   local   = flow.matrix_of(cell, {1., 1., 0.}, Linearisation::newton);
    const double area    = cell_volume(flow.geometry_of(cell));
    for (unsigned int i = 0; i < indices.size(); ++i)
      for (unsigned int j = 0; j < indices.size(); ++j)
      {
        const unsigned int r = indices[i], s = indices[j];
        if (held[r] || held[s])
          continue;
        if (is_pressure[r] && is_pressure[s])
          M(place[r], place[s]) += area / 12. * (i == j ? 2. : 1.);
        else if (is_pressure[s])
          B(place[r], place[s]) += local(i, j);
        else if (!is_pressure[r])
          A(place[r], place[s]) += local(i, j);
      }
  }
  dealii::LAPACKFullMatrix<double> A_inverse_B = B;
  A.set_property(dealii::LAPACKSupport::symmetric);
  A.compute_cholesky_factorization();
  A.solve(A_inverse_B);
  B.Tmmult(S, A_inverse_B);
  S.set_property(dealii::LAPACKSupport::symmetric);
  M.set_property(dealii::LAPACKSupport::symmetric);
  std::vector<dealii::Vector<double>> no_vectors;
  S.compute_generalized_eigenvalues_symmetric(M, no_vectors);
  std::vector<double> all;
  for (unsigned int i = 0; i < n_p; ++i)
    all.push_back(S.eigenvalue(i).real());
  return all;
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const PlanePair &pair : {mini_pair(), quadratic_pair()})
  {
    std::vector<double> constants;
    for (const unsigned int n : {4, 6, 9, 12})
    {
      const auto beta2 = eigenvalues(pair, n);
      AssertThrow(std::abs(beta2[0]) < 1e-10, dealii::ExcMessage("constants are no eigenvector"));
      constants.push_back(std::sqrt(std::max(0., beta2[1])));
    }
    const auto [smallest, largest] = std::minmax_element(constants.begin(), constants.end());
    std::cout << pair.name << std::endl
              << "  above 0.2 on every mesh: " << (*smallest > 0.2 ? "yes" : "NO") << ", " << *smallest
              << std::endl
              << "  flat within a tenth: " << (*largest < 1.1 * *smallest ? "yes" : "NO") << std::endl;
  }
  PlanePair linear = mini_pair();
  linear.velocity  = std::make_shared<dealii::FE_SimplexP<2>>(1);
  std::cout << "without the bubble" << std::endl
            << "  zero: " << (eigenvalues(linear, 6)[1] < 1e-10 ? "yes" : "NO") << std::endl;
}
