// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The inf-sup constants of both pairs on Discretization<2>: the root of the smallest eigenvalue, that of
// constants aside, of  B^T A^-1 B p = beta^2 M p  with M the mass matrix of the pressures, A the energy of 2
// eps:eps, and v = 0 on the whole boundary of the unit square. They must not fall as the mesh is refined.
// Linear velocities without the bubble are the control: theirs is zero.

#include "plane_flow.h"

#include <deal.II/lac/lapack_full_matrix.h>

using namespace retroforge;

/// beta^2 in ascending order.
/// @param with_bubbles  or those of the mini element are left out
std::vector<double> eigenvalues(const ElementPair pair, const unsigned int n, const bool with_bubbles = true)
{
  constexpr auto  nowhere = dealii::numbers::invalid_unsigned_int;
  const PlaneFlow flow(unit_square(n, 0.2, {}), plane_choice(pair, Kinematics::plane_strain));
  const auto     &discretization = flow.discretization;
  const auto     &nodes          = *discretization.velocity_nodes();
  // Places among the free velocities, and among the pressures.
  std::vector<unsigned int> place(flow.n_unknowns(), 0);
  for (unsigned int k = discretization.condensed_nodes()->n(); k < nodes.n() && !with_bubbles; ++k)
    place[2 * nodes.place(k)] = place[2 * nodes.place(k) + 1] = nowhere;
  flow.for_each_node([&](const NodeIndex k, const dealii::Point<2> &x) {
    if (std::min(x[0], x[1]) < 1e-9 || std::max(x[0], x[1]) > 1. - 1e-9)
      place[2 * nodes.place(k)] = place[2 * nodes.place(k) + 1] = nowhere;
  });
  unsigned int n_v = 0;
  for (unsigned int i = 0; i < flow.n_velocities(); ++i)
    if (place[i] != nowhere)
      place[i] = n_v++;
  const unsigned int n_p = flow.n_unknowns() - flow.n_velocities();
  for (unsigned int i = 0; i < n_p; ++i)
    place[flow.n_velocities() + i] = i;

  dealii::LAPACKFullMatrix<double> A(n_v, n_v), B(n_v, n_p), S(n_p, n_p), M(n_p, n_p);
  for (const CellIndex c : discretization.cells().owned())
  {
    const auto   indices     = flow.indices_of(c);
    const auto   local       = flow.matrix_of(c, {1., 1., 0.}, Linearisation::newton);
    const double area        = cell_volume(flow.geometry_of(c));
    const auto   is_pressure = [&](const unsigned int i) { return indices[i] >= flow.n_velocities(); };
    for (unsigned int i = 0; i < indices.size(); ++i)
      for (unsigned int j = 0; j < indices.size(); ++j)
      {
        const unsigned int r = place[indices[i]], s = place[indices[j]];
        if (r == nowhere || s == nowhere)
          continue;
        if (is_pressure(i) && is_pressure(j))
          M(r, s) += area / 12. * (i == j ? 2. : 1.);
        else if (is_pressure(j))
          B(r, s) += local(i, j);
        else if (!is_pressure(i))
          A(r, s) += local(i, j);
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
  for (const ElementPair pair : {ElementPair::mini, ElementPair::taylor_hood})
  {
    std::vector<double> constants;
    for (const unsigned int n : {4, 6, 9, 12})
    {
      const auto beta2 = eigenvalues(pair, n);
      AssertThrow(std::abs(beta2[0]) < 1e-10, dealii::ExcMessage("constants are no eigenvector"));
      constants.push_back(std::sqrt(std::max(0., beta2[1])));
    }
    const auto [smallest, largest] = std::minmax_element(constants.begin(), constants.end());
    std::cout << name_of(pair) << std::endl
              << "  above 0.2 on every mesh: " << (*smallest > 0.2 ? "yes" : "NO") << ", " << *smallest
              << std::endl
              << "  flat within a tenth: " << (*largest < 1.1 * *smallest ? "yes" : "NO") << std::endl;
  }
  std::cout << "without the bubble" << std::endl
            << "  zero: " << (eigenvalues(ElementPair::mini, 6, false)[1] < 1e-10 ? "yes" : "NO")
            << std::endl;
}
