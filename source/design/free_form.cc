// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/nearest_name.h>
#include <retroforge/design/free_form.h>
#include <retroforge/design/surface_modes.h>
#include <retroforge/element/cell_geometry.h>
#include <retroforge/mesh/mesh_quality.h>

#include <deal.II/lac/dynamic_sparsity_pattern.h>
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

    /// The part of the billet's boundary that a free form moves.
    class MovingPatches
    {
    public:
      MovingPatches(const FreeFormParameters &parameters, const TetMesh &mesh);

      std::size_t n() const { return nodes.size(); }

      std::vector<NodeIndex>         nodes;     ///< that move
      NodalVectors<double>           direction; ///< of each
      MovingSurface                  surface;   ///< whose points are these nodes
      std::vector<std::vector<Vec3>> planes;    ///< normals of those that each node of the mesh keeps to
      std::vector<bool>              fixed;     ///< nodes of the mesh that stay

    private:
      void find_planes(const TetMesh &mesh, const std::vector<bool> &moves);
      void find_directions();
    };

    Vec3 face_vector(const TetMesh &mesh, const BoundaryFace &face)
    {
      return facet_vector(mesh.X[face.nodes[0]], mesh.X[face.nodes[1]], mesh.X[face.nodes[2]]);
    }

    MovingPatches::MovingPatches(const FreeFormParameters &parameters, const TetMesh &mesh)
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
          surface.triangles.emplace_back();
          for (unsigned int i = 0; i < 3; ++i)
          {
            const NodeIndex k = face.nodes[i];
            if (place[k] == invalid_index)
            {
              place[k] = nodes.size();
              nodes.push_back(k);
              surface.points.push_back(mesh.X[k]);
            }
            surface.triangles.back()[i] = place[k];
          }
        }
      find_planes(mesh, moves);
      find_directions();
    }

    void MovingPatches::find_planes(const TetMesh &mesh, const std::vector<bool> &moves)
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

    void MovingPatches::find_directions()
    {
      direction.assign(n(), Vec3());
      for (const Triangle &t : surface.triangles)
      {
        const Vec3 v = facet_vector(surface.points[t[0]], surface.points[t[1]], surface.points[t[2]]);
        for (const unsigned int s : t)
          direction[s] += v;
      }
      for (std::size_t s = 0; s < n(); ++s)
        direction[s] =
          fixed[nodes[s]] ? Vec3() : in_planes(direction[s] / direction[s].norm(), planes[nodes[s]]);
    }

    /// Laplace's equation inside, one component after the other.
    class Continuation
    {
    public:
      Continuation(const MovingPatches &patches, const TetMesh &mesh) : patches_(patches), mesh_(mesh)
      {
        std::vector<bool> moves(mesh.n_nodes(), false);
        for (const NodeIndex k : patches.nodes)
          moves[k] = true;
        for (unsigned int i = 0; i < 3; ++i)
        {
          std::vector<bool> given = moves;
          for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
            for (const Vec3 &normal : patches.planes[k])
              given[k] = given[k] || patches.fixed[k] || std::abs(normal[i]) > aligned;
          factorise(given, i);
        }
      }

      NodalVectors<double> operator()(const std::vector<double> &mode) const
      {
        NodalVectors<double> d(mesh_.n_nodes());
        for (unsigned int i = 0; i < 3; ++i)
        {
          dealii::Vector<double> x(mesh_.n_nodes());
          for (std::size_t s = 0; s < patches_.n(); ++s)
            x(patches_.nodes[s]) = mode[s] * patches_.direction[s][i];
          solver_[i].solve(x);
          for (NodeIndex k = 0; k < mesh_.n_nodes(); ++k)
            d[k][i] = x(k);
        }
        // Planes that are not along an axis.
        for (NodeIndex k = 0; k < mesh_.n_nodes(); ++k)
          d[k] = patches_.fixed[k] ? Vec3() : in_planes(d[k], patches_.planes[k]);
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

      const MovingPatches                               &patches_;
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
    const MovingPatches    patches(parameters, mesh);
    constexpr unsigned int most = most_moving_points;
    if (patches.n() < parameters.modes || patches.n() > most)
      throw Error("Billet/free form modes",
                  "is " + std::to_string(parameters.modes) + ", and the patches have " +
                    std::to_string(patches.n()) + " nodes",
                  "there are as many modes as nodes, of which there may be " + std::to_string(most),
                  patches.n() > most ? "name fewer patches or use larger elements" : "ask for fewer modes");
    double volume = 0.;
    for (const auto &cell : mesh.cells)
      volume += tet_volume(corners(cell, mesh.X));
    const Continuation continued(patches, mesh);
    for (const std::vector<double> &mode :
         surface_modes(patches.surface, parameters.modes, parameters.length))
      shapes.push_back(
        {"free form " + std::to_string(shapes.size() + 1), "mm", 0., std::cbrt(volume), continued(mode)});
    return shapes;
  }
} // namespace retroforge
