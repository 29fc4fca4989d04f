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

#include <mpi.h>

namespace retroforge
{
  /// Smooth moves of patches along their normals: design/free_form.h.
  struct FreeFormParameters
  {
    unsigned int             modes = 0;
    std::vector<std::string> patches;
    double                   length = 0.; ///< l [mm]; 0: a quarter of the root of the patches' area
  };

  /// The workpiece before forging: its shape, what symmetry leaves of it, where it stands, and how fine its
  /// mesh is.
  struct BilletParameters
  {
    std::string shape = "box";
    Vec3        base_centre;
    Vec3        size         = Vec3({50, 50, 50});
    double      radius       = 25;
    double      height       = 50;
    double      element_size = 5;

    RingProfile   ring;
    SplineProfile profile;

    std::vector<Vec3> symmetry_planes;
    std::string       symmetry_point = "base";
    double            sector_angle   = 0;

    std::string              file_name;
    double                   scale = 1; ///< of the file's lengths to mm
    std::vector<std::string> symmetry_patches;

    Rotations rotations; ///< of the finished mesh
    Vec3      translation;

    FreeFormParameters free_form;

    std::string volume_held_by; ///< name of a parameter of the shape, without `billet/`; none if empty

    void          add_parameters(dealii::ParameterHandler &prm);
    void          check() const;
    static ReadBy read_by_shape();

    bool   is_revolved() const { return shape == "ring" || shape == "profile"; }
    double whole_height() const; ///< before cuts; 0 for a mesh from a file
    double whole_width() const;  ///< along x, before cuts; 0 for a mesh from a file
    /// Planes of the cuts before rotation and translation: those of the sector, then those listed.
    std::vector<Plane> symmetry_cuts() const;
  };

  /// Makes or reads the mesh of the billet on rank 0 and gives it to all ranks: checked with check_mesh(),
  /// numbered with renumber(), nodes on planar patches on their plane to rounding. Collective.
  ///
  /// Patches of a box: `bottom`, `top`, `side -x`, `side +x`, `side -y`, `side +y`; of a cylinder: `bottom`,
  /// `top`, `side`; of a ring or profile: `bottom`, `top`, `side inner`, `side outer`, and of a ring `edge
  /// top outer`, `edge bottom outer`, `edge bottom inner`; then `symmetry 1`, ... with their planes: first
  /// those of the sector, then those listed. Patches of which the cuts leave nothing are absent. The names
  /// tell directions before the final rotation.
  TetMesh make_billet(const BilletParameters &parameters, MPI_Comm communicator);

  /// Moves the nodes of the faces of a mesh onto the shape that the measures give, each by the shortest way
  /// onto all patches it belongs to. Of the mesh faces and patches count, which are those of make_billet().
  /// Of a billet from a file nothing moves.
  void snap_to_shape(const BilletParameters &parameters, TetMesh &mesh);

  /// What the measures and cuts of a billet that is not from a file bound: more than its mesh where that has
  /// chords for round sides. To be called on one rank only.  Units: mm^3.  @throws Error
  double shape_volume(const BilletParameters &parameters);
} // namespace retroforge
