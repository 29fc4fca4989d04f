// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/nearest_name.h>
#include <retroforge/design/free_form.h>
#include <retroforge/element/cell_geometry.h>
#include <retroforge/geometry/triangle_surface.h>
#include <retroforge/mesh/mesh_quality.h>

#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/lapack_full_matrix.h>
#include <deal.II/lac/sparse_direct.h>
#include <deal.II/lac/sparse_matrix.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  namespace
  {
    constexpr double aligned = 1. - 1e-10; ///< the cosine between a normal and an axis that are one

    void check(const FreeFormParameters &parameters, const TetMesh &mesh)
    {
      std::vector<std::string> known;
      for (const Patch &patch : mesh.patches)
        if (!patch.symmetry)
          known.push_back(patch.name);
      if (parameters.patches.empty())
        throw Error("Billet/free form patches",
                    "names none, and there are free form modes",
                    "a free form moves named patches",
                    "name some of " + join(known));
      for (const std::string &name : parameters.patches)
        if (std::find(known.begin(), known.end(), name) == known.end())
          throw Error("Billet/free form patches",
                      "there is no patch '" + name + "'",
                      "the patches of this billet are: " + join(known),
                      "name some of these");
    }

    /// What a free form knows of the billet's boundary.
    class MovingSurface
    {
    public:
      MovingSurface(const FreeFormParameters &parameters, const TetMesh &mesh);

      std::size_t n() const { return nodes.size(); }

      std::vector<NodeIndex>                nodes;     ///< that move
      NodalVectors<double>                  direction; ///< of each
      std::vector<double>                   mass;      ///< a third of the areas around [mm^2]
      std::vector<std::array<NodeIndex, 3>> triangles; ///< by place among the nodes
      std::vector<std::vector<Vec3>>        planes; ///< normals of those that each node of the mesh keeps to
      std::vector<bool>                     fixed;  ///< nodes of the mesh that stay

    private:
      void find_planes(const TetMesh &mesh, const std::vector<bool> &moves);
      void find_directions(const TetMesh &mesh);
    };

    Vec3 face_vector(const TetMesh &mesh, const BoundaryFace &face)
    {
      return facet_vector(mesh.X[face.nodes[0]], mesh.X[face.nodes[1]], mesh.X[face.nodes[2]]);
    }

    MovingSurface::MovingSurface(const FreeFormParameters &parameters, const TetMesh &mesh)
        : planes(mesh.n_nodes()), fixed(mesh.n_nodes(), false)
    {
      std::vector<bool> moves;
      for (const Patch &patch : mesh.patches)
        moves.push_back(std::find(parameters.patches.begin(), parameters.patches.end(), patch.name) !=
                        parameters.patches.end());
      std::vector<unsigned int> place(mesh.n_nodes(), invalid_index);
      for (const BoundaryFace &face : mesh.faces)
        if (moves[face.patch])
        {
          triangles.emplace_back();
          for (unsigned int i = 0; i < 3; ++i)
          {
            const NodeIndex k = face.nodes[i];
            if (place[k] == invalid_index)
            {
              place[k] = nodes.size();
              nodes.push_back(k);
            }
            triangles.back()[i] = place[k];
          }
        }
      mass.assign(n(), 0.);
      for (const auto &t : triangles)
        for (const NodeIndex s : t)
          mass[s] += facet_vector(mesh.X[nodes[t[0]]], mesh.X[nodes[t[1]]], mesh.X[nodes[t[2]]]).norm() / 6.;
      find_planes(mesh, moves);
      find_directions(mesh);
    }

    void MovingSurface::find_planes(const TetMesh &mesh, const std::vector<bool> &moves)
    {
      for (unsigned int p = 0; p < mesh.patches.size(); ++p)
      {
        if (moves[p])
          continue;
        std::vector<const BoundaryFace *> faces;
        for (const BoundaryFace &face : mesh.faces)
          if (face.patch == p)
            faces.push_back(&face);
        if (faces.empty())
          continue;
        Vec3 normal = face_vector(mesh, *faces.front());
        normal /= normal.norm();
        const bool is_plane = std::all_of(faces.begin(), faces.end(), [&](const BoundaryFace *face) {
          const Vec3 v = face_vector(mesh, *face);
          return v * normal > aligned * v.norm();
        });
        if (mesh.patches[p].symmetry)
          normal = mesh.patches[p].symmetry->normal;
        for (const BoundaryFace *face : faces)
          for (const NodeIndex k : face->nodes)
          {
            fixed[k] = fixed[k] || !is_plane;
            if (std::none_of(planes[k].begin(), planes[k].end(), [&](const Vec3 &other) {
                  return std::abs(other * normal) > aligned;
                }))
              planes[k].push_back(normal);
          }
      }
    }

    /// Into all planes that a node keeps to.
    Vec3 projected(Vec3 d, const std::vector<Vec3> &planes)
    {
      std::vector<Vec3> axes;
      for (Vec3 axis : planes)
      {
        for (const Vec3 &other : axes)
          axis -= (axis * other) * other;
        if (axis.norm() > 1e-6)
          axes.push_back(axis / axis.norm());
      }
      for (const Vec3 &axis : axes)
        d -= (d * axis) * axis;
      return d;
    }

    void MovingSurface::find_directions(const TetMesh &mesh)
    {
      direction.assign(n(), Vec3());
      for (const auto &t : triangles)
      {
        const Vec3 v = facet_vector(mesh.X[nodes[t[0]]], mesh.X[nodes[t[1]]], mesh.X[nodes[t[2]]]);
        for (const NodeIndex s : t)
          direction[s] += v;
      }
      for (std::size_t s = 0; s < n(); ++s)
        direction[s] =
          fixed[nodes[s]] ? Vec3() : projected(direction[s] / direction[s].norm(), planes[nodes[s]]);
    }

    /// M^-1/2 L M^-1/2 with the cotangents of the triangles.
    dealii::LAPACKFullMatrix<double> scaled_stiffness(const MovingSurface &surface, const TetMesh &mesh)
    {
      dealii::LAPACKFullMatrix<double> A(surface.n(), surface.n());
      A = 0.;
      for (const auto &t : surface.triangles)
        for (unsigned int i = 0; i < 3; ++i)
        {
          const NodeIndex a = t[(i + 1) % 3], b = t[(i + 2) % 3];
          const Vec3      x = mesh.X[surface.nodes[t[i]]], u = mesh.X[surface.nodes[a]] - x,
                     v           = mesh.X[surface.nodes[b]] - x;
          const double cotangent = (u * v) / cross_product_3d(u, v).norm();
          const double off       = 0.5 * cotangent / std::sqrt(surface.mass[a] * surface.mass[b]);
          A(a, a) += 0.5 * cotangent / surface.mass[a];
          A(b, b) += 0.5 * cotangent / surface.mass[b];
          A(a, b) -= off;
          A(b, a) -= off;
        }
      return A;
    }

    /// Values of the modes at the surface's nodes.
    std::vector<std::vector<double>>
    modes_of(const MovingSurface &surface, const TetMesh &mesh, const FreeFormParameters &parameters)
    {
      double area = 0.;
      for (const double m : surface.mass)
        area += m;
      const double length = parameters.length > 0. ? parameters.length : std::sqrt(area) / 4.;
      // By Weyl's law the first n lie below  4 pi n / area,  on surfaces that are not all rim.
      dealii::Vector<double>     lambda;
      dealii::FullMatrix<double> vectors;
      for (double below = 8. * dealii::numbers::PI * (parameters.modes + 4) / area;
           lambda.size() < parameters.modes;
           below *= 4.)
      {
        auto A = scaled_stiffness(surface, mesh);
        A.compute_eigenvalues_symmetric(-1e-6 * below, below, 0., lambda, vectors);
      }
      std::vector<std::vector<double>> modes;
      for (unsigned int i = 0; i < parameters.modes; ++i)
      {
        const double        size = std::sqrt(area / (1. + length * length * std::max(0., lambda(i))));
        std::vector<double> mode;
        double              largest = 0.;
        for (std::size_t s = 0; s < surface.n(); ++s)
        {
          mode.push_back(size * vectors(s, i) / std::sqrt(surface.mass[s]));
          // Of two that are nearly as large the first, so that rounding does not choose the sign.
          if (std::abs(mode.back()) > 1.001 * std::abs(largest))
            largest = mode.back();
        }
        if (largest < 0.)
          for (double &value : mode)
            value = -value;
        modes.push_back(std::move(mode));
      }
      return modes;
    }

    /// Laplace's equation inside, one component after the other.
    class Continuation
    {
    public:
      Continuation(const MovingSurface &surface, const TetMesh &mesh) : surface_(surface), mesh_(mesh)
      {
        std::vector<bool> moves(mesh.n_nodes(), false);
        for (const NodeIndex k : surface.nodes)
          moves[k] = true;
        for (unsigned int i = 0; i < 3; ++i)
        {
          std::vector<bool> given = moves;
          for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
            for (const Vec3 &normal : surface.planes[k])
              given[k] = given[k] || surface.fixed[k] || std::abs(normal[i]) > aligned;
          factorise(given, i);
        }
      }

      NodalVectors<double> operator()(const std::vector<double> &mode) const
      {
        NodalVectors<double> d(mesh_.n_nodes());
        for (unsigned int i = 0; i < 3; ++i)
        {
          dealii::Vector<double> x(mesh_.n_nodes());
          for (std::size_t s = 0; s < surface_.n(); ++s)
            x(surface_.nodes[s]) = mode[s] * surface_.direction[s][i];
          solver_[i].solve(x);
          for (NodeIndex k = 0; k < mesh_.n_nodes(); ++k)
            d[k][i] = x(k);
        }
        // Planes that are not along an axis.
        for (NodeIndex k = 0; k < mesh_.n_nodes(); ++k)
          d[k] = surface_.fixed[k] ? Vec3() : projected(d[k], surface_.planes[k]);
        return d;
      }

    private:
      void factorise(const std::vector<bool> &given, const unsigned int component)
      {
        const NodeIndex                n = mesh_.n_nodes();
        dealii::DynamicSparsityPattern rows(n, n);
        for (NodeIndex k = 0; k < n; ++k)
          rows.add(k, k);
        for (const auto &cell : mesh_.cells)
          for (const NodeIndex a : cell)
            if (!given[a])
              for (const NodeIndex b : cell)
                rows.add(a, b);
        dealii::SparsityPattern pattern;
        pattern.copy_from(rows);
        dealii::SparseMatrix<double> K(pattern);
        for (NodeIndex k = 0; k < n; ++k)
          if (given[k])
            K.set(k, k, 1.);
        for (const auto &cell : mesh_.cells)
        {
          const auto geometry = cell_geometry(corners(cell, mesh_.X));
          for (unsigned int a = 0; a < 4; ++a)
            if (!given[cell[a]])
              for (unsigned int b = 0; b < 4; ++b)
                K.add(cell[a], cell[b], geometry.volume * (geometry.g[a] * geometry.g[b]));
        }
        solver_[component].factorize(K);
      }

      const MovingSurface                               &surface_;
      const TetMesh                                     &mesh_;
      mutable std::array<dealii::SparseDirectUMFPACK, 3> solver_;
    };
  } // namespace

  std::vector<ShapeParameter> free_form_shapes(const FreeFormParameters &parameters, const TetMesh &mesh)
  {
    std::vector<ShapeParameter> shapes;
    if (parameters.modes == 0)
      return shapes;
    check(parameters, mesh);
    const MovingSurface   surface(parameters, mesh);
    constexpr std::size_t most = 4000; // the modes of a surface are found in a full matrix
    if (surface.n() < parameters.modes || surface.n() > most)
      throw Error("Billet/free form modes",
                  "is " + std::to_string(parameters.modes) + ", and the patches have " +
                    std::to_string(surface.n()) + " nodes",
                  "there are as many modes as nodes, of which there may be " + std::to_string(most),
                  surface.n() > most ? "name fewer patches or use larger elements" : "ask for fewer modes");
    double volume = 0.;
    for (const auto &cell : mesh.cells)
      volume += tet_volume(corners(cell, mesh.X));
    const Continuation continued(surface, mesh);
    for (const std::vector<double> &mode : modes_of(surface, mesh, parameters))
      shapes.push_back(
        {"free form " + std::to_string(shapes.size() + 1), "mm", 0., std::cbrt(volume), continued(mode)});
    return shapes;
  }
} // namespace retroforge
