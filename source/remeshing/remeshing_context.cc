// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/remeshing/remeshing_context.h>

#include <algorithm>

namespace retroforge
{
  void RemeshingContext::apply(const CavityChange &change) const
  {
    if (tape && change.placed_node != invalid_index)
      tape->place(change.placed_node, write(change.placement, *this, *tape));
    mesh.apply(change);
  }

  double RemeshingContext::relative_length(const NodeIndex a, const NodeIndex b) const
  {
    return relative_length(mesh.X(a), mesh.X(b));
  }

  double RemeshingContext::relative_length(const Vec3 &a, const Vec3 &b) const
  {
    return (b - a).norm() / size((a + b) / 2.);
  }

  bool RemeshingContext::is_longer(const NodeIndex a, const NodeIndex b, const double limit) const
  {
    return size.below((mesh.X(a) + mesh.X(b)) / 2., (mesh.X(b) - mesh.X(a)).norm() / limit);
  }

  bool RemeshingContext::is_shorter(const NodeIndex a, const NodeIndex b, const double limit) const
  {
    return !size.below((mesh.X(a) + mesh.X(b)) / 2., (mesh.X(b) - mesh.X(a)).norm() / limit);
  }

  std::array<Vec3, 3> corners(const std::array<NodeIndex, 3> &face, const EditableMesh &mesh)
  {
    return {{mesh.X(face[0]), mesh.X(face[1]), mesh.X(face[2])}};
  }

  double minimum_quality(const EditableMesh &mesh, const std::vector<CellIndex> &cells)
  {
    double quality = 1;
    for (const CellIndex cell : cells)
      quality = std::min(quality, mesh.quality(cell));
    return quality;
  }

  bool evaluate(const EditableMesh &mesh, const double bound, CavityChange &change)
  {
    change.quality_before = minimum_quality(mesh, change.removed_cells);
    change.quality_after  = 1;
    const auto X          = [&](const NodeIndex node) -> const Vec3          &{
      return node == change.placed_node ? change.position : mesh.X(node);
    };
    for (const Cell &cell : change.added_cells)
    {
      const double quality = tet_quality({{X(cell[0]), X(cell[1]), X(cell[2]), X(cell[3])}});
      change.quality_after = std::min(change.quality_after, quality);
      if (!(quality > bound))
        return false;
    }
    return true;
  }

  bool look_alike(const std::array<Vec3, 3> &a, const std::array<Vec3, 3> &b)
  {
    const Vec3 m = cross_product_3d(a[1] - a[0], a[2] - a[0]);
    const Vec3 n = cross_product_3d(b[1] - b[0], b[2] - b[0]);
    return m * n > 0.85 * m.norm() * n.norm();
  }

  namespace
  {
    /// Depth in dies of the middles of a face of the surface and of its edges; 0 on a plane of symmetry.
    double
    depth_of_chords(const RemeshingContext &context, const std::array<Vec3, 3> &x, const unsigned int region)
    {
      if (!context.old_surface.planes_of_region(region).empty())
        return 0.;
      double depth = context.old_surface.depth_in_dies((x[0] + x[1] + x[2]) / 3.);
      for (unsigned int i = 0; i < 3; ++i)
        depth = std::max(depth, context.old_surface.depth_in_dies((x[i] + x[(i + 1) % 3]) / 2.));
      return depth;
    }
  } // namespace

  bool hides_metal(const RemeshingContext &context, const CavityChange &change)
  {
    const EditableMesh      &mesh    = context.mesh;
    std::vector<SurfaceFace> added   = change.added_faces;
    auto                     removed = change.removed_faces;
    if (change.placed_node != invalid_index && change.placed_node < mesh.n_nodes())
      for (const unsigned int f : removed = mesh.faces_at(change.placed_node))
        added.push_back(mesh.face(f));
    double after = 0.;
    for (const SurfaceFace &face : added)
    {
      std::array<Vec3, 3> x;
      for (unsigned int i = 0; i < 3; ++i)
        x[i] = face.nodes[i] == change.placed_node ? change.position : mesh.X(face.nodes[i]);
      after = std::max(after, depth_of_chords(context, x, face.region));
    }
    if (after == 0. ||
        after <= context.parameters.surface_deviation * context.size(mesh.X(added[0].nodes[0])))
      return false;
    return std::none_of(removed.begin(), removed.end(), [&](const unsigned int f) {
      return depth_of_chords(context, corners(mesh.face(f).nodes, mesh), mesh.face(f).region) >= after;
    });
  }

  Vec3 Place::operator()(const Vec3 &x) const
  {
    if (kind == NodeKind::surface)
      return old_surface.on_region(feature, x);
    if (kind == NodeKind::ridge)
      return old_surface.on_curve(feature, x);
    return x;
  }

  Vec3 Place::towards(const Vec3 &target, const Vec3 &x, const double part) const
  {
    const Vec3 between = x + part * (target - x);
    if (kind == NodeKind::surface)
      return snap_to_planes(between, old_surface.planes_of_region(feature));
    if (kind == NodeKind::ridge)
      return snap_to_planes(between, old_surface.planes_of_curve(feature));
    return between;
  }

  Place place_of_node(const RemeshingContext &context, const NodeIndex node)
  {
    const EditableMesh &mesh = context.mesh;
    const NodeKind      kind = mesh.kind(node);
    if (kind == NodeKind::surface)
      return {context.old_surface, kind, mesh.face(mesh.faces_at(node)[0]).region};
    if (kind == NodeKind::ridge)
      return {context.old_surface, kind, mesh.ridges_at(node)[0].curve};
    return {context.old_surface, kind, invalid_index};
  }

  Place place_of_edge(const RemeshingContext &context, const NodeIndex a, const NodeIndex b)
  {
    const EditableMesh &mesh  = context.mesh;
    const unsigned int  curve = mesh.curve_of_edge(a, b);
    if (curve != invalid_index)
      return {context.old_surface, NodeKind::ridge, curve};
    const auto faces = mesh.faces_at_edge(a, b);
    if (!faces.empty())
      return {context.old_surface, NodeKind::surface, mesh.face(faces[0]).region};
    return {context.old_surface, NodeKind::interior, invalid_index};
  }
} // namespace retroforge
