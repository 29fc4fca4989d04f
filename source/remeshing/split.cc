// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/remeshing/smoothing.h>
#include <retroforge/remeshing/split.h>

#include <algorithm>

namespace retroforge
{
  namespace
  {
    bool plan_faces(const EditableMesh &mesh, const NodeIndex a, const NodeIndex b, CavityChange &change)
    {
      change.removed_faces = mesh.faces_at_edge(a, b);
      change.added_faces.clear();
      for (const unsigned int f : change.removed_faces)
        for (const NodeIndex end : {a, b})
        {
          const auto before = corners(mesh.face(f).nodes, mesh);
          auto       after  = before;
          for (unsigned int i = 0; i < 3; ++i)
            if (mesh.face(f).nodes[i] == end)
              after[i] = change.position;
          if (!look_alike(before, after))
            return false;
          change.added_faces.push_back(
            {replaced(mesh.face(f).nodes, end, change.placed_node), mesh.face(f).region});
        }
      return true;
    }

    void plan_ridges(const EditableMesh &mesh, const NodeIndex a, const NodeIndex b, CavityChange &change)
    {
      const unsigned int curve = mesh.curve_of_edge(a, b);
      if (curve == invalid_index)
        return;
      change.removed_ridges = {{{{a, b}}, curve}};
      change.added_ridges   = {{{{a, change.placed_node}}, curve}, {{{change.placed_node, b}}, curve}};
    }
  } // namespace

  std::optional<CavityChange> plan_split(const RemeshingContext &context,
                                         const NodeIndex         a,
                                         const NodeIndex         b,
                                         const double            bound,
                                         const SplitAt           at)
  {
    const EditableMesh &mesh   = context.mesh;
    const Place         place  = place_of_edge(context, a, b);
    const Vec3          middle = (mesh.X(a) + mesh.X(b)) / 2., target = place(middle);
    const double        length = (mesh.X(b) - mesh.X(a)).norm();
    // Where the surface or a die is far from the edge, halving it would not shorten it.
    if ((target - middle).norm() > (at == SplitAt::towards ? 0.5 : 0.25) * length)
      return {};
    CavityChange change;
    change.placed_node   = mesh.n_nodes();
    change.removed_cells = mesh.cells_at_edge(a, b);
    for (const CellIndex c : change.removed_cells)
      for (const NodeIndex end : {a, b})
        change.added_cells.push_back(replaced(mesh.cell(c), end, change.placed_node));
    const auto fits = [&](const Vec3 &position) {
      change.position = position;
      return evaluate(mesh, std::max(0., bound), change) && plan_faces(mesh, a, b, change);
    };
    const auto fits_towards = [&](const double part) {
      change.placement = {Placement::How::towards, {{a, b}}, place.kind, place.feature, part, {}, 0, {}};
      return fits(place.towards(target, middle, part));
    };
    if (at == SplitAt::best)
    {
      Cavity cavity = cavity_of_edge(mesh, a, b);
      auto   best   = best_position(mesh, cavity, place, target);
      if (!(best.quality > bound) || !fits(best.x))
        return {};
      change.placement = searched({{a, b}}, place, std::move(cavity), std::move(best));
    }
    else if (fits(target))
      change.placement = {Placement::How::put, {{a, b}}, place.kind, place.feature, 1., {}, 0, {}};
    else if (!(at == SplitAt::towards && place.kind != NodeKind::interior &&
               (fits_towards(0.5) || fits_towards(0.25) || fits_towards(0.))))
      return {};
    plan_ridges(mesh, a, b, change);
    return change;
  }
} // namespace retroforge
