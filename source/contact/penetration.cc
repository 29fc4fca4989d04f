// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/contact/die_overlap.h>
#include <retroforge/contact/penetration.h>
#include <retroforge/core/shares.h>

namespace retroforge
{
  namespace
  {
    struct SurfacePoint
    {
      Vec3   x;
      double within; ///< length of the edges there [mm]
    };

    std::vector<SurfacePoint>
    surface_points(const TetMesh &mesh, const Topology &topology, const NodalVectors<double> &X)
    {
      std::vector<SurfacePoint> points;
      std::vector<double>       longest(X.size(), 0.);
      for (const auto &[a, b] : topology.surface_edges)
      {
        const double length = (X[a] - X[b]).norm();
        longest[a]          = std::max(longest[a], length);
        longest[b]          = std::max(longest[b], length);
        points.push_back({0.5 * (X[a] + X[b]), length});
      }
      for (NodeIndex k = 0; k < X.size(); ++k)
        if (topology.is_on_surface(k))
          points.push_back({X[k], longest[k]});
      for (const BoundaryFace &face : mesh.faces)
        if (const auto &[a, b, c] = face.nodes; mesh.is_surface(face))
          points.push_back({(X[a] + X[b] + X[c]) / 3., std::max({longest[a], longest[b], longest[c]})});
      return points;
    }

    Penetration deepest_of(const std::vector<Penetration> &found)
    {
      Penetration deepest;
      for (const Penetration &one : found)
        if (one.depth > deepest.depth)
          deepest = one;
      return deepest;
    }

    /// Returns the deepest of the ranks' findings, in their order.
    Penetration deepest_of_ranks(const Penetration &mine, MPI_Comm comm)
    {
      using Numbers = std::array<double, 4>;
      const auto depths =
        joined<Numbers>({{{mine.depth, mine.place[0], mine.place[1], mine.place[2]}}}, comm);
      const auto               dies = joined<unsigned int>({mine.die}, comm);
      std::vector<Penetration> found;
      for (std::size_t r = 0; r < dies.size(); ++r)
        found.push_back({depths[r][0], Vec3({depths[r][1], depths[r][2], depths[r][3]}), dies[r]});
      return deepest_of(found);
    }
  } // namespace

  Penetration deepest_point(const TetMesh                       &mesh,
                            const Topology                      &topology,
                            const std::vector<Die>              &dies,
                            const std::vector<DieState<double>> &states,
                            const NodalVectors<double>          &X,
                            MPI_Comm                             comm)
  {
    AssertDimension(X.size(), mesh.n_nodes());
    AssertDimension(states.size(), dies.size());
    const auto points       = surface_points(mesh, topology, X);
    const auto [begin, end] = share_of_rank(points.size(), comm);
    Penetration deepest;
    for (std::size_t i = begin; i < end; ++i)
      for (unsigned int d = 0; d < dies.size(); ++d)
        if (const double depth = dies[d].depth_of(points[i].x, states[d].displacement, points[i].within);
            depth > deepest.depth && states[d].in_press != 0)
          deepest = {depth, points[i].x, d};
    const MetalSurface metal = metal_surface(mesh, X);
    for (unsigned int d = 0; d < dies.size(); ++d)
      if (const Overlap overlap = find_die_in_metal(dies[d], states[d].displacement, metal, comm);
          overlap.depth > deepest.depth && states[d].in_press != 0)
        deepest = {overlap.depth, overlap.place, d};
    return deepest_of_ranks(deepest, comm);
  }
} // namespace retroforge
