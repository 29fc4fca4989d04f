// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/remeshing/surface_features.h>
#include <retroforge/remeshing/volume_correction.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  namespace
  {
    // A face is part of a flat piece when each neighbour is within 0.26 degrees of its normal, or turns by
    // more than the ridge angle or has another patch: then it bounds the piece.
    constexpr double flat_cosine = 1 - 1e-5;
    // What rounding makes of the sum of many cells; not worth moving nodes for, flat sides even less.
    constexpr double       negligible         = 1e-13;
    constexpr double       negligible_if_flat = 1e-12;
    constexpr unsigned int max_iterations     = 8;

    std::vector<bool>
    flat_faces(const TetMesh &mesh, const std::vector<Vec3> &normals, const double ridge_angle)
    {
      const double      ridge_cosine = std::cos(ridge_angle * M_PI / 180.);
      std::vector<bool> is_flat(mesh.faces.size(), true);
      for (const auto &edge : surface_edges(mesh.faces))
      {
        const auto [f, g]   = edge.faces;
        const double cosine = normals[f] * normals[g];
        if (mesh.faces[f].patch == mesh.faces[g].patch && cosine > ridge_cosine && cosine < flat_cosine)
          is_flat[f] = is_flat[g] = false;
      }
      return is_flat;
    }

    std::vector<NodeConstraint> node_constraints(const TetMesh           &mesh,
                                                 const std::vector<Vec3> &normals,
                                                 const std::vector<bool> &kept_flat)
    {
      std::vector<NodeConstraint> constraints(mesh.n_nodes());
      for (const auto &face : mesh.faces)
        if (const auto &plane = mesh.patches[face.patch].symmetry)
          for (const NodeIndex node : face.nodes)
            constraints[node].add(plane->normal, invalid_index);
      for (unsigned int f = 0; f < mesh.faces.size(); ++f)
        if (kept_flat[f])
          for (const NodeIndex node : mesh.faces[f].nodes)
            constraints[node].add(normals[f], f);
      return constraints;
    }

    struct Directions
    {
      NodalVectors<double> u;
      double               area = 0; // sum of g·u, the derivative of the volume
    };

    Directions directions(const TetMesh                     &mesh,
                          const NodalVectors<double>        &g,
                          const std::vector<NodeConstraint> &constraints,
                          const std::vector<bool>           &held)
    {
      Directions result;
      result.u.resize(mesh.n_nodes());
      for (NodeIndex node = 0; node < mesh.n_nodes(); ++node)
        if (g[node].norm_square() > 0 && !held[node])
        {
          result.u[node] = constraints[node].project(g[node] / g[node].norm());
          // Rounding must not move what is fixed.
          if (result.u[node].norm() < 1e-2)
            result.u[node] = Vec3();
          result.area += g[node] * result.u[node];
        }
      return result;
    }

    /// Moves nodes by step * u, or by as many halves of it as the cells allow; returns what was taken.
    double advance(TetMesh &mesh, const NodalVectors<double> &u, double step)
    {
      const NodalVectors<double> X = mesh.X;
      for (unsigned int halvings = 0; halvings < 6; ++halvings, step *= 0.5)
      {
        for (NodeIndex node = 0; node < mesh.n_nodes(); ++node)
          mesh.X[node] = X[node] + step * u[node];
        const bool sound = std::all_of(mesh.cells.begin(), mesh.cells.end(), [&](const auto &cell) {
          return tet_volume(corners(cell, mesh.X)) > 0.2 * tet_volume(corners(cell, X));
        });
        if (sound)
          return step;
      }
      mesh.X = X;
      return 0.;
    }

    double surface_area(const TetMesh &mesh)
    {
      double area = 0;
      for (const auto &face : mesh.faces)
        area += cross_product_3d(mesh.X[face.nodes[1]] - mesh.X[face.nodes[0]],
                                 mesh.X[face.nodes[2]] - mesh.X[face.nodes[0]])
                  .norm() /
                2;
      return area;
    }
  } // namespace

  Vec3 NodeConstraint::project(Vec3 v) const
  {
    for (unsigned int i = 0; i < n; ++i)
      v -= (v * directions[i]) * directions[i];
    return v;
  }

  void NodeConstraint::add(const Vec3 &normal, const unsigned int face)
  {
    const Vec3 rest = project(normal);
    if (n == 3 || !(rest.norm() > 0.02))
      return;
    directions[n] = rest / rest.norm();
    normals[n]    = normal;
    faces[n]      = face;
    ++n;
  }

  NodalVectors<double> volume_gradient(const std::vector<BoundaryFace> &faces, const NodalVectors<double> &X)
  {
    NodalVectors<double> g(X.size());
    for (const auto &face : faces)
    {
      const auto &n = face.nodes;
      const Vec3  a = cross_product_3d(X[n[1]] - X[n[0]], X[n[2]] - X[n[0]]) / 6.;
      for (const NodeIndex node : n)
        g[node] += a;
    }
    return g;
  }

  VolumeCorrection correct_volume(TetMesh                 &mesh,
                                  const double             wanted_volume,
                                  const std::vector<bool> &held,
                                  const double             ridge_angle)
  {
    const double tolerance   = 1e-14 * wanted_volume;
    double       missing     = wanted_volume - volume(mesh.cells, mesh.X);
    const bool   is_right    = std::abs(missing) <= negligible * wanted_volume;
    const auto   normals     = face_unit_normals(mesh.faces, mesh.X);
    const auto   g           = volume_gradient(mesh.faces, mesh.X);
    auto         constraints = node_constraints(mesh, normals, flat_faces(mesh, normals, ridge_angle));
    auto         moves       = directions(mesh, g, constraints, held);
    if (moves.area < 1e-3 * surface_area(mesh) && std::abs(missing) > negligible_if_flat * wanted_volume)
    {
      constraints = node_constraints(mesh, normals, std::vector<bool>(mesh.faces.size(), false));
      moves       = directions(mesh, g, constraints, held);
    }

    if (moves.area < 1e-3 * surface_area(mesh))
      return {};
    double distance = 0;
    for (unsigned int i = 0; !is_right && i < max_iterations && std::abs(missing) > tolerance; ++i)
    {
      if (moves.area < 1e-3 * surface_area(mesh))
        break;
      const double step = advance(mesh, moves.u, missing / moves.area);
      distance += step;
      const double before = std::abs(missing);
      missing             = wanted_volume - volume(mesh.cells, mesh.X);
      if (step == 0. || !(std::abs(missing) < before))
        break; // rounding, or no room
    }
    return {distance, missing, std::move(moves.u), std::move(constraints)};
  }
} // namespace retroforge
