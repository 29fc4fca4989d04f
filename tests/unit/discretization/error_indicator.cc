// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The indicated error of the power. Proved, on one rank and on two, each of which knows the errors of all
// cells:
// - by hand: two cells share a face. Where one has the deviatoric rate e1, the other none, the nodes they
// share
//   recover  V_1/(V_1 + V_2) e1,  V the volumes, the others their own cell's, so that in a cell eps* - eps =
//   (1 - lambda) s e1 up to sign, lambda the barycentric coordinate of the node alone and s the other cell's
//   part of the volume. With m = 1 the stress is 2 K eps, and the mean of (1 - lambda)^2 over a cell is 0.6:
//   each cell has  1.2 K V s^2 |e1|^2,  K that of its own strain. Bubbles, rotations and the rate's trace do
//   not count;
// - fields that the velocities hold exactly have none: linear ones for both pairs, and quadratic ones for
// P2-P1,
//   which the mini element has;
// - it is positive, and proportional to K, with a power law, too.

#include <deal.II/base/mpi.h>

#include <retroforge/discretization/error_indicator.h>
#include <retroforge/element/corner_rates.h>

#include "../element/element_test_tools.h"
#include "../material/hardening_metal.h"

#include <numeric>

using namespace retroforge;

namespace
{
  /// Of volumes 1/6 and 1/3.
  TetMesh two_cells()
  {
    TetMesh mesh;
    mesh.X     = {Vec3({0, 0, 0}), Vec3({1, 0, 0}), Vec3({0, 1, 0}), Vec3({0, 0, 1}), Vec3({0, 0, -2})};
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
    for (const CellIndex c : discretization.visited_cells())
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

  const char *yes(const bool on_this_rank)
  {
    return dealii::Utilities::MPI::min(on_this_rank ? 1 : 0, MPI_COMM_WORLD) == 1 ? "yes" : "NO";
  }

  double total(const std::vector<double> &errors)
  {
    return std::accumulate(errors.begin(), errors.end(), 0.);
  }

  void check_two_cells()
  {
    const TetMesh           mesh = two_cells();
    const Discretization<3> discretization(mesh, {ElementPair::mini}, MPI_COMM_WORLD);
    // A turn of both, and the first cell sheared and stretched by its own node: e1 = sym(u (x) z), e2 = 0.
    const Vec3    u({0.6, 0.8, 0.3});
    Field<double> W = field_of(mesh, discretization, [&](const Vec3 &x) {
      return Vec3({-x[1], x[0], 0.}) + std::max(x[2], 0.) * u;
    });
    for (const CellIndex c : discretization.visited_cells())
      MiniPair::bubble(discretization, W, c) = Vec3({1., -2., 3.});
    const double     K = 3., a = 2., n = 0.5;
    Material<double> metal(MaterialLaw<double>(K, 1., 0.));
    metal.type    = add_hardening_metal();
    metal.numbers = {a, n};
    const std::vector<PointState<double>> points{{0.4}, {1.5}};
    const auto                            errors = indicated_errors(discretization, mesh.X, W, metal, points);
    // sym(u (x) z) without its trace
    const double e1_square = 0.5 * (u * u + u[2] * u[2]) - u[2] * u[2] / 3.;
    const double volume[2] = {1. / 6., 1. / 3.};
    Errors       by_hand;
    for (const CellIndex c : {0, 1})
    {
      const double share = volume[1 - c] / (volume[0] + volume[1]);
      by_hand.compare("the value by hand",
                      errors[c],
                      1.2 * K * std::pow(1. + a * points[c].strain, n) * volume[c] * share * share *
                        e1_square);
    }
    std::cout << "two cells, the values by hand: " << yes(by_hand.largest() < 1e-13) << "\n";
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
      const Discretization<3> discretization(mesh, {pair}, MPI_COMM_WORLD);
      const auto              error = [&](const auto &velocity, const MaterialLaw<double> &of) {
        return total(indicated_errors(discretization,
                                      mesh.X,
                                      field_of(mesh, discretization, velocity),
                                      of,
                                      std::vector<PointState<double>>(mesh.n_cells())));
      };
      auto twice = law;
      twice.K *= 2.;
      const bool mini = pair == ElementPair::mini;
      std::cout << (mini ? "mini" : "P2-P1") << ", degree " << velocity_degree(discretization)
                << ": linear: none " << yes(error(linear, law) < 1e-20)
                << "; quadratic: " << (mini ? "some " : "none ")
                << yes(mini ? error(quadratic, law) > 1e-3 : error(quadratic, law) < 1e-20);
      if (mini)
        std::cout << ", twice as much with twice K: " << error(quadratic, twice) / error(quadratic, law);
      std::cout << "\n";
    }
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) > 0)
    std::cout.setstate(std::ios::failbit);
  check_two_cells();
  check_exact_fields();
}
