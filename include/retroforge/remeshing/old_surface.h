// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/remeshing/remeshing_parameters.h>
#include <retroforge/remeshing/surface_features.h>
#include <retroforge/remeshing/tape_writer.h>
#include <retroforge/remeshing/triangle_tree.h>

#include <array>
#include <vector>

namespace retroforge
{
  /// The boundary before remeshing, as the smooth surface its faces stand for: new surface nodes are put on
  /// it.
  ///
  /// A point goes to the closest point x = sum lambda_i x_i of the old region (or of the old ridge curve),
  /// and is lifted off the chord by half the Phong tessellation (Boubekeur and Alexa 2008),
  ///   x + 1/2 sum lambda_i (n_i·(x_i - x)) n_i,
  /// exact to second order in the edge length for surfaces with nodal normals n_i; on ridges the projection
  /// onto the plane of n_i is replaced by that onto the tangent line. Then it leaves the dies, and is put on
  /// the symmetry planes of its region or curve, to rounding.
  class OldSurface
  {
  public:
    /// Keeps references to the mesh and its features.
    OldSurface(const TetMesh              &mesh,
               const NodalVectors<double> &X,
               const SurfaceFeatures      &features,
               PushOut                     push_out);

    /// Puts a point on a region, or on a ridge curve.
    Vec3 on_region(unsigned int region, const Vec3 &x) const;
    Vec3 on_curve(unsigned int curve, const Vec3 &x) const;

    /// Write the same for a vector of a tape. What surface there was is where the nodes were when the pass began.
    TapeWriter::Slot write_on_region(unsigned int region, TapeWriter::Slot x, TapeWriter &tape) const;
    TapeWriter::Slot write_on_curve(unsigned int curve, TapeWriter::Slot x, TapeWriter &tape) const;

    /// Writes how a point is put on planes.
    static TapeWriter::Slot
    write_on_planes(TapeWriter::Slot x, const std::vector<Plane> &planes, TapeWriter &tape);

    /// Returns the depth of a point inside a die; 0 outside.
    double depth_in_dies(const Vec3 &x) const { return push_out_ ? (push_out_(x) - x).norm() : 0.; }

    /// The symmetry planes that a region or a ridge curve lies in.
    const std::vector<Plane> &planes_of_region(unsigned int region) const { return regions_[region].planes; }
    const std::vector<Plane> &planes_of_curve(unsigned int curve) const { return lines_[curve].planes; }

  private:
    struct Region
    {
      TriangleTree                     tree;
      std::vector<std::array<Vec3, 3>> corners;
      std::vector<std::array<Vec3, 3>> normals; ///< at the corners of each triangle
      std::vector<Plane>               planes;
      std::vector<unsigned int>        faces; ///< the triangles' numbers in the mesh
    };
    struct Line
    {
      NodalVectors<double> points;
      NodalVectors<double> tangents;
      std::vector<Plane>   planes;
      bool                 is_closed;
    };
    /// Where a point is put.
    struct LinePoint
    {
      std::size_t segment;
      double      t; ///< on it, 0 to 1
      Vec3        x;
    };

    void make_regions(const TetMesh &, const NodalVectors<double> &, const SurfaceFeatures &);
    void make_lines(const TetMesh &, const NodalVectors<double> &, const SurfaceFeatures &);
    Vec3 finish(const Vec3 &x, const std::vector<Plane> &planes) const;

    LinePoint closest_on_line(const Line &line, const Vec3 &x) const;
    TapeWriter::Slot
    write_finish(TapeWriter::Slot x, const std::vector<Plane> &planes, TapeWriter &tape) const;
    TapeWriter::Slot write_normal(unsigned int region, NodeIndex node, TapeWriter &tape) const;
    TapeWriter::Slot write_tangent(unsigned int curve, std::size_t i, TapeWriter &tape) const;

    const TetMesh                         &mesh_;
    const SurfaceFeatures                 &features_;
    std::vector<std::vector<unsigned int>> on_planes_; ///< symmetry planes at each node, by their patches
    std::vector<Region>                    regions_;
    std::vector<Line>                      lines_;
    PushOut                                push_out_;
  };

  /// The point next to x on up to two planes that are not parallel, to rounding. More planes, or parallel
  /// ones, leave x as it is.
  Vec3 snap_to_planes(Vec3 x, const std::vector<Plane> &planes);
} // namespace retroforge
