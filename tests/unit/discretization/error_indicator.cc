// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The indicated error of the power.
// - By hand: two cells of one volume share a face. Where one has the deviatoric rate e1, the other e2, the
// nodes they
//   share recover the mean, the others their own cell's, so that in either cell eps* - eps = (1 - lambda)(e2
//   - e1)/2 up to sign, lambda the barycentric coordinate of the node alone. With m = 1, s = 2 K eps, and the
//   mean of (1 - lambda)^2 over a cell is 0.6: each cell has 0.3 K |T| |e2 - e1|^2. Bubbles and rotations do
//   not count.
// - Fields that the velocities hold exactly have none: linear ones for both pairs, and quadratic ones for
// P2-P1,
//   which the mini element has.
// - It is positive, and proportional to K, with a power law, too.

#include "../element/element_test_tools.h"
#include <retroforge/discretization/error_indicator.h>
#include <retroforge/element/corner_rates.h>

#include <cmath>
#include <numeric>

using namespace retroforge;

namespace
{
  TetMesh two_cells()
  {
    TetMesh mesh;
    mesh.X     = {Vec3({0, 0, 0}), Vec3({1, 0, 0}), Vec3({0, 1, 0}), Vec3({0, 0, 1}), Vec3({0, 0, -1})};
    mesh.cells = {{{0, 1, 2, 3}}, {{0, 2, 1, 4}}};
    return mesh;
  }

  /// An octahedron about a node that is off its centre.
  TetMesh octahedron()
  {
    TetMesh mesh;
    mesh.X = {Vec3({0.1, -0.05, 0.2})};
    for (unsigned int i = 0; i < 3; ++i)
      for (const double s : {-1., 1.})
      {
        Vec3 x;
        x[i] = s;
        mesh.X.push_back(x);
      }
    for (const unsigned int a : {1u, 2u})
      for (const unsigned int b : {3u, 4u})
        for (const unsigned int c : {5u, 6u})
          mesh.cells.push_back((a + b + c) % 2 == 0 ? std::array<NodeIndex, 4>{{0, a, b, c}}
                                                    : std::array<NodeIndex, 4>{{0, b, a, c}});
    return mesh;
  }

  template <typename Velocity>
  Field<double>
  field_of(const TetMesh &mesh, const Discretization<3> &discretization, const Velocity &velocity)
  {
    Field<double> W(discretization);
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    {
      const unsigned int *places = discretization.velocity_places(c);
      for (unsigned int a = 0; a < 4; ++a)
        W.V.at_place(places[a]) = velocity(mesh.X[mesh.cells[c][a]]);
      for (unsigned int e = 0; e < 6 && discretization.middles(); ++e)
        W.V.at_place(places[4 + e]) = velocity(0.5 * (mesh.X[mesh.cells[c][tet_edge_corners[e][0]]] +
                                                      mesh.X[mesh.cells[c][tet_edge_corners[e][1]]]));
    }
    return W;
  }

  double total(const std::vector<double> &errors)
  {
    return std::accumulate(errors.begin(), errors.end(), 0.);
  }

  void check_two_cells()
  {
    const TetMesh           mesh = two_cells();
    const Discretization<3> discretization(mesh, {ElementPair::mini}, MPI_COMM_SELF);
    Field<double>           W(discretization);
    // A turn of both, and the first cell sheared by its own node: e1 = sym(u (x) z), e2 = 0; no trace.
    for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
      W.V[k] = Vec3({-mesh.X[k][1], mesh.X[k][0], 0.});
    W.V[3] += Vec3({0.6, 0.8, 0.});
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
      W.V[discretization.bubble(c)] = Vec3({1., -2., 3.});
    const double K      = 3.;
    const auto   errors = indicated_errors(
      discretization, mesh.X, W, MaterialLaw<double>(K, 1., 0.), std::vector<double>(mesh.n_cells(), 0.));
    // |e1|^2 = 2 (|u|/2)^2 = 1/2
    const double by_hand = 0.3 * K * (1. / 6.) * 0.5;
    std::cout << "two cells, over the value by hand: " << errors[0] / by_hand << " " << errors[1] / by_hand
              << "\n";
  }

  void check_exact_fields()
  {
    const TetMesh             mesh = octahedron();
    const MaterialLaw<double> law(2., 0.139, 1e-3);
    const auto linear    = [](const Vec3 &x) { return Vec3({x[0] + 2. * x[1], -x[2], 0.5 * x[0] - x[2]}); };
    const auto quadratic = [](const Vec3 &x) {
      return Vec3({x[0] * x[0] + x[1] * x[2], -x[2] * x[0] + x[1], x[1] * x[1] - 2. * x[0] * x[2]});
    };
    for (const ElementPair pair : {ElementPair::mini, ElementPair::taylor_hood})
    {
      const Discretization<3> discretization(mesh, {pair}, MPI_COMM_SELF);
      const auto              error = [&](const auto &velocity, const MaterialLaw<double> &of) {
        return total(indicated_errors(discretization,
                                      mesh.X,
                                      field_of(mesh, discretization, velocity),
                                      of,
                                      std::vector<double>(mesh.n_cells(), 0.)));
      };
      auto twice = law;
      twice.K *= 2.;
      const bool mini = pair == ElementPair::mini;
      std::cout << (mini ? "mini" : "P2-P1") << ", degree " << velocity_degree(discretization)
                << ": linear: none " << (error(linear, law) < 1e-20 ? "yes" : "NO") << "; quadratic: "
                << (error(quadratic, law) > 1e-3    ? "some"
                    : error(quadratic, law) < 1e-20 ? "none"
                                                    : "SOMETHING");
      if (mini)
        std::cout << ", twice as much with twice K: " << error(quadratic, twice) / error(quadratic, law);
      std::cout << "\n";
    }
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  check_two_cells();
  check_exact_fields();
}
