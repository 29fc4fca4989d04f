// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/mpi.h>

#include <retroforge/objective/surface_areas.h>
#include <retroforge/objective/workpiece_surface.h>

#include <cstdint>

namespace retroforge
{
  WorkpieceSurface::WorkpieceSurface(const FinalView<double> &view)
  {
    std::vector<unsigned int> index(view.X.size(), invalid_index);
    for (NodeIndex k = 0; k < view.X.size(); ++k)
      if (view.scene.topology.is_on_surface(k))
      {
        index[k] = nodes_.size();
        nodes_.push_back(k);
      }
    std::vector<Triangle> triangles = surface_triangles(view.scene.mesh);
    for (Triangle &triangle : triangles)
      for (unsigned int &corner : triangle)
        corner = index[corner];
    shape_ =
      std::make_shared<TriangleSurface>("Surface of the workpiece", vertices(view), std::move(triangles));
  }

  TriangleSurface WorkpieceSurface::moved(const FinalView<double> &view) const
  {
    TriangleSurface surface = *shape_;
    surface.move_vertices(vertices(view));
    return surface;
  }

  void WorkpieceSurface::add(const NodalVectors<double> &vertices_bar, FinalBar &bar) const
  {
    for (std::size_t v = 0; v < nodes_.size(); ++v)
      bar.X[nodes_[v]] += vertices_bar[v];
  }

  std::pair<std::size_t, std::size_t> share_of_rank(const std::size_t n, MPI_Comm comm)
  {
    const std::uint64_t ranks = dealii::Utilities::MPI::n_mpi_processes(comm);
    const std::uint64_t rank  = dealii::Utilities::MPI::this_mpi_process(comm);
    return {n * rank / ranks, n * (rank + 1) / ranks};
  }
} // namespace retroforge
