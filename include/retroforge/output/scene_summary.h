// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/types.h>
#include <retroforge/mesh/whole_part.h>

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace retroforge
{
  /// Billet and dies before the first increment, for people (`listing`) and programs (.json) to read. The
  /// format is described in doc/summary_schema.md; whoever changes a key changes `schema` and that page.
  ///
  /// What is unknown is NaN here and null in the file; what could not be made is absent in both.
  struct SceneSummary
  {
    static constexpr int    schema  = 1;
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

    using Corners = std::pair<Vec3, Vec3>; ///< lower and upper corner of a bounding box [mm]

    struct SymmetryPlane
    {
      std::string name;
      Vec3        point;  ///< [mm]
      Vec3        normal; ///< out of the billet, of length one
    };

    struct Billet
    {
      std::string  shape;
      Corners      extents;
      unsigned int n_nodes = 0, n_cells = 0;
      double       element_size  = unknown;                         ///< wanted away from dies [mm]
      double       shortest_edge = unknown, longest_edge = unknown; ///< of the surface [mm]
      double       smallest_angle  = unknown;                       ///< between two faces of a cell [degrees]
      double       volume          = unknown;                       ///< of the mesh [mm^3]
      double       volume_of_shape = unknown;                       ///< of the model, by its measures [mm^3]
      WholePart    whole;
      std::vector<std::pair<std::string, double>> patches; ///< names and areas [mm^2]
      std::vector<SymmetryPlane>                  symmetry_planes;
    };

    struct Die
    {
      std::string            name, shape;
      std::optional<Corners> extents; ///< not of a plane
      unsigned int           n_facets = 0;
      Vec3                   point, facing; ///< position of a plane, and its facing of length one
      Vec3                   velocity;      ///< [mm/s]
      Vec3                   travel;        ///< over the stroke [mm]
      double                 friction      = 0.;
      std::string            friction_name = "alpha"; ///< name of the coefficient in its law
      std::string            friction_law;            ///< empty: Norton's
      std::optional<double>  shear_limit;             ///< where the law has one
      struct Zone
      {
        std::string           name, friction_law, friction_name;
        double                friction = 0.;
        std::optional<double> shear_limit;
      };
      std::vector<Zone> zones; ///< where other friction holds
      bool              leads         = false;
      double            smallest_size = unknown; ///< smallest length of the edges wanted near it [mm]

      struct Place
      {
        double distance = unknown; ///< [mm]
        Vec3   place;              ///< position on the billet at the start [mm]
      };
      /// Planes of symmetry on whose inner side all of it stands: the whole part has its images beside it.
      std::vector<std::string> mirrored_by;

      /// The nearest point of the billet, at the start.
      Place  gap;
      bool   touches      = false;
      double contact_area = unknown; ///< area of the faces of the billet that it touches [mm^2]
      /// Part of the billet's side that faces a surface which it covers, as seen along the way of the press.
      double covered = unknown;
      /// The deepest point of the billet in it, or of it in the billet.
      std::optional<Place> overlap;
      bool                 is_of_die = false; ///< whether it is the latter
      Vec3                 frees;             ///< the travel of the die that ends the overlap [mm]

      /// For a die that moves: its own path until it touches the billet in its initial position, and the
      /// place; unknown where it does not within the stroke.
      Place  first_touch;
      double stroke_at_touch = unknown; ///< of the leading die, then [mm]
      bool   moves_away      = false;   ///< it would touch the billet if it went back
    };

    struct Metal
    {
      double consistency = unknown, rate_sensitivity = unknown; ///< K [MPa s^m], m
    };

    struct Press
    {
      std::string  leading_die;
      double       stroke = unknown, seconds = unknown; ///< [mm], [s]
      unsigned int increments = 0;
      bool         is_free    = false; ///< whether the increments are the program's choice
    };

    /// Estimates to a factor of two, without any forging.
    struct Estimate
    {
      std::string name;                                   ///< name of the method
      double      speed = unknown, strain_rate = unknown; ///< at which the dies close [mm/s], [1/s]
      double      stress = unknown;                       ///< stress of the metal at that rate [MPa]
      /// Force where the dies first press, whole part [N].
      double first_force = unknown;
      double final_force = unknown; ///< after the stroke, whole part [N]
    };

    std::string              case_file, version, commit;
    std::vector<std::string> refusals; ///< as a run would tell them; none: it would begin
    std::vector<std::string> warnings;

    std::optional<Billet>   billet;
    std::vector<Die>        dies; ///< dies that could be made
    std::optional<Metal>    metal;
    std::optional<Press>    press;
    std::optional<Estimate> estimate;          ///< estimate for a sound scene
    double                  seconds = unknown; ///< time that the inspection took

    /// The text of the file.
    std::string to_json() const;

    /// In plain words, a line for each thing that one may want to know.
    std::string listing() const;
  };
} // namespace retroforge
