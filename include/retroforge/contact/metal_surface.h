// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/billet/billet.h>
#include <retroforge/geometry/triangle_surface.h>

namespace retroforge
{
  /// The part of the workpiece's surface that dies can touch, as a body that distances are measured from.
  ///
  /// Symmetry planes end it: what lies beyond one is not looked at, and a point on one sees the surface go on
  /// there as its mirror image. Signs are those of pseudonormals (of a face; sum of both at an edge; weighted
  /// by the angles at a vertex), which on a plane of symmetry lose their part across it.
  class MetalSurface
  {
  public:
    MetalSurface(NodalVectors<double> vertices, std::vector<Triangle> triangles, std::vector<Plane> symmetry);

    const NodalVectors<double>  &vertices() const { return vertices_; }
    const std::vector<Triangle> &triangles() const { return triangles_; }
    std::array<Vec3, 3>          corners(const unsigned int triangle) const;
    const BoxTree               &tree() const { return tree_; }
    const BoundingBox           &box() const { return box_; }

    /// Lengths below this are rounding [mm].
    double rounding() const { return rounding_; }

    /// The closest point of the surface.
    struct Foot
    {
      double       distance; ///< negative inside of the metal [mm]
      Vec3         place;
      unsigned int triangle;
    };
    Foot closest(const Vec3 &x) const;

    /// Returns whether x lies beyond a plane of symmetry, by more than rounding.
    bool is_beyond(const Vec3 &x) const;

    /// Returns the part of a direction along all planes of symmetry; zero where only rounding is left.
    Vec3 along_symmetry(const Vec3 &direction) const;

    /// Returns the sagitta of a concave surface that turns as the facets do [mm]: the maximum over the edges
    /// of the triangle that turn inwards by up to 45 degrees, of height times angle over eight.
    double hollow(unsigned int triangle) const { return hollow_[triangle]; }

  private:
    using Edge = std::pair<unsigned int, unsigned int>; // the smaller vertex first

    Vec3 normal_at(unsigned int triangle, const std::array<double, 3> &weights) const;
    /// The part of a normal that its mirror images do not take away where the points are on planes.
    Vec3 mirrored(Vec3 normal, const std::vector<unsigned int> &vertices) const;

    NodalVectors<double>               vertices_;
    std::vector<Triangle>              triangles_;
    std::vector<Plane>                 symmetry_;
    double                             rounding_; ///< rounding error of positions [mm]
    std::vector<Vec3>                  face_normals_, vertex_normals_;
    std::vector<std::pair<Edge, Vec3>> edge_normals_; ///< by edge, ascending
    std::vector<double>                hollow_;
    BoundingBox                        box_;
    BoxTree                            tree_;
  };

  /// Returns the surface of a mesh with its nodes at X.
  MetalSurface metal_surface(const TetMesh &mesh, const NodalVectors<double> &X);

  /// Returns the surface of a billet as its measures define it. The facets of a mesh are chords of a round
  /// side; this surface has finer ones with their corners on the defined shape, which follow it to
  /// `tolerance` [mm], as far as half a million of them can. For a billet from a file it is the surface of
  /// the mesh.
  /// @param mesh  as make_billet() made it       @param X  positions of its nodes, in the design
  MetalSurface billet_surface(const BilletParameters     &billet,
                              const TetMesh              &mesh,
                              const NodalVectors<double> &X,
                              double                      tolerance);
} // namespace retroforge
