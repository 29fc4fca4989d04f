// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/discretization/triangulation.h>

#include <algorithm>

namespace retroforge
{
  namespace
  {
    std::vector<dealii::Point<3>> points(const NodalVectors<double> &X)
    {
      return {X.begin(), X.end()};
    }

    template <std::size_t n_corners>
    std::vector<dealii::CellData<n_corners - 1>>
    cell_data(const std::vector<std::array<unsigned int, n_corners>> &cells)
    {
      std::vector<dealii::CellData<n_corners - 1>> data(cells.size(),
                                                        dealii::CellData<n_corners - 1>(n_corners));
      for (std::size_t c = 0; c < cells.size(); ++c)
        std::copy(cells[c].begin(), cells[c].end(), data[c].vertices.begin());
      return data;
    }
  } // namespace

  SharedTriangulation::SharedTriangulation(const MPI_Comm comm)
      : dealii::parallel::shared::Triangulation<3>(comm, none, false, partition_custom_signal)
  {
    const std::uint64_t n_ranks = dealii::Utilities::MPI::n_mpi_processes(comm);
    signals.create.connect([this, n_ranks] {
      for (const auto &cell : active_cell_iterators())
        cell->set_subdomain_id(cell->active_cell_index() * n_ranks / n_active_cells());
    });
  }

  void make_triangulation(const TetMesh              &mesh,
                          const NodalVectors<double> &X,
                          dealii::Triangulation<3>   &triangulation)
  {
    dealii::SubCellData boundary;
    for (const BoundaryFace &face : mesh.faces)
    {
      dealii::CellData<2> &data = boundary.boundary_quads.emplace_back(3);
      std::copy(face.nodes.begin(), face.nodes.end(), data.vertices.begin());
      data.boundary_id = face.patch;
    }
    triangulation.create_triangulation(points(X), cell_data(mesh.cells), boundary);
  }

  void make_triangulation(const TriangleSurface &surface, dealii::Triangulation<2, 3> &triangulation)
  {
    triangulation.create_triangulation(points(surface.vertices()), cell_data(surface.triangles()), {});
  }
} // namespace retroforge
