// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/geometry/triangle_surface.h>

#include <string>
#include <vector>

/// @file
/// Dies made from a few numbers: a flat face z = 0 with a cavity below it, open towards +z, where the
/// workpiece is; or a punch, whose flat end is that face. Templated on the number type, so that vertices come
/// with their derivatives in the shape's parameters; how many vertices there are follows from the values
/// alone.
///
/// All are one construction: rings around the z axis. A ring is the cavity's outline in plan, moved inwards
/// by o at depth z, and (o, z) runs along a profile: flat face, rounded edge, drafted wall, fillet, flat
/// floor; of a punch end, edge and side. Halves of a sector are mirror images, so that a die cut by its
/// planes of symmetry is the whole one.
namespace retroforge
{
  /// Vertices and facets, as TriangleSurface takes them.
  template <typename Number>
  struct ShapeMesh
  {
    NodalVectors<Number>  vertices;
    std::vector<Triangle> triangles;
  };

  /// A number of a shape: its name in parameter files and its meaning.
  struct Measure
  {
    std::string name, meaning, unit;
    double      value = 0.;
  };

  /// Base of shapes that are defined by measures alone, without a count as of teeth.
  struct NoCounts
  {
    template <typename Self, typename F>
    static void for_each_count(Self &, const F &)
    {
    }
  };

  /// The section of a cavity.
  template <typename Number>
  struct CavityProfile
  {
    Number depth  = 9.5; ///< depth of the floor below the face [mm]
    Number draft  = 7.;  ///< angle of the wall against the z axis [degrees]
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
  struct TripodShape : NoCounts
  {
    Number                hub    = 24.; ///< radius [mm]
    Number                width  = 24.; ///< width of an arm, whose end is a half circle [mm]
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
  struct BellShape : NoCounts
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

  /// A spur gear with straight flanks, a tooth's middle on the x axis. A flank is inclined against the radius
  /// through the tooth's middle, so that a tooth gets narrower outwards. Plan measures hold where the wall,
  /// prolonged, meets the face; the roundings in plan keep their radii down the wall. The defaults are those
  /// of a gear of 10 teeth made from a ring of radius 25.5 and height 45 crushed by 21; the wall is deeper
  /// than the ring is high, for a die that slides along the lower tool. @cite Laroussi2003, Fig. 29, whose
  /// measures are not published
  template <typename Number>
  struct GearShape
  {
    unsigned int teeth     = 10;
    Number       root      = 25.8; ///< radius between the teeth [mm]
    Number       tip       = 38.9; ///< radius of the teeth's ends [mm]
    Number       reference = 31.5; ///< radius at which a tooth's angle is measured [mm]
    Number       tooth     = 18.;  ///< angle that a tooth takes there [degrees]
    Number       flank = 15.; ///< angle of a flank against the radius through the tooth's middle [degrees]
    Number       root_round = 2.;  ///< radius in plan at a tooth's foot [mm]
    Number       tip_round  = 1.5; ///< radius in plan at a tooth's end [mm]
    Number       outer      = 55.; ///< radius of the face [mm]
    CavityProfile<Number> profile{46., 0., 0.5, 1.5};

    static const char *section() { return "Gear"; } ///< in parameter files

    template <typename Self, typename F>
    static void for_each_count(Self &self, const F &f)
    {
      f("teeth", "Number of teeth.", self.teeth);
    }

    template <typename Self, typename F>
    static void for_each_measure(Self &self, const F &f)
    {
      f(Measure{"root radius", "Between the teeth, in the plane of the face.", "mm"}, self.root);
      f(Measure{"tip radius", "Of the teeth's ends, in the plane of the face.", "mm"}, self.tip);
      f(Measure{"reference radius", "At which a tooth's angle is measured.", "mm"}, self.reference);
      f(Measure{"tooth angle", "That a tooth takes at the reference radius.", "degrees"}, self.tooth);
      f(Measure{"flank angle", "Of a flank against the radius through the tooth's middle.", "degrees"},
        self.flank);
      f(Measure{"root rounding", "Radius in plan at a tooth's foot.", "mm"}, self.root_round);
      f(Measure{"tip rounding", "Radius in plan at a tooth's end.", "mm"}, self.tip_round);
      f(Measure{"outer radius", "Of the face.", "mm"}, self.outer);
      CavityProfile<Number>::for_each_measure(self.profile, f);
    }
  };

  /// A round punch, or with its side alone at work a mandrel: its flat end is z = 0, its body below. The
  /// radius holds where the side, prolonged, meets the end.
  template <typename Number>
  struct PunchShape : NoCounts
  {
    Number radius = 10.; ///< [mm]
    Number length = 60.; ///< length of the side along the axis [mm]
    Number draft = 0.; ///< angle of the side against the axis, wider with the distance from the end [degrees]
    Number edge  = 1.; ///< radius of the edge between end and side [mm]

    static const char *section() { return "Punch"; } ///< in parameter files

    template <typename Self, typename F>
    static void for_each_measure(Self &self, const F &f)
    {
      f(Measure{"radius", "In the plane of its end.", "mm"}, self.radius);
      f(Measure{"length", "Of its side, along the axis.", "mm"}, self.length);
      f(Measure{"draft angle", "Of its side against the axis.", "degrees"}, self.draft);
      f(Measure{"edge radius", "Between end and side.", "mm"}, self.edge);
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
  shape_mesh(const std::string &where, const TripodShape<Number> &, double chord_error, Segments &);

  template <typename Number>
  ShapeMesh<Number>
  shape_mesh(const std::string &where, const BellShape<Number> &, double chord_error, Segments &);

  template <typename Number>
  ShapeMesh<Number>
  shape_mesh(const std::string &where, const GearShape<Number> &, double chord_error, Segments &);

  template <typename Number>
  ShapeMesh<Number>
  shape_mesh(const std::string &where, const PunchShape<Number> &, double chord_error, Segments &);

  template <template <typename> class Shape, typename Number>
  ShapeMesh<Number> shape_mesh(const std::string &where, const Shape<Number> &shape, const double chord_error)
  {
    Segments segments;
    return shape_mesh(where, shape, chord_error, segments);
  }
} // namespace retroforge
