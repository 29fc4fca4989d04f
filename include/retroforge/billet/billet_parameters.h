// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/base/parameter_handler.h>

#include <retroforge/billet/ring_profile.h>
#include <retroforge/billet/spline_profile.h>
#include <retroforge/core/choice.h>
#include <retroforge/geometry/rotations.h>
#include <retroforge/mesh/tet_mesh.h>

#include <string>
#include <vector>

namespace retroforge
{
  /// Smooth moves of patches along their normals: design/free_form.h.
  struct FreeFormParameters
  {
    unsigned int             modes = 0;
    std::vector<std::string> patches;
    double                   length = 0.; ///< l [mm]; 0: a quarter of the root of the patches' area
  };

  /// The workpiece before forging: its shape, its symmetry, its position, and the fineness of its mesh. The
  /// section Billet.
  struct BilletParameters
  {
    enum class Shape
    {
      box,
      cylinder,
      ring,    ///< a body of revolution whose section has seven portions
      profile, ///< a body of revolution whose contour is a B-spline
      file     ///< a mesh from a Gmsh file
    };

    Shape  shape = Shape::box;
    Vec3   base_centre;
    Vec3   size         = Vec3({50, 50, 50});
    double radius       = 25;
    double height       = 50;
    double element_size = 5;

    RingProfile   ring;
    SplineProfile profile;

    std::vector<Vec3> symmetry_planes;
    std::string       symmetry_point = "base";
    double            sector_angle   = 0;

    std::string              file_name;
    double                   scale = 1; ///< factor of the file's lengths to mm
    std::vector<std::string> symmetry_patches;

    Rotations rotations; ///< rotations of the finished mesh
    Vec3      translation;

    FreeFormParameters free_form;

    std::string volume_held_by; ///< name of a parameter of the shape, without `billet/`; none if empty

    void          add_parameters(dealii::ParameterHandler &prm);
    void          check() const;
    static ReadBy read_by_shape();

    /// Returns the word for the shape in a parameter file.
    std::string shape_word() const;

    bool is_from_file() const { return shape == Shape::file; }
    /// Returns whether the body has a section that is revolved.
    bool   is_revolved() const { return shape == Shape::ring || shape == Shape::profile; }
    double whole_height() const; ///< before cuts; 0 for a mesh from a file
    double whole_width() const;  ///< along x, before cuts; 0 for a mesh from a file
    /// Returns whether only a sector of a body of revolution is kept.
    bool is_sector() const;
    /// Planes of the sector's faces, if any.
    std::vector<Plane> sector_planes() const;
    /// Planes of the cuts before rotation and translation: those of the sector, then those listed.
    std::vector<Plane> symmetry_cuts() const;
  };
} // namespace retroforge
