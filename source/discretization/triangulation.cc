// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/discretization/triangulation.h>

#include <algorithm>

namespace retroforge
{
  void make_triangulation(const TetMesh              &mesh,
                          const NodalVectors<double> &X,
                          dealii::Triangulation<3>   &triangulation)
  {
    std::vector<dealii::Point<3>> vertices;
    vertices.reserve(X.size());
    for (const Vec3 &x : X)
      vertices.emplace_back(x);
    std::vector<dealii::CellData<3>> cells(mesh.n_cells(), dealii::CellData<3>(4));
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
      std::copy(mesh.cells[c].begin(), mesh.cells[c].end(), cells[c].vertices.begin());
    dealii::SubCellData boundary;
    for (const BoundaryFace &face : mesh.faces)
    {
      dealii::CellData<2> &data = boundary.boundary_quads.emplace_back(3);
      std::copy(face.nodes.begin(), face.nodes.end(), data.vertices.begin());
      data.boundary_id = face.patch;
    }
    triangulation.create_triangulation(vertices, cells, boundary);
  }
} // namespace retroforge
