// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// What pictures show of cells, of both pairs, in closed form, by quadrature and with quadratic geometry, on
// one and two ranks. Proved:
// - a uniform flow with a shear, on a mesh that is nowhere regular, has its strain rate, its stress
//   s = 2 K (sqrt(3) e)^(m-1) eps in all components, each cell by its own law, and its von Mises stress;
// - of an arbitrary flow, bubbles among it, quadrature shows what the closed forms do.

#include <deal.II/base/mpi.h>

#include <retroforge/output/cell_fields.h>

#include "../element/element_test_tools.h"
#include "../remeshing/remeshing_test_tools.h"

using namespace retroforge;

namespace
{
  MaterialLaw<double> law(const CellIndex c)
  {
    return {1.7 + 0.01 * c, 0.3, 0.};
  }

  void append(const CellFields &fields, std::vector<double> &numbers)
  {
    numbers.insert(numbers.end(), fields.strain_rate.begin(), fields.strain_rate.end());
    numbers.insert(numbers.end(), fields.von_mises.begin(), fields.von_mises.end());
    for (const auto &stress : fields.stress)
      numbers.insert(numbers.end(), stress.begin(), stress.end());
  }

  /// v = (e x + g y, e y, -2 e z)
  void check_uniform(const TetMesh &mesh, const Discretization<3> &discretization, Errors &errors)
  {
    constexpr double     e = 0.4, g = 0.3;
    NodalVectors<double> V;
    for (const Vec3 &x : mesh.X)
      V.push_back(Vec3({e * x[0] + g * x[1], e * x[1], -2. * e * x[2]}));
    const auto W      = interpolated(discretization, V, std::vector<double>(mesh.n_nodes(), 3.));
    const auto fields = cell_fields(discretization, mesh.X, W, law);
    // sqrt(2/3 eps:eps) of eps = diag(e, e, -2 e) and eps_xy = g/2
    const double rate = std::sqrt(2. / 3. * (6. * e * e + 0.5 * g * g));
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    {
      const double factor = 2. * law(c).K * std::pow(std::sqrt(3.) * rate, law(c).m - 1.);
      errors.compare("strain rates", fields.strain_rate[c], rate);
      errors.compare("stresses",
                     {fields.stress[c].begin(), fields.stress[c].end()},
                     {factor * e, factor * e, -2. * factor * e, 0., 0., 0.5 * factor * g});
      errors.compare("von Mises stresses", fields.von_mises[c], 1.5 * factor * rate);
    }
  }

  /// The same on each rank, whatever its places are.
  Field<double> arbitrary_flow(const TetMesh &mesh, const Discretization<3> &discretization)
  {
    Field<double>              W(discretization);
    Random                     random;
    const NodalVectors<double> V = random.vectors(discretization.velocity_nodes()->n());
    W.V.take(V);
    W.P.take(random.scalars(mesh.n_nodes()));
    return W;
  }
} // namespace

int main(int argc, char **argv)
{
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const MPI_Comm                                 comm = MPI_COMM_WORLD;
  const TetMesh                                  mesh = kuhn_box(3, 0.1);
  for (const auto pair : {ElementPair::mini, ElementPair::taylor_hood})
  {
    Errors              errors;
    std::vector<double> closed;
    for (const auto &[assembly, degree] : {std::pair{Assembly::closed_form, 1u},
                                           std::pair{Assembly::quadrature, 1u},
                                           std::pair{Assembly::quadrature, 2u}})
    {
      const Discretization<3> discretization(
        mesh, {pair, TriangulationKind::shared, assembly, Kinematics::three_dimensions, degree}, comm);
      check_uniform(mesh, discretization, errors);
      std::vector<double> numbers;
      append(cell_fields(discretization, mesh.X, arbitrary_flow(mesh, discretization), law), numbers);
      if (closed.empty())
        closed = numbers;
      errors.compare("quadrature against closed forms", numbers, closed);
    }
    if (dealii::Utilities::MPI::this_mpi_process(comm) > 0)
      continue;
    std::cout << (pair == ElementPair::mini ? "mini" : "P2-P1") << '\n';
    errors.print(1e-12);
  }
}
