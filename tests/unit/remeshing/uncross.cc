// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// A U of unit cubes: two prongs of one cube's thickness, one cube apart. Proved:
// - as long as the prongs do not meet nothing is changed;
// - a node of one prong that is pushed into the other makes edges and faces cross; the cells there are taken
//   away, less than a cube, and what is left is a sound mesh that does not cross itself, whose other cells
//   and nodes are the old ones, in the old patches;
// - a whole prong pushed into the other is a fold: nothing is done;
// - in two sheets one element thick no cell behind a dent in the other sheet may go, for all its nodes are on the
//   surface: they go once the sheet is open from its rim.

#include "../mesh/block_mesh.h"
#include "../mesh/mesh_test_tools.h"

#include <deal.II/base/mpi.h>

#include <retroforge/mesh/self_crossing.h>
#include <retroforge/remeshing/uncross.h>

#include <set>

using namespace retroforge;

namespace
{
  TetMesh u_shape()
  {
    return block_mesh(
      {{3, 2, 4}}, [](const unsigned int i, unsigned int, const unsigned int k) { return i != 1 || k == 0; });
  }

  /// The nodes of the left prong above a height, moved to the right.
  NodalVectors<double> bent(const TetMesh &mesh, const double from, const double y, const double shift)
  {
    NodalVectors<double> X = mesh.X;
    for (Vec3 &x : X)
      if (x[0] == 1. && x[2] >= from && x[1] <= y)
        x += Vec3({shift, 0.13, -0.17}); // off the grid of the other prong
    return X;
  }

  /// Two sheets of one cube's thickness that hang together in a corner.
  TetMesh two_sheets()
  {
    return block_mesh({{5, 5, 3}}, [](const unsigned int i, const unsigned int j, const unsigned int k) {
      return k != 1 || (i == 4 && j == 4);
    });
  }

  /// A node below the upper sheet, pushed into the lower one.
  NodalVectors<double> dented(const TetMesh &mesh)
  {
    NodalVectors<double> X = mesh.X;
    for (Vec3 &x : X)
      if ((x - Vec3({2., 2., 2.})).norm() < 0.1)
        x += Vec3({0.11, 0.07, -1.2});
    return X;
  }

  double volume_of(const TetMesh &mesh)
  {
    double sum = 0.;
    for (const auto &cell : mesh.cells)
      sum += tet_volume(corners(cell, mesh.X));
    return sum;
  }

  /// Cells and patches that are not from the mesh before.
  unsigned int strange(const TetMesh &mesh, const RebuiltMesh &made)
  {
    std::set<std::array<NodeIndex, 4>> cells(mesh.cells.begin(), mesh.cells.end());
    std::map<FaceKey, unsigned int>    patch;
    for (const BoundaryFace &face : mesh.faces)
      patch[face_key(face.nodes)] = face.patch;
    unsigned int n = 0;
    for (std::array<NodeIndex, 4> cell : made.mesh.cells)
    {
      for (NodeIndex &k : cell)
        k = made.old_node[k];
      n += cells.count(cell) == 0;
    }
    for (BoundaryFace face : made.mesh.faces)
    {
      for (NodeIndex &k : face.nodes)
        k = made.old_node[k];
      const auto found = patch.find(face_key(face.nodes));
      n += found != patch.end() && found->second != face.patch;
    }
    return n;
  }

  void
  run(const std::string &title, const TetMesh &mesh, const NodalVectors<double> &X, const double size = 1.)
  {
    const auto made = uncross(mesh, X, [size](const Vec3 &) { return size; });
    std::cout << title << ": crosses itself: " << yes(!self_crossings(mesh, X).empty());
    if (!made)
    {
      std::cout << ", left as it is\n";
      return;
    }
    TetMesh before = mesh;
    before.X       = X;
    check_mesh(made->mesh.mesh, title);
    std::cout << ", after: " << yes(!self_crossings(made->mesh.mesh, made->mesh.mesh.X).empty())
              << "\n  taken away: " << mesh.n_cells() - made->mesh.mesh.n_cells() << " cells, told right: "
              << yes(std::abs(volume_of(before) - volume_of(made->mesh.mesh) - made->removed) < 1e-13)
              << ", less than a cube: " << yes(made->removed < size * size * size)
              << "\n  cells, faces that are not the old ones: " << strange(before, made->mesh) << "\n";
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const TetMesh                            mesh = u_shape();
  run("prongs apart", mesh, mesh.X);
  run("prongs near each other", mesh, bent(mesh, 4., 2., 0.9));
  run("a corner in the other prong", mesh, bent(mesh, 4., 0., 1.3));
  run("a whole prong in the other", mesh, bent(mesh, 2., 2., 1.7));
  const TetMesh sheets = two_sheets();
  run("a dent in the other sheet", sheets, dented(sheets), 2.);
}
