// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Every term that a smooth die and middles of edges bring into the backward sweep is needed, and tests of
// this kind can see it: on a small block under a bulging die of a few facets, the adjoint agrees with the
// direct method along three directions (all nodes at random, the points in contact lifted off their die, all
// vertices of the die at random); and a sweep that leaves out any one term does not. The sweep is the test's
// own, that of dropped_terms.cc, with foot and normals of the die's facets written once more for dual
// numbers: complete, it agrees with adjoint_sweep. The corner normals' dependence on the vertices shows where
// these move, all others along all directions.

#include <deal.II/base/mpi.h>

#include "directions.h"
#include "sweep_with_omissions.h"

#include <retroforge/case/parameters.h>

#include <iostream>

using namespace retroforge;

namespace
{
  const std::vector<std::pair<Term, std::string>> terms = {
    {Term::curvature, "dn/dX of the smooth die"},
    {Term::wall, "the ramp's width by the normal"},
    {Term::coming, "the ramp's width by the metal's velocity before"},
    {Term::coordinates, "d delta/dX by way of the coordinates of the foot"},
    {Term::normals, "corner normals in the vertices"},
    {Term::edge_ramp, "the edges' share in the ramps of nodes"},
    {Term::edge_area, "d S/dX of edges"}};

  /// A hill of 4 x 4 squares that hangs over the block.
  Die hill()
  {
    const unsigned int    n = 4;
    NodalVectors<double>  x;
    std::vector<Triangle> t;
    for (unsigned int j = 0; j <= n; ++j)
      for (unsigned int i = 0; i <= n; ++i)
      {
        const double a = -28. + 56. * i / n, b = -28. + 56. * j / n;
        x.push_back(Vec3({a, b, 30. + (a - 3.) * (a - 3.) / 70. + (b + 5.) * (b + 5.) / 90.}));
      }
    for (unsigned int j = 0; j < n; ++j)
      for (unsigned int i = 0; i < n; ++i)
      {
        const unsigned int k = j * (n + 1) + i;
        t.insert(t.end(), {{{k, k + n + 2, k + 1}}, {{k, k + n + 1, k + n + 2}}});
      }
    return Die("upper", TriangleSurface("hill", x, t), 10., {true, feature_angle, 1.});
  }

  std::vector<Direction> directions(const RecordedRun &run)
  {
    const std::size_t      n    = run.scene.mesh.n_nodes();
    std::vector<Direction> list = {{"random X_0", random_vectors(n), 0., 0., {}},
                                   {"points lifted", NodalVectors<double>(n), 0., 0., {}},
                                   random_vertices(run)};
    const auto             by   = random_vectors(n);
    for (const ContactPair &pair : run.records[0].pairs)
      if (pair.touching)
        pair.point.add_to_position(
          Vec3(
            (1.5 + by[pair.point.nodes[0]][0]) *
            -run.scene.dies[pair.die].project(pair.point.position(run.scene.mesh.X), Vec3(), pair.feature).n),
          list[1].X_dot);
    return list;
  }

  bool sees(const Term term, const Direction &direction)
  {
    return term != Term::normals || !direction.vertices_dot.empty();
  }

  void describe(const RecordedRun &run)
  {
    unsigned int n_edges = 0, n_partial = 0, n_pressed = 0;
    for (const IncrementRecord &record : run.records)
      for (unsigned int p = 0; p < record.pairs.size(); ++p)
      {
        n_edges += !record.pairs[p].point.is_node();
        n_pressed += !record.pairs[p].point.is_node() && record.solves.back().active[p];
        n_partial += !record.pairs[p].point.is_node() && record.pairs[p].touching;
      }
    std::cout << "middles of edges: " << yes(n_edges > 10) << ", that touch: " << yes(n_partial > 10)
              << ", that press: " << yes(n_pressed > 5) << "\n";
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const Parameters                         parameters = tilted_block();
  RecordedRun                              run(parameters, {parameters.dies[0].die(), hill()});
  describe(run);
  const auto          along   = directions(run);
  const AdjointResult library = run.adjoint(), complete = sweep(run, Term::none);
  std::vector<double> tangents;
  std::cout << "complete sweep\n";
  for (const Direction &direction : along)
  {
    tangents.push_back(tangent_slope(run, direction));
    const double adjoint = slope(run, complete, direction);
    std::cout << "  " << direction.name
              << ": direct method within 1e-10: " << yes(relative_error(adjoint, tangents.back()) < 1e-10)
              << ", adjoint_sweep within 1e-12: "
              << yes(relative_error(adjoint, slope(run, library, direction)) < 1e-12) << "\n";
  }
  for (const auto &[term, name] : terms)
  {
    const AdjointResult without = sweep(run, term);
    std::cout << "without " << name << "\n";
    for (std::size_t d = 0; d < along.size(); ++d)
    {
      const double found = relative_error(slope(run, without, along[d]), tangents[d]);
      if (sees(term, along[d]))
        std::cout << "  " << along[d].name << ": error > 1e-5: " << yes(found > 1e-5) << "\n";
    }
  }
}
