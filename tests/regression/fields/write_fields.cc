// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Writes pictures of fields that are known functions of the place, for fields.py to read: linear.vtu and
// quadratic.vtu of a box of tetrahedra, one_cell.vtu, and surface.vtu.

#include <retroforge/output/field_file.h>

#include "../../unit/remeshing/remeshing_test_tools.h"

using namespace retroforge;

double linear(const Vec3 &x)
{
  return 1. + 2. * x[0] - 3. * x[1] + 0.5 * x[2];
}

Vec3 quadratic(const Vec3 &x)
{
  return Vec3({x[0] * x[0] - x[1] * x[2], 1. + x[1] * x[0], x[2] * x[2] + 0.25 * x[0]});
}

template <typename F>
auto at_nodes(const NodalVectors<double> &X, const F &f)
{
  std::vector<decltype(f(X[0]))> values;
  for (const Vec3 &x : X)
    values.push_back(f(x));
  return values;
}

void write_box(const std::string &file, const TetMesh &mesh, const bool is_quadratic)
{
  NodalVectors<double>           velocity = at_nodes(mesh.X, quadratic);
  std::vector<MiddleNodes::Ends> edges;
  for (const auto &cell : mesh.cells)
    for (unsigned int a = 0; a < 4; ++a)
      for (unsigned int b = 0; b < a; ++b)
        edges.push_back({{std::min(cell[a], cell[b]), std::max(cell[a], cell[b])}});
  const MiddleNodes middles(mesh.n_nodes(), edges);
  if (is_quadratic)
    for (const auto &[a, b] : middles.ends())
      velocity.push_back(quadratic(0.5 * (mesh.X[a] + mesh.X[b])));
  std::vector<double>          numbers;
  std::vector<SymmetricTensor> stress;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
  {
    numbers.push_back(c);
    stress.push_back({{1. * c, 1., 2., 3., 4., 5.}}); // xx, yy, zz, yz, xz, xy
  }
  FieldFile<3> picture(mesh.X, mesh.cells);
  picture.add_linear("pressure", "MPa", at_nodes(mesh.X, linear));
  picture.add_linear("displacement", "mm", mesh.X);
  picture.add_linear("label", "", std::vector<double>(mesh.n_nodes(), 1e300));
  picture.add_velocity("velocity", "mm/s", velocity, is_quadratic ? &middles : nullptr);
  picture.add_constant("number", "", numbers);
  picture.add_constant("stress", "MPa", stress);
  picture.add_symmetry_planes(
    {{Vec3({0.1, 0., 1. / 3.}), Vec3({-1., 0., 0.})}, {Vec3(), Vec3({0., -1., 0.})}});
  picture.write(file);
}

void write_surface()
{
  // a roof of four triangles
  const TriangleSurface surface(
    "roof",
    {Vec3({0., 0., 0.}), Vec3({2., 0., 0.}), Vec3({2., 2., 0.}), Vec3({0., 2., 0.}), Vec3({1., 1., 1.})},
    {{{0, 1, 4}}, {{1, 2, 4}}, {{2, 3, 4}}, {{3, 0, 4}}});
  FieldFile<2> picture(surface.vertices(), surface.triangles());
  picture.add_linear("gradient", "", at_nodes(surface.vertices(), quadratic));
  picture.write("surface.vtu");
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const TetMesh                            box = kuhn_box(3, 0.1);
  write_box("linear.vtu", box, false);
  write_box("quadratic.vtu", box, true);
  TetMesh one;
  one.X     = {Vec3({0., 0., 0.}), Vec3({1., 0., 0.}), Vec3({0., 1., 0.}), Vec3({0., 0., 1.})};
  one.cells = {{{0, 1, 2, 3}}};
  write_box("one_cell.vtu", one, false);
  write_surface();
}
