// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The side of a block that has rolled onto a die leaves a lip: at one node of the upper edge, a second one
// outside of it, joined by cells that are nearly flat. Two ridges run there, from neighbour to neighbour,
// with two faces between. Proved: remeshing closes the slit, the flat cells are gone, the mesh is sound.

#include "../mesh/block_mesh.h"
#include "remeshing_test_tools.h"

#include <deal.II/base/mpi.h>

using namespace retroforge;

namespace
{
  /// A lip over the node: cells between it, its faces of the patch `top`, and a new node above and outside.
  void add_lip(TetMesh &mesh, const NodeIndex b, const double thick, const double wide)
  {
    const NodeIndex a = mesh.X.size();
    mesh.X.push_back(mesh.X[b] + Vec3({wide, 0., 0.}));
    mesh.X[b][2] -= thick;
    for (BoundaryFace &face : mesh.faces)
      if (face.patch == 0 && contains(face.nodes, b))
      {
        const auto [p, q, r] = face.nodes;
        mesh.cells.push_back({{p, q, r, a}});
        face.nodes = replaced(face.nodes, b, a);
      }
    // What is new at the boundary is the lip's lower side.
    std::set<FaceKey> known;
    for (const BoundaryFace &face : mesh.faces)
      known.insert(face_key(face.nodes));
    for (const CellFace &face : boundary_cell_faces(mesh.cells))
      if (known.count(face.key) == 0)
        mesh.faces.push_back({face.nodes, 1});
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  TetMesh mesh = block_mesh({{3, 4, 3}}, [](unsigned int, unsigned int, unsigned int) { return true; });
  for (NodeIndex k = 0, n = mesh.n_nodes(); k < n; ++k)
    if ((mesh.X[k] - Vec3({3., 2., 3.})).norm() < 1e-12)
      add_lip(mesh, k, 1e-3, 0.05);
  check_mesh(mesh, "lip");
  const RemeshedMesh made = remesh_locally(
    mesh, mesh.X, [](const Vec3 &) { return 1.2; }, RemeshingParameters());
  check_mesh(made.mesh, "closed");
  std::cout << "flat cells before: " << yes(made.report.quality_before < 1e-2)
            << ", after: " << yes(made.report.quality_after < 0.2) << "\nvolume kept: "
            << yes(std::abs(made.report.volume_after / made.report.volume_before - 1.) < 1e-12) << "\n";
}
