// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/mesh/cell_faces.h>
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/remeshing/smoothing.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  namespace
  {
    // The face opposite a corner of a cell, turned towards the corner.
    std::array<NodeIndex, 3> face_seen_from(const Cell &cell, const unsigned int corner)
    {
      const auto &local = tet_face_corners[corner];
      return {{cell[local[0]], cell[local[2]], cell[local[1]]}};
    }

    unsigned int corner_of(const Cell &cell, const NodeIndex node)
    {
      return std::find(cell.begin(), cell.end(), node) - cell.begin();
    }

    // The cells that the faces of a cavity make with a point to be chosen.
    class Star
    {
    public:
      Star(const EditableMesh &mesh, const Cavity &cavity)
      {
        for (const auto &face : cavity)
          faces_.push_back(corners(face, mesh));
      }

      // Smallest quality of the cells with the apex x. Stops at the first cell that is not above `bound`, and
      // then returns something not above it. That face comes first from then on: what spoils one trial
      // mostly spoils the next, and most trials fail.
      double quality(const Vec3 &x, const double bound)
      {
        double quality = 1;
        for (auto &face : faces_)
        {
          quality = std::min(quality, tet_quality({{face[0], face[1], face[2], x}}));
          if (!(quality > bound))
          {
            std::swap(face, faces_.front());
            return std::min(quality, bound);
          }
        }
        return quality;
      }

      double size(const Vec3 &x) const
      {
        double sum = 0;
        for (const auto &face : faces_)
          for (const Vec3 &corner : face)
            sum += (corner - x).norm();
        return sum / (3 * faces_.size());
      }

      // Area vector of what the cavity leaves open: the boundary at its apex.
      Vec3 open_side() const
      {
        Vec3 sum;
        for (const auto &face : faces_)
          sum += cross_product_3d(face[1] - face[0], face[2] - face[0]);
        return sum;
      }

    private:
      std::vector<std::array<Vec3, 3>> faces_;
    };

    struct Directions
    {
      std::vector<Vec3> of;
      unsigned int      axis = 0; ///< by which they were found
    };

    Directions plane_directions(const Vec3 &normal)
    {
      Directions directions;
      directions.axis = std::abs(normal[0]) < std::abs(normal[1])
                          ? (std::abs(normal[0]) < std::abs(normal[2]) ? 0 : 2)
                          : (std::abs(normal[1]) < std::abs(normal[2]) ? 1 : 2);
      Vec3 u;
      u[directions.axis] = 1;
      u                  = cross_product_3d(normal, u);
      u /= u.norm();
      Vec3 v = cross_product_3d(normal, u);
      v /= v.norm();
      for (unsigned int i = 0; i < 8; ++i)
        directions.of.push_back(plane_direction(i)[0] * u + plane_direction(i)[1] * v);
      return directions;
    }

    // On a curve: where the place moves to when pushed; found by pushing along the three axes.
    Directions curve_directions(const Place &place, const Vec3 &x, const double step)
    {
      Directions directions;
      Vec3       best;
      for (unsigned int axis = 0; axis < 3; ++axis)
      {
        Vec3 push;
        push[axis]     = step;
        const Vec3 way = place(x + push) - x;
        if (way.norm() > best.norm())
        {
          best            = way;
          directions.axis = axis;
        }
      }
      if (best.norm() > 0)
        directions.of = {best / best.norm(), -1. * best / best.norm()};
      return directions;
    }

    Directions directions_of(const Star &star, const Place &place, const Vec3 &start, const double size)
    {
      if (place.kind == NodeKind::interior)
        return {space_directions()};
      const Vec3 open = star.open_side();
      if (place.kind == NodeKind::surface && open.norm() > 0)
        return plane_directions(open / open.norm());
      if (place.kind == NodeKind::ridge)
        return curve_directions(place, start, ridge_push * size);
      return {};
    }
  } // namespace

  std::vector<Vec3> space_directions()
  {
    std::vector<Vec3> directions;
    for (const double sign : {1., -1.})
    {
      for (unsigned int axis = 0; axis < 3; ++axis)
      {
        Vec3 d;
        d[axis] = sign;
        directions.push_back(d);
      }
      const double s = sign / std::sqrt(3.);
      directions.insert(directions.end(),
                        {Vec3({s, s, s}), Vec3({s, s, -s}), Vec3({s, -s, s}), Vec3({-s, s, s})});
    }
    return directions;
  }

  std::array<double, 2> plane_direction(const unsigned int i)
  {
    return {{std::cos(i * M_PI / 4), std::sin(i * M_PI / 4)}};
  }

  Cavity cavity_of_node(const EditableMesh &mesh, const NodeIndex node)
  {
    Cavity cavity;
    for (const CellIndex c : mesh.cells_at(node))
      cavity.push_back(face_seen_from(mesh.cell(c), corner_of(mesh.cell(c), node)));
    return cavity;
  }

  Cavity cavity_of_edge(const EditableMesh &mesh, const NodeIndex a, const NodeIndex b)
  {
    Cavity cavity;
    for (const CellIndex c : mesh.cells_at_edge(a, b))
      for (const NodeIndex end : {a, b})
        cavity.push_back(face_seen_from(mesh.cell(c), corner_of(mesh.cell(c), end)));
    return cavity;
  }

  BestPosition
  best_position(const EditableMesh &mesh, const Cavity &cavity, const Place &place, const Vec3 &start)
  {
    Star         star(mesh, cavity);
    const double size           = star.size(start);
    const auto   directions     = directions_of(star, place, start, size);
    const bool   is_on_boundary = place.kind != NodeKind::interior;
    BestPosition best           = {start, star.quality(start, -2), directions.axis, {}};
    for (double part = 0.25; part > 0.01; part /= 2)
    {
      const double step      = part * size;
      bool         is_better = !directions.of.empty();
      for (unsigned int turn = 0; turn < 8 && is_better; ++turn)
      {
        is_better = false;
        for (unsigned int i = 0; i < directions.of.size(); ++i)
        {
          const Vec3 target = best.x + step * directions.of[i];
          // Putting a point on the old surface and out of the dies costs far more than looking at the cells
          // that would be spoiled, and moves it by little.
          const double promising = best.quality - 0.05;
          if (is_on_boundary && !(star.quality(target, promising) > promising))
            continue;
          const Vec3   x       = place(target);
          const double quality = star.quality(x, best.quality);
          if (quality > best.quality)
          {
            best.x       = x;
            best.quality = quality;
            best.steps.push_back({part, i});
            is_better = true;
          }
        }
      }
    }
    return best;
  }

  Placement
  searched(const std::array<NodeIndex, 2> &between, const Place &place, Cavity cavity, BestPosition best)
  {
    return {Placement::How::search,
            between,
            place.kind,
            place.feature,
            1.,
            std::move(cavity),
            best.axis,
            std::move(best.steps)};
  }

  std::optional<CavityChange>
  plan_smoothing(const RemeshingContext &context, const NodeIndex node, const double least_gain)
  {
    const EditableMesh &mesh  = context.mesh;
    const Place         place = place_of_node(context, node);
    if (place.kind == NodeKind::corner)
      return {};
    Cavity       cavity = cavity_of_node(mesh, node);
    auto         best   = best_position(mesh, cavity, place, mesh.X(node));
    CavityChange change;
    change.placed_node   = node;
    change.position      = best.x;
    change.removed_cells = mesh.cells_at(node);
    for (const CellIndex c : change.removed_cells)
      change.added_cells.push_back(mesh.cell(c));
    const double bound = std::max(0., minimum_quality(mesh, change.removed_cells) + least_gain);
    if (!(best.quality > bound) || !evaluate(mesh, bound, change))
      return {};
    for (const unsigned int f : mesh.faces_at(node))
    {
      const auto before = corners(mesh.face(f).nodes, mesh);
      auto       after  = before;
      for (unsigned int i = 0; i < 3; ++i)
        if (mesh.face(f).nodes[i] == node)
          after[i] = best.x;
      if (!look_alike(before, after))
        return {};
    }
    if (hides_metal(context, change))
      return {};
    change.placement = searched({{node, node}}, place, std::move(cavity), std::move(best));
    return change;
  }
} // namespace retroforge
