// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The inside of wrecked meshes made anew: nodes inside thrown about by the size of the part, so that
// three cells in ten are inverted. Proved: the new mesh is sound (rebuild_inside() checks it), its
// surface has the same nodes, faces and patches bit for bit, hence the volume to 1e-13; edges inside have the
// wanted length on the mean within a factor of two, finer where it is asked for; twice gives the same bits.
// The wrecked mesh still covers its domain, so that each new node is found in one of its cells:  X' = J X
// with no offset. A boundary that crosses itself is refused, with the place.

#include <deal.II/base/mpi.h>

#include "../mesh/mesh_test_tools.h"
#include <retroforge/mesh/boundary_location.h>
#include <retroforge/mesh/self_crossing.h>
#include <retroforge/remeshing/rebuild.h>
#include <retroforge/transfer/transfer.h>

#include <chrono>
#include <random>

using namespace retroforge;

bool numbers = false; // are printed when there is an argument

// Moves each inner node to a point drawn in the box of half-width `reach` about its place.
NodalVectors<double> scrambled(const TetMesh &mesh, const double reach)
{
  std::mt19937                           generator(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto                             patches = patches_at_nodes(mesh);
  NodalVectors<double>                   X       = mesh.X;
  for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
    if (patches[k].empty())
      X[k] += reach * Vec3({unit(generator), unit(generator), unit(generator)});
  return X;
}

double inverted_fraction(const TetMesh &mesh, const NodalVectors<double> &X)
{
  double n = 0;
  for (const auto &cell : mesh.cells)
    n += tet_volume(corners(cell, X)) <= 0;
  return n / mesh.n_cells();
}

bool same_surface(const TetMesh &old_mesh, const RebuiltMesh &rebuilt)
{
  const auto &mesh = rebuilt.mesh;
  if (mesh.faces.size() != old_mesh.faces.size() || mesh.patches.size() != old_mesh.patches.size())
    return false;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (unsigned int i = 0; i < 3; ++i)
    {
      const NodeIndex node = mesh.faces[f].nodes[i], old = old_mesh.faces[f].nodes[i];
      if (rebuilt.old_node[node] != old || mesh.X[node] != old_mesh.X[old] ||
          mesh.faces[f].patch != old_mesh.faces[f].patch)
        return false;
    }
  return true;
}

// Mean length of the edges with both ends inside and with x < limit or not.
double mean_inner_edge(const TetMesh &mesh, const double limit, const bool below)
{
  const auto patches = patches_at_nodes(mesh);
  double     sum = 0, n = 0;
  for (const auto &cell : mesh.cells)
    for (unsigned int a = 0; a < 4; ++a)
      for (unsigned int b = 0; b < a; ++b)
        if (patches[cell[a]].empty() && patches[cell[b]].empty() && (mesh.X[cell[a]][0] < limit) == below)
        {
          sum += (mesh.X[cell[a]] - mesh.X[cell[b]]).norm();
          n += 1;
        }
  return sum / n;
}

bool same_bits(const RebuiltMesh &a, const RebuiltMesh &b)
{
  return a.mesh.X == b.mesh.X && a.mesh.cells == b.mesh.cells && a.old_node == b.old_node;
}

bool near(const double value, const double wanted)
{
  return value > wanted / 2 && value < 2 * wanted;
}

void test_rebuild(const std::string &title, const TetMesh &mesh, const double reach, const double h)
{
  double middle = 0;
  for (const Vec3 &x : mesh.X)
    middle += x[0] / mesh.n_nodes();
  const auto                          X       = scrambled(mesh, reach);
  const auto                          uniform = [&](const Vec3 &) { return h; };
  const auto                          graded  = [=](const Vec3 &x) { return x[0] < middle ? h / 2 : h; };
  const auto                          start   = std::chrono::steady_clock::now();
  const auto                          rebuilt = rebuild_inside(mesh, X, uniform, "rebuilding");
  const std::chrono::duration<double> time    = std::chrono::steady_clock::now() - start;
  const auto                          finer   = rebuild_inside(mesh, X, graded, "rebuilding");
  const double change = volume(rebuilt.mesh.cells, rebuilt.mesh.X) / volume(mesh.cells, mesh.X) - 1;
  const auto   J      = make_transfer(mesh, X, rebuilt.mesh, rebuilt.old_node);
  double       offset = 0;
  for (const Vec3 &c : J.offset)
    offset = std::max(offset, c.norm());
  std::cout << title << "\n  three cells in ten inverted: " << yes(inverted_fraction(mesh, X) > 0.3)
            << "\n  surface the same: " << yes(same_surface(mesh, rebuilt) && same_surface(mesh, finer))
            << "\n  volume to 1e-13: " << yes(std::abs(change) < 1e-13)
            << "\n  smallest angle above half a degree: "
            << yes(minimum_dihedral_angle(rebuilt.mesh.cells, rebuilt.mesh.X) > 0.5)
            << "\n  edges near h: " << yes(near(mean_inner_edge(rebuilt.mesh, 1e9, true), h))
            << "\n  finer where wanted: " << yes(near(mean_inner_edge(finer.mesh, middle, true), h / 2))
            << " "
            << yes(mean_inner_edge(finer.mesh, middle, true) <
                   0.75 * mean_inner_edge(finer.mesh, middle, false))
            << "\n  same bits again: " << yes(same_bits(rebuilt, rebuild_inside(mesh, X, uniform, "again")))
            << "\n  nodes found in the wrecked mesh: " << yes(offset < 1e-9) << std::endl;
  if (numbers)
    std::cout << "  angles " << minimum_dihedral_angle(mesh.cells, mesh.X) << " "
              << minimum_dihedral_angle(rebuilt.mesh.cells, rebuilt.mesh.X) << ", edges "
              << mean_inner_edge(rebuilt.mesh, 1e9, true) << ", cells " << mesh.n_cells() << " "
              << rebuilt.mesh.n_cells() << ", inverted " << inverted_fraction(mesh, X) << ", offset "
              << offset << "\n";
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  numbers           = argc > 1;
  const TetMesh box = billet({{"size", "40, 40, 40"}, {"element size", "6"}});
  test_rebuild("box", box, 20, 6);
  test_rebuild("cylinder", billet({{"shape", "cylinder"}, {"element size", "6"}}), 15, 6);
  test_rebuild("eighth of a cube",
               billet({{"size", "80, 80, 80"},
                       {"element size", "6"},
                       {"symmetry planes", "-1, 0, 0; 0, -1, 0; 0, 0, 1"},
                       {"symmetry point", "centre"}}),
               20,
               6);

  TetMesh barrel = billet({{"shape", "cylinder"}, {"element size", "6"}});
  for (Vec3 &x : barrel.X)
  {
    const double bulge = 1.3 + 0.3 * x[2] * (50 - x[2]) / 625;
    x                  = Vec3({bulge * x[0], bulge * x[1], 0.45 * x[2]});
  }
  test_rebuild("barrel", barrel, 15, 6);

  // A node of the top goes through the bottom, to z = -5.
  auto X = box.X;
  for (NodeIndex k = 0; k < box.n_nodes(); ++k)
    if (std::abs(X[k][2] - 40) < 1e-9 && std::abs(X[k][0]) < 4 && std::abs(X[k][1]) < 4)
    {
      X[k] = Vec3({1, 2, -5});
      break;
    }
  try
  {
    rebuild_inside(
      box, X, [](const Vec3 &) { return 6.; }, "rebuilding");
    std::cout << "crossing: nothing thrown\n";
  }
  catch (const Error &error)
  {
    const std::string what = error.what();
    std::cout << what.substr(0, what.find(" near")) << " near ..." << what.substr(what.find(';')) << "\n";
  }
}
