// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include "../mesh/mesh_test_tools.h"
#include <retroforge/mesh/cell_faces.h>
#include <retroforge/remeshing/local_remesher.h>
#include <retroforge/remeshing/remeshing_context.h>
#include <retroforge/remeshing/trigger.h>

#include <algorithm>
#include <random>
#include <set>

namespace retroforge
{
  /// Outer faces of the cells, all on one patch, `surface`.
  inline void add_one_patch(TetMesh &mesh)
  {
    mesh.patches = {{"surface", {}}};
    mesh.faces.clear();
    for (const auto &face : boundary_cell_faces(mesh.cells))
      mesh.faces.push_back({face.nodes, 0});
  }

  /// Where measured numbers go, which differ from compiler to compiler: nowhere, or to the error stream after
  /// a first call with true. The tests do that when they are given an argument.
  inline std::ostream &measured(const bool show = false)
  {
    static std::ostream nowhere(nullptr);
    static bool         is_shown = false;
    is_shown                     = is_shown || show;
    return is_shown ? std::cerr : nowhere;
  }

  /// A number in (-1, 1), the same on every machine.
  inline double random_number(std::mt19937 &random)
  {
    return 2 * (random() + 0.5) / 4294967296. - 1;
  }

  /// Nodes - edges + faces - cells: 1 for a ball, 0 for a ring.
  inline int euler_characteristic(const TetMesh &mesh)
  {
    std::set<std::array<NodeIndex, 2>> edges;
    std::set<FaceKey>                  faces;
    for (const auto &cell : mesh.cells)
      for (unsigned int i = 0; i < 4; ++i)
      {
        const auto                    &local = tet_face_corners[i];
        const std::array<NodeIndex, 3> face  = {{cell[local[0]], cell[local[1]], cell[local[2]]}};
        faces.insert(face_key(face));
        for (unsigned int j = i + 1; j < 4; ++j)
          edges.insert(std::array<NodeIndex, 2>{{std::min(cell[i], cell[j]), std::max(cell[i], cell[j])}});
      }
    return int(mesh.n_nodes()) - int(edges.size()) + int(faces.size()) - int(mesh.n_cells());
  }

  /// Box of n x n x n unit cubes, each cut into six tetrahedra around its diagonal, six patches. Nodes inside
  /// are moved by up to `noise`, those on the sides along them.
  inline TetMesh kuhn_box(const unsigned int n, const double noise)
  {
    TetMesh      mesh;
    std::mt19937 random(1);
    const auto   index = [&](const std::array<unsigned int, 3> &i) {
      return i[0] + (n + 1) * (i[1] + (n + 1) * i[2]);
    };
    std::array<unsigned int, 3> i;
    for (i[2] = 0; i[2] <= n; ++i[2])
      for (i[1] = 0; i[1] <= n; ++i[1])
        for (i[0] = 0; i[0] <= n; ++i[0])
        {
          Vec3 x;
          for (unsigned int d = 0; d < 3; ++d)
          {
            const double r = random_number(random);
            x[d]           = i[d] + (i[d] > 0 && i[d] < n ? noise * r : 0);
          }
          mesh.X.push_back(x);
        }
    const unsigned int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    for (i[2] = 0; i[2] < n; ++i[2])
      for (i[1] = 0; i[1] < n; ++i[1])
        for (i[0] = 0; i[0] < n; ++i[0])
          for (const auto &order : orders)
          {
            auto                     at   = i;
            std::array<NodeIndex, 4> cell = {{index(at), 0, 0, 0}};
            for (unsigned int step = 0; step < 3; ++step)
            {
              ++at[order[step]];
              cell[step + 1] = index(at);
            }
            if (tet_volume(corners(cell, mesh.X)) < 0)
              std::swap(cell[2], cell[3]);
            mesh.cells.push_back(cell);
          }
    add_one_patch(mesh);
    mesh.patches.clear();
    for (const char *name : {"x0", "x1", "y0", "y1", "z0", "z1"})
      mesh.patches.push_back({name, {}});
    for (auto &face : mesh.faces)
    {
      const Vec3 normal = face_normal(mesh, face);
      for (unsigned int d = 0; d < 3; ++d)
        if (std::abs(normal[d]) > 0.5 * normal.norm())
          face.patch = 2 * d + (normal[d] > 0);
    }
    return mesh;
  }

  inline std::string verdict(const TetMesh &mesh)
  {
    try
    {
      check_mesh(mesh, "mesh");
      return "valid";
    }
    catch (const Error &error)
    {
      return error.what();
    }
  }

  /// Everything an operation needs, for one mesh.
  struct Workbench
  {
    TetMesh             mesh;
    RemeshingParameters parameters;
    SurfaceFeatures     features;
    OldSurface          old_surface;
    SizeField           size;
    EditableMesh        edited;
    RemeshingContext    context;

    Workbench(const TetMesh &mesh, const double h, const RemeshingParameters &parameters = {})
        : mesh(mesh)
        , parameters(parameters)
        , features(mesh, mesh.X, parameters.ridge_angle, parameters.corner_angle)
        , old_surface(mesh, mesh.X, features, {})
        , size([h](const Vec3 &) { return h; })
        , edited(mesh, mesh.X, features)
        , context{edited, old_surface, size, this->parameters}
    {
    }
    Workbench(const Workbench &) = delete;

    /// The mesh after one change, the workbench itself stays as it is.
    TetMesh after(const CavityChange &change) const
    {
      EditableMesh copy = edited;
      copy.apply(change);
      std::vector<NodeIndex> old_node;
      TetMesh                result = compacted(copy, features, old_node);
      result.patches                = mesh.patches;
      return result;
    }
  };

  inline double mean_edge_length(const TetMesh &mesh)
  {
    double sum = 0;
    for (const auto &cell : mesh.cells)
      for (unsigned int i = 0; i < 4; ++i)
        for (unsigned int j = i + 1; j < 4; ++j)
          sum += (mesh.X[cell[i]] - mesh.X[cell[j]]).norm();
    return sum / (6 * mesh.n_cells());
  }

  inline bool same_bits(const RemeshedMesh &a, const RemeshedMesh &b)
  {
    return a.mesh.X == b.mesh.X && a.mesh.cells == b.mesh.cells && a.old_node == b.old_node &&
           std::equal(a.mesh.faces.begin(),
                      a.mesh.faces.end(),
                      b.mesh.faces.begin(),
                      b.mesh.faces.end(),
                      [](const auto &f, const auto &g) { return f.nodes == g.nodes && f.patch == g.patch; });
  }

  /// Kept nodes are where they were plus the correction, bit for bit.
  inline bool kept_nodes_stay(const RemeshedMesh &result, const NodalVectors<double> &X)
  {
    for (NodeIndex node = 0; node < result.mesh.n_nodes(); ++node)
    {
      const NodeIndex old = result.old_node[node];
      if (old != invalid_index && result.mesh.X[node] - X[old] != result.correction[node])
        return false;
      if (old != invalid_index && result.correction[node] == Vec3() && result.mesh.X[node] != X[old])
        return false;
    }
    return true;
  }

  /// What one remeshing did, in words that survive another compiler: bounds, no counts.
  inline void
  print_result(const std::string &title, const RemeshedMesh &result, const NodalVectors<double> &X)
  {
    const RemeshingReport &report = result.report;
    const double           angle  = minimum_free_angle(result.mesh, result.mesh.X);
    std::cout << title << ": " << verdict(result.mesh)
              << ", angle from under 15: " << yes(report.angle_before < 15) << ", to 15: " << yes(angle >= 15)
              << ", to 20: " << yes(angle > 19.99) << ", volume to 1e-12: "
              << yes(std::abs(report.volume_after / report.volume_before - 1) < 1e-12)
              << ", kept nodes stay: " << yes(kept_nodes_stay(result, X)) << "\n";
    measured() << title << ": angle " << report.angle_before << " -> " << angle << ", nodes "
               << report.n_nodes_before << " -> " << report.n_nodes_after << ", kept " << report.n_nodes_kept
               << ", left bad " << report.n_cells_left_bad << ", volume "
               << report.volume_uncorrected / report.volume_before - 1 << " -> "
               << report.volume_after / report.volume_before - 1 << ", correction "
               << report.largest_correction << " h, operations " << report.n_length_collapses << " "
               << report.n_length_splits << " " << report.n_edge_removals << " " << report.n_surface_flips
               << " " << report.n_face_flips << " " << report.n_smoothings << " "
               << report.n_quality_collapses << " " << report.n_quality_splits << "\n";
  }
} // namespace retroforge
