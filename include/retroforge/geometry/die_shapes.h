// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/geometry/triangle_surface.h>

#include <string>
#include <vector>

/// @file
/// Dies made from a few numbers: a flat face z = 0 with a cavity below it, open towards +z, where the
/// workpiece is. Templated on the number type, so that vertices come with their derivatives in the shape's
/// parameters; how many vertices there are follows from the values alone.
///
/// All are one construction: rings around the z axis. A ring is the cavity's outline in plan, moved inwards
/// by o at depth z, and (o, z) runs along a profile: flat face, rounded edge, drafted wall, fillet, flat
/// floor. Halves of a sector are mirror images, so that a die cut by its planes of symmetry is the whole one.
namespace retroforge
{
  /// Vertices and facets, as TriangleSurface takes them.
  template <typename Number>
  struct ShapeMesh
  {
    NodalVectors<Number>  vertices;
    std::vector<Triangle> triangles;
  };

  /// What users call a number of a shape, and what it means.
  struct Measure
  {
    std::string name, meaning, unit;
    double      value = 0.;
  };

  /// What a cavity looks like in section.
  template <typename Number>
  struct CavityProfile
  {
    Number depth  = 9.5; ///< of the floor below the face [mm]
    Number draft  = 7.;  ///< of the wall against the z axis [degrees]
    Number edge   = 2.;  ///< radius of the edge between face and wall [mm]
    Number fillet = 2.;  ///< radius between wall and floor [mm]

    /// f(measure, number) of each.
    template <typename Self, typename F>
    static void for_each_measure(Self &self, const F &f)
    {
      f(Measure{"depth", "Of the floor below the face.", "mm"}, self.depth);
      f(Measure{"draft angle", "Of the wall against the axis.", "degrees"}, self.draft);
      f(Measure{"edge radius", "Between face and wall.", "mm"}, self.edge);
      f(Measure{"fillet radius", "Between wall and floor.", "mm"}, self.fillet);
    }
  };

  /// A hub with three arms at 0, 120 and 240 degrees from the x axis. Plan measures hold where the wall,
  /// prolonged, meets the face. The defaults, of upper and lower die together, take up a billet of radius 20
  /// and height 60 crushed by 40: floors 20 apart, faces 1 apart.
  template <typename Number>
  struct TripodShape
  {
    Number                hub    = 24.; ///< radius [mm]
    Number                width  = 24.; ///< of an arm, whose end is a half circle [mm]
    Number                length = 56.; ///< from the axis to the end of an arm [mm]
    Number                corner = 8.;  ///< radius in plan between hub and arm [mm]
    Number                outer  = 80.; ///< radius of the face [mm]
    CavityProfile<Number> profile;

    static const char *section() { return "Tripod"; } ///< in parameter files

    template <typename Self, typename F>
    static void for_each_measure(Self &self, const F &f)
    {
      f(Measure{"hub radius", "In the plane of the face.", "mm"}, self.hub);
      f(Measure{"arm width", "In the plane of the face.", "mm"}, self.width);
      f(Measure{"arm length", "From the axis to the round end of an arm.", "mm"}, self.length);
      f(Measure{"corner radius", "In plan, between hub and arm.", "mm"}, self.corner);
      f(Measure{"outer radius", "Of the face.", "mm"}, self.outer);
      CavityProfile<Number>::for_each_measure(self.profile, f);
    }
  };

  /// A bell: a body of revolution around the z axis.
  template <typename Number>
  struct BellShape
  {
    Number                mouth = 60.; ///< radius where the wall, prolonged, meets the face [mm]
    Number                outer = 90.; ///< radius of the face [mm]
    CavityProfile<Number> profile{60., 25., 8., 12.};

    static const char *section() { return "Bell"; } ///< in parameter files

    template <typename Self, typename F>
    static void for_each_measure(Self &self, const F &f)
    {
      f(Measure{"mouth radius", "In the plane of the face.", "mm"}, self.mouth);
      f(Measure{"outer radius", "Of the face.", "mm"}, self.outer);
      CavityProfile<Number>::for_each_measure(self.profile, f);
    }
  };

  /// Into how many segments the arcs of a shape are divided, in the order in which they are asked for. A
  /// shape that is varied keeps the numbers of the one it comes from, and with them its triangles.
  class Segments
  {
  public:
    /// Segments of an arc whose chords stay within `error` of it; or what was answered the time before.
    unsigned int operator()(double radius, double angle, double error);

    /// The next shape has the same numbers.
    void again() { next_ = 0; }

  private:
    std::vector<unsigned int> n_;
    std::size_t               next_ = 0;
  };

  /// @param chord_error  largest distance of facets from the smooth shape [mm]
  /// @throws Error  whose place begins with `where`, when the measures do not fit each other
  template <typename Number>
  ShapeMesh<Number>
  make_tripod(const std::string &where, const TripodShape<Number> &, double chord_error, Segments &);

  template <typename Number>
  ShapeMesh<Number>
  make_bell(const std::string &where, const BellShape<Number> &, double chord_error, Segments &);

  template <typename Number>
  ShapeMesh<Number>
  make_tripod(const std::string &where, const TripodShape<Number> &shape, const double chord_error)
  {
    Segments segments;
    return make_tripod(where, shape, chord_error, segments);
  }

  template <typename Number>
  ShapeMesh<Number>
  make_bell(const std::string &where, const BellShape<Number> &shape, const double chord_error)
  {
    Segments segments;
    return make_bell(where, shape, chord_error, segments);
  }
} // namespace retroforge
