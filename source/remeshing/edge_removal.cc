// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/remeshing/edge_removal.h>

#include <algorithm>

namespace retroforge
{
  namespace
  {
    constexpr unsigned int longest_ring = 7;

    // Corner numbers of the six edges, each followed by the two others so that the order is positive.
    constexpr unsigned int edges[6][4] =
      {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}};

    // The nodes u, v for which (a, b, u, v) is the cell, positively oriented.
    std::array<NodeIndex, 2> opposite_edge(const Cell &cell, const NodeIndex a, const NodeIndex b)
    {
      for (const auto &e : edges)
      {
        if (cell[e[0]] == a && cell[e[1]] == b)
          return {{cell[e[2]], cell[e[3]]}};
        if (cell[e[0]] == b && cell[e[1]] == a)
          return {{cell[e[3]], cell[e[2]]}};
      }
      return {{invalid_index, invalid_index}};
    }

    // Best triangulation of a polygon v_0 ... v_{n-1}: best[i][j] is that of v_i ... v_j, via[i][j] the apex
    // of the triangle on its chord v_i v_j.
    class RingTriangulation
    {
    public:
      // Triangles whose two cells are not better than `bound` are not used.
      RingTriangulation(const EditableMesh           &mesh,
                        const NodeIndex               a,
                        const NodeIndex               b,
                        const std::vector<NodeIndex> &ring,
                        const double                  bound)
          : mesh_(mesh), a_(a), b_(b), ring_(ring), bound_(bound)
      {
        const unsigned int n = ring.size();
        for (unsigned int i = 0; i + 1 < n; ++i)
          best_[i][i + 1] = 1;
        for (unsigned int span = 2; span < n; ++span)
          for (unsigned int i = 0; i + span < n; ++i)
            find_apex(i, i + span);
      }

      double quality() const { return best_[0][ring_.size() - 1]; }

      void add_cells(const unsigned int i, const unsigned int j, std::vector<Cell> &cells) const
      {
        if (j == i + 1)
          return;
        const unsigned int m = via_[i][j];
        cells.push_back({{ring_[i], ring_[m], ring_[j], b_}});
        cells.push_back({{ring_[i], ring_[j], ring_[m], a_}});
        add_cells(i, m, cells);
        add_cells(m, j, cells);
      }

    private:
      void find_apex(const unsigned int i, const unsigned int j)
      {
        best_[i][j] = bound_;
        via_[i][j]  = i + 1;
        for (unsigned int m = i + 1; m < j; ++m)
        {
          double quality = std::min(best_[i][m], best_[m][j]);
          if (quality > best_[i][j])
            quality = std::min(quality, cell_quality(ring_[i], ring_[m], ring_[j], b_));
          if (quality > best_[i][j])
            quality = std::min(quality, cell_quality(ring_[i], ring_[j], ring_[m], a_));
          if (quality > best_[i][j])
          {
            best_[i][j] = quality;
            via_[i][j]  = m;
          }
        }
      }

      double cell_quality(const NodeIndex i, const NodeIndex j, const NodeIndex k, const NodeIndex l) const
      {
        return tet_quality({{mesh_.X(i), mesh_.X(j), mesh_.X(k), mesh_.X(l)}});
      }

      const EditableMesh           &mesh_;
      const NodeIndex               a_, b_;
      const std::vector<NodeIndex> &ring_;
      const double                  bound_;
      double                        best_[longest_ring][longest_ring];
      unsigned int                  via_[longest_ring][longest_ring];
    };

    // Exchanges the two boundary faces at a-b for those at the chord from the first to the last of the ring.
    bool flip_surface(const RemeshingContext &context,
                      NodeIndex               a,
                      NodeIndex               b,
                      const EdgeRing         &ring,
                      CavityChange           &change)
    {
      const EditableMesh &mesh = context.mesh;
      const NodeIndex     c = ring.nodes.front(), d = ring.nodes.back();
      change.removed_faces = mesh.faces_at_edge(a, b);
      if (change.removed_faces.size() != 2 || !mesh.faces_at_edge(c, d).empty())
        return false;
      // Only the cell of a ring of two has the edge c-d already.
      if (ring.nodes.size() > 2 && mesh.is_edge(c, d))
        return false;
      const unsigned int region = mesh.face(change.removed_faces[0]).region;
      if (region != mesh.face(change.removed_faces[1]).region || mesh.curve_of_edge(a, b) != invalid_index)
        return false;
      change.added_faces = {{{{c, b, d}}, region}, {{{c, d, a}}, region}};
      for (const unsigned int before : change.removed_faces)
        for (const SurfaceFace &after : change.added_faces)
          if (!look_alike(corners(mesh.face(before).nodes, mesh), corners(after.nodes, mesh)))
            return false;
      const double apart = segment_distance(mesh.X(a), mesh.X(b), mesh.X(c), mesh.X(d));
      return apart < context.parameters.ridge_deviation * context.size((mesh.X(a) + mesh.X(b)) / 2.);
    }
  } // namespace

  EdgeRing edge_ring(const EditableMesh &mesh, const NodeIndex a, const NodeIndex b)
  {
    EdgeRing ring;
    ring.cells = mesh.cells_at_edge(a, b);
    std::vector<std::array<NodeIndex, 2>> steps;
    for (const CellIndex cell : ring.cells)
      steps.push_back(opposite_edge(mesh.cell(cell), a, b));
    // An open ring begins where no step ends.
    NodeIndex start = invalid_index;
    for (const auto &step : steps)
      if (std::none_of(steps.begin(), steps.end(), [&](const auto &other) { return other[1] == step[0]; }))
        start = step[0];
    ring.is_closed = start == invalid_index;
    if (steps.empty())
      return ring;
    ring.nodes.push_back(ring.is_closed ? steps[0][0] : start);
    for (std::size_t walked = 0; walked < steps.size(); ++walked)
    {
      const auto step = std::find_if(
        steps.begin(), steps.end(), [&](const auto &other) { return other[0] == ring.nodes.back(); });
      if (step == steps.end())
        break;
      ring.nodes.push_back((*step)[1]);
    }
    if (ring.is_closed)
      ring.nodes.pop_back();
    return ring;
  }

  std::optional<CavityChange> plan_edge_removal(const RemeshingContext &context,
                                                const NodeIndex         a,
                                                const NodeIndex         b,
                                                const double            least_gain)
  {
    const EditableMesh &mesh = context.mesh;
    const EdgeRing      ring = edge_ring(mesh, a, b);
    const unsigned int  n    = ring.nodes.size();
    if (n < (ring.is_closed ? 3 : 2) || n > longest_ring || ring.cells.size() != (ring.is_closed ? n : n - 1))
      return {};
    CavityChange change;
    change.removed_cells          = ring.cells;
    change.quality_before         = minimum_quality(mesh, ring.cells);
    const double            bound = std::max(0., change.quality_before + least_gain);
    const RingTriangulation triangulation(mesh, a, b, ring.nodes, bound);
    change.quality_after = triangulation.quality();
    if (!(change.quality_after > bound))
      return {};
    if (!ring.is_closed && (!flip_surface(context, a, b, ring, change) || hides_metal(context, change)))
      return {};
    triangulation.add_cells(0, n - 1, change.added_cells);
    return change;
  }
} // namespace retroforge
