// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/billet/patch_shapes.h>
#include <retroforge/core/error.h>
#include <retroforge/mesh/boundary_location.h>
#include <retroforge/mesh/cell_faces.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

namespace retroforge
{
  namespace
  {
    // Signed distance from a surface, and its gradient (a unit vector).
    struct Distance
    {
      double value;
      Vec3   gradient;
    };

    Distance distance(const Plane &plane, const Vec3 &x)
    {
      return {(x - plane.point) * plane.normal, plane.normal};
    }

    Distance distance(const CylinderSurface &cylinder, const Vec3 &x)
    {
      Vec3 arm = x - cylinder.point;
      arm -= (arm * cylinder.axis) * cylinder.axis;
      const double r = arm.norm();
      return {r - cylinder.radius, r > 0 ? arm / r : Vec3()};
    }

    // From the tangent at the closest point: the curve goes on straight beyond its ends.
    Distance distance(const RevolvedCurve &surface, const Vec3 &x)
    {
      const Vec3   arm = x - surface.point;
      const double r   = std::hypot(arm[0], arm[1]);
      const Vec2   p({r, arm[2]});
      const double t       = surface.curve.closest(p);
      Vec2         tangent = surface.curve.derivative(t);
      tangent /= tangent.norm();
      const Vec2 normal({tangent[1], -tangent[0]});
      const Vec3 outwards = r > 0 ? Vec3({arm[0] / r, arm[1] / r, 0}) : Vec3();
      return {(p - surface.curve.value(t)) * normal, normal[0] * outwards + Vec3({0, 0, normal[1]})};
    }

    double distance_within_ends(const RevolvedCurve &surface, const Vec3 &x)
    {
      const Vec3 arm = x - surface.point;
      const Vec2 p({std::hypot(arm[0], arm[1]), arm[2]});
      return (p - surface.curve.value(surface.curve.closest(p))).norm();
    }

    bool lies_on(const PatchShape &shape, const Vec3 &x, const double tolerance)
    {
      return (!shape.plane || std::abs(distance(*shape.plane, x).value) <= tolerance) &&
             (!shape.cylinder || std::abs(distance(*shape.cylinder, x).value) <= tolerance) &&
             (!shape.revolved || distance_within_ends(*shape.revolved, x) <= tolerance);
    }

    std::size_t find_shape(const std::vector<PatchShape>  &shapes,
                           const NodalVectors<double>     &X,
                           const std::array<NodeIndex, 3> &nodes,
                           const double                    tolerance)
    {
      return std::find_if(shapes.begin(),
                          shapes.end(),
                          [&](const PatchShape &shape) {
                            return std::all_of(nodes.begin(), nodes.end(), [&](const NodeIndex node) {
                              return lies_on(shape, X[node], tolerance);
                            });
                          }) -
             shapes.begin();
    }

    // Leaves out the patches without faces.
    std::vector<PatchShape> keep_used(TetMesh &mesh, const std::vector<PatchShape> &shapes)
    {
      std::vector<bool> used(shapes.size(), false);
      for (const auto &face : mesh.faces)
        used[face.patch] = true;
      std::vector<unsigned int> number(shapes.size(), invalid_index);
      std::vector<PatchShape>   kept;
      mesh.patches.clear();
      for (std::size_t s = 0; s < shapes.size(); ++s)
        if (used[s])
        {
          number[s] = kept.size();
          kept.push_back(shapes[s]);
          mesh.patches.push_back(shapes[s].patch);
        }
      for (auto &face : mesh.faces)
        face.patch = number[face.patch];
      return kept;
    }

    // One Newton step onto all surfaces at once, the shortest one. Surfaces whose gradients depend
    // on those before them (three planes through one line) are met already and are passed over.
    Vec3 step_onto(const std::vector<Distance> &distances)
    {
      Vec3              step;
      std::vector<Vec3> directions;
      for (const auto &distance : distances)
      {
        Vec3 across = distance.gradient;
        for (unsigned int pass = 0; pass < 2; ++pass)
          for (const Vec3 &direction : directions)
            across -= (across * direction) * direction;
        if (across.norm() < 1e-6)
          continue;
        across /= across.norm();
        step -= (distance.value + step * distance.gradient) / (across * distance.gradient) * across;
        directions.push_back(across);
      }
      return step;
    }

    // Unit normal of the sum of the faces' area vectors, through the mean of the nodes.
    Plane fit_plane(const TetMesh &mesh, const unsigned int patch, const std::set<NodeIndex> &nodes)
    {
      Plane plane;
      for (const NodeIndex node : nodes)
        plane.point += mesh.X[node] / static_cast<double>(nodes.size());
      for (const auto &face : mesh.faces)
        if (face.patch == patch)
        {
          const Vec3 &a = mesh.X[face.nodes[0]];
          plane.normal += cross_product_3d(mesh.X[face.nodes[1]] - a, mesh.X[face.nodes[2]] - a);
        }
      if (plane.normal.norm() > 0) // zero for a closed surface, which then fails the check
        plane.normal /= plane.normal.norm();
      return plane;
    }

    double farthest(const TetMesh &mesh, const std::set<NodeIndex> &nodes, const Plane &plane)
    {
      double far = 0;
      for (const NodeIndex node : nodes)
        far = std::max(far, std::abs(distance(plane, mesh.X[node]).value));
      return far;
    }
  } // namespace

  double mesh_size(const TetMesh &mesh)
  {
    Vec3 low = mesh.X.at(0), high = low;
    for (const Vec3 &x : mesh.X)
      for (unsigned int d = 0; d < 3; ++d)
      {
        low[d]  = std::min(low[d], x[d]);
        high[d] = std::max(high[d], x[d]);
      }
    return (high - low).norm();
  }

  std::vector<PatchShape> assign_patches(TetMesh                       &mesh,
                                         const std::vector<PatchShape> &shapes,
                                         const double                   tolerance,
                                         const std::string             &where)
  {
    mesh.faces.clear();
    for (const auto &face : boundary_cell_faces(mesh.cells))
    {
      const std::size_t shape = find_shape(shapes, mesh.X, face.nodes, tolerance);
      if (shape == shapes.size())
      {
        std::ostringstream what;
        what << "a face of the mesh at "
             << (mesh.X[face.nodes[0]] + mesh.X[face.nodes[1]] + mesh.X[face.nodes[2]]) / 3.
             << " lies on no side of the billet";
        throw Error(where, what.str(), "the mesh must follow the billet", "choose a smaller element size");
      }
      mesh.faces.push_back({face.nodes, static_cast<unsigned int>(shape)});
    }
    return keep_used(mesh, shapes);
  }

  void snap_nodes(TetMesh &mesh, const std::vector<PatchShape> &shapes)
  {
    const auto            patches = patches_at_nodes(mesh);
    std::vector<Distance> distances;
    for (NodeIndex node = 0; node < mesh.n_nodes(); ++node)
      for (unsigned int step = 0; step < 4 && !patches[node].empty(); ++step)
      {
        distances.clear();
        for (const unsigned int patch : patches[node])
        {
          if (shapes[patch].plane)
            distances.push_back(distance(*shapes[patch].plane, mesh.X[node]));
          if (shapes[patch].cylinder)
            distances.push_back(distance(*shapes[patch].cylinder, mesh.X[node]));
          if (shapes[patch].revolved)
            distances.push_back(distance(*shapes[patch].revolved, mesh.X[node]));
        }
        mesh.X[node] += step_onto(distances);
      }
  }

  void fit_symmetry_planes(TetMesh &mesh, const std::vector<bool> &is_symmetry, const std::string &where)
  {
    const double            size = mesh_size(mesh);
    std::vector<PatchShape> shapes;
    for (unsigned int p = 0; p < mesh.patches.size(); ++p)
    {
      if (is_symmetry[p])
      {
        std::set<NodeIndex> nodes;
        for (const auto &face : mesh.faces)
          if (face.patch == p)
            nodes.insert(face.nodes.begin(), face.nodes.end());
        if (nodes.empty())
          throw Error(where,
                      "the symmetry patch `" + mesh.patches[p].name + "' has no face on the boundary",
                      "a symmetry patch must bound the mesh",
                      "choose a physical surface on the outside");
        const Plane  plane = fit_plane(mesh, p, nodes);
        const double far   = farthest(mesh, nodes, plane);
        if (!(plane.normal.norm() > 0) || far > 1e-6 * size)
        {
          std::ostringstream what;
          what << "the symmetry patch `" << mesh.patches[p].name << "' is not planar: a node lies " << far
               << " from its plane";
          throw Error(where,
                      what.str(),
                      "a symmetry patch must be planar to 1e-6 of the size of the mesh",
                      "give each symmetry plane a physical surface of its own");
        }
        mesh.patches[p].symmetry = plane;
      }
      shapes.push_back({mesh.patches[p], mesh.patches[p].symmetry, {}, {}});
    }
    snap_nodes(mesh, shapes);
  }
} // namespace retroforge
