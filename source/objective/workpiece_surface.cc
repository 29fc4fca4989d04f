// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/mesh/surface_areas.h>
#include <retroforge/objective/workpiece_surface.h>

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
} // namespace retroforge
