// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Meshes of other shapes, and wrecked ones. Proved of each: valid, no free dihedral angle below 20 degrees
// (15 for the star), volume to 1e-12, kept nodes where they were.
// - a box squeezed to 40 %: the areas of its six sides stay to rounding, so no ridge or corner is lost;
// - a star-shaped prism (a gear with eight teeth) twisted and squeezed: the area of its ends stays to 0.3 %
//   (chords of the twisted flanks are lifted, and the volume correction takes that back everywhere);
// - a cylinder whose nodes inside are thrown about at random, thirty times over;
// - sizes that grow from 2 to 6 across a box: edges follow.

#include <deal.II/base/mpi.h>

#include "remeshing_test_tools.h"

#include <retroforge/billet/msh_mesh.h>

#include <gmsh.h>

using namespace retroforge;

double area_of(const TetMesh &mesh, const std::string &name)
{
  for (unsigned int p = 0; p < mesh.patches.size(); ++p)
    if (mesh.patches[p].name == name)
      return patch_area(mesh, p);
  return 0;
}

void squeezed_box()
{
  const TetMesh mesh = billet({{"size", "20, 20, 20"}, {"element size", "4"}});
  const double  h    = mean_edge_length(mesh);
  auto          X    = mesh.X;
  for (Vec3 &x : X)
    x = Vec3({1.6 * x[0], x[1] / (1.6 * 0.4), 0.4 * x[2]});
  const auto result = remesh_locally(mesh, X, [&](const Vec3 &) { return h; }, {});
  print_result("squeezed box", result, X);
  double worst = 0;
  for (unsigned int p = 0; p < 6; ++p)
  {
    TetMesh before = mesh;
    before.X       = X;
    worst          = std::max(worst, std::abs(patch_area(result.mesh, p) / patch_area(before, p) - 1));
  }
  std::cout << "  areas kept: " << yes(worst < 1e-12) << "\n";
}

// A prism of eight teeth between two radii, meshed by Gmsh and read from its file.
TetMesh star_prism(const double inner, const double outer, const double height, const double h)
{
  gmsh::initialize();
  gmsh::option::setNumber("General.Verbosity", 0);
  gmsh::model::add("star");
  std::vector<int> points, lines;
  for (unsigned int i = 0; i < 32; ++i)
  {
    const double r = i % 4 < 2 ? outer : inner, angle = 2 * M_PI * i / 32;
    points.push_back(gmsh::model::geo::addPoint(r * std::cos(angle), r * std::sin(angle), 0, h));
  }
  for (unsigned int i = 0; i < 32; ++i)
    lines.push_back(gmsh::model::geo::addLine(points[i], points[(i + 1) % 32]));
  const int        base = gmsh::model::geo::addPlaneSurface({gmsh::model::geo::addCurveLoop(lines)});
  gmsh::vectorpair solid;
  gmsh::model::geo::extrude({{2, base}}, 0, 0, height, solid);
  gmsh::model::geo::synchronize();
  std::vector<int> flanks;
  for (std::size_t i = 2; i < solid.size(); ++i)
    flanks.push_back(solid[i].second);
  const std::vector<std::pair<std::string, std::vector<int>>> groups = {
    {"bottom", {base}}, {"top", {solid[0].second}}, {"flanks", flanks}};
  for (const auto &[name, surfaces] : groups)
    gmsh::model::setPhysicalName(2, gmsh::model::addPhysicalGroup(2, surfaces), name);
  gmsh::model::addPhysicalGroup(3, {solid[1].second});
  gmsh::model::mesh::generate(3);
  gmsh::write("star.msh");
  gmsh::finalize();
  return read_msh("star.msh", {});
}

void star()
{
  TetMesh      mesh = star_prism(15, 20, 12, 3);
  const double h    = mean_edge_length(mesh);
  const auto   size = [&](const Vec3 &) { return h; };
  mesh              = remesh_locally(mesh, mesh.X, size, {}).mesh;
  RemeshedMesh         result;
  NodalVectors<double> X;
  double               angle = 90;
  for (unsigned int step = 0; step < 20; ++step)
  {
    X = mesh.X;
    for (Vec3 &x : X)
    {
      const double turn = 0.002 * x[2], s = 1 / std::sqrt(0.96);
      x = Vec3({s * (std::cos(turn) * x[0] - std::sin(turn) * x[1]),
                s * (std::sin(turn) * x[0] + std::cos(turn) * x[1]),
                0.96 * x[2]});
    }
    result = remesh_locally(mesh, X, size, {});
    mesh   = result.mesh;
    angle  = std::min(angle, minimum_free_angle(mesh, mesh.X));
  }
  // Area of the star: 16 triangles of half angle sin(2 pi/32) each r1 r2 / 2, of (outer, outer), (outer,
  // inner), ...
  const double sine = std::sin(2 * M_PI / 32);
  const double area = 8 * 0.5 * sine * (20 * 20 + 2 * 20 * 15 + 15 * 15) / std::pow(0.96, 20);
  std::cout << "star after 20 remeshings: " << verdict(mesh) << ", angle at least 15: " << yes(angle >= 15)
            << ", top area to 0.3 %: " << yes(std::abs(area_of(mesh, "top") / area - 1) < 3e-3)
            << ", bottom area to 0.3 %: " << yes(std::abs(area_of(mesh, "bottom") / area - 1) < 3e-3) << "\n";
  measured() << "star angle " << angle << " top " << area_of(mesh, "top") / area - 1 << " bottom "
             << area_of(mesh, "bottom") / area - 1 << "\n";
}

// Moves nodes inside at random while all cells stay positive.
NodalVectors<double> wrecked(const TetMesh &mesh, const double amount, const unsigned int seed)
{
  std::mt19937         random(seed);
  NodalVectors<double> X = mesh.X;
  std::vector<bool>    is_inside(mesh.n_nodes(), true);
  for (const auto &face : mesh.faces)
    for (const NodeIndex node : face.nodes)
      is_inside[node] = false;
  std::vector<std::vector<CellIndex>> cells(mesh.n_nodes());
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    for (const NodeIndex node : mesh.cells[c])
      cells[node].push_back(c);
  for (NodeIndex node = 0; node < mesh.n_nodes(); ++node)
  {
    const Vec3 before = X[node];
    for (unsigned int d = 0; d < 3; ++d)
    {
      const double r = random_number(random);
      X[node][d] += is_inside[node] ? amount * r : 0;
    }
    for (const CellIndex c : cells[node])
      if (!(tet_volume(corners(mesh.cells[c], X)) > 0))
        X[node] = before;
  }
  return X;
}

void random_wrecks()
{
  const TetMesh mesh  = billet({{"shape", "cylinder"}, {"element size", "8"}});
  const double  h     = mean_edge_length(mesh);
  double        angle = 90, error = 0;
  unsigned int  n_invalid = 0;
  for (unsigned int seed = 1; seed <= 30; ++seed)
  {
    const auto X      = wrecked(mesh, 0.02 * seed * h, seed);
    const auto result = remesh_locally(mesh, X, [&](const Vec3 &) { return h; }, {});
    n_invalid += verdict(result.mesh) != "valid";
    angle = std::min(angle, minimum_free_angle(result.mesh, result.mesh.X));
    error = std::max(error, std::abs(result.report.volume_after / result.report.volume_before - 1));
    if (seed == 30)
    {
      print_result("wreck", result, X);
    }
  }
  std::cout << "30 wrecks: " << n_invalid << " invalid, angle at least 15: " << yes(angle >= 15)
            << ", at least 19.99: " << yes(angle >= 19.99) << ", volume to 1e-12: " << yes(error < 1e-12)
            << "\n";
  measured() << "wrecks: angle " << angle << " volume " << error << "\n";
}

void graded_sizes()
{
  const TetMesh   mesh   = billet({{"size", "40, 20, 20"}, {"element size", "4"}});
  const SizeField size   = [](const Vec3 &x) { return 4 + x[0] / 10; };
  const auto      result = remesh_locally(mesh, mesh.X, size, {});
  const auto      again  = remesh_locally(result.mesh, result.mesh.X, size, {});
  double          least = 100, most = 0;
  for (const auto &cell : result.mesh.cells)
    for (unsigned int i = 0; i < 4; ++i)
      for (unsigned int j = i + 1; j < 4; ++j)
      {
        const Vec3  &a = result.mesh.X[cell[i]], &b = result.mesh.X[cell[j]];
        const double length = (b - a).norm() / size((a + b) / 2.);
        least               = std::min(least, length);
        most                = std::max(most, length);
      }
  std::cout << "sizes from 2 to 6: " << verdict(result.mesh)
            << ", angle at least 19.99: " << yes(minimum_free_angle(result.mesh, result.mesh.X) > 19.99)
            << ", edges of 0.3 to 2 times the wanted length: " << yes(least > 0.3 && most < 2)
            << ", nothing much left to do: "
            << yes(again.report.n_nodes_kept > 0.97 * again.report.n_nodes_before) << "\n";
  measured() << "graded: " << least << " " << most << " kept " << again.report.n_nodes_kept << " of "
             << again.report.n_nodes_before << "\n";
}

int main(int argc, char **argv)
{
  measured(argc > 1);
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  squeezed_box();
  star();
  random_wrecks();
  graded_sizes();
}
