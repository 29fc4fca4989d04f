// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/patterns.h>

#include <retroforge/billet/billet_parameters.h>
#include <retroforge/billet/fineness.h>
#include <retroforge/core/enum_setting.h>
#include <retroforge/core/error.h>
#include <retroforge/core/setting_tags.h>

#include <cmath>

namespace retroforge
{
  namespace
  {
    using Shape = BilletParameters::Shape;

    const EnumWords<Shape> shape_words = {{"box", Shape::box},
                                          {"cylinder", Shape::cylinder},
                                          {"ring", Shape::ring},
                                          {"profile", Shape::profile},
                                          {"file", Shape::file}};

    void check_positive(const std::string &name, const double value)
    {
      if (!(value > 0) || !std::isfinite(value))
        throw Error("Billet/" + name,
                    "is " + as_text(value) + " but must be > 0",
                    "lengths are positive",
                    "give the length in the unit of the case, mm as a rule");
    }

    void check_profile(const BilletParameters &p)
    {
      if (p.shape == Shape::ring)
        if (const std::string complaint = p.ring.complaint(p.ring.mu); !complaint.empty())
          throw Error("Billet",
                      complaint,
                      "no portion of the ring's contour may vanish, and radii and heights are positive",
                      "see the sketch of the ring in doc/theory/billet_shapes.md");
      if (p.shape == Shape::profile)
        if (const std::string complaint = p.profile.complaint(p.profile.control_points); !complaint.empty())
          throw Error("Billet/control points",
                      complaint,
                      "the contour runs upwards around the inner line, and each ray from there meets it once",
                      "write for example `20, 0; 26, 15; 26, 30; 20, 45'");
      if (p.shape == Shape::profile && p.profile.control_points.front()[1] != 0.)
        throw Error("Billet/control points",
                    "the first has z = " + as_text(p.profile.control_points.front()[1]),
                    "z counts from the base, where the contour begins",
                    "shift all z by the same amount, and the body by `base centre'");
    }

    Vec3 centre_of_base_or_body(const BilletParameters &p)
    {
      const Vec3 half_way({0, 0, p.whole_height() / 2});
      return p.symmetry_point == "centre" ? p.base_centre + half_way : p.base_centre;
    }

    Vec3 parse_symmetry_point(const BilletParameters &p)
    {
      if (p.symmetry_point == "base" || p.symmetry_point == "centre")
        return centre_of_base_or_body(p);
      try
      {
        return dealii::Patterns::Tools::Convert<Vec3>::to_value(p.symmetry_point);
      }
      catch (const std::exception &)
      {
        throw Error("Billet/symmetry point",
                    "is `" + p.symmetry_point + "'",
                    "it must be base, centre or three coordinates",
                    "write for example `0, 0, 25'");
      }
    }

    // Whole turns are exact for quarters and halves, so that planes on the axes have normals without
    // rounding.
    Vec3 sector_end_normal(const double degrees)
    {
      if (degrees == 90)
        return Vec3({-1, 0, 0});
      const double angle = degrees * M_PI / 180;
      return Vec3({-std::sin(angle), std::cos(angle), 0});
    }

    void check_symmetry(const BilletParameters &p)
    {
      if (p.is_from_file() && (!p.symmetry_planes.empty() || p.is_sector()))
        throw Error("Billet/symmetry planes",
                    "the shape is `file', and symmetry planes or a sector angle are given",
                    "a mesh from a file is not cut",
                    "name its planes in `symmetry patches'");
      if (p.shape != Shape::cylinder && !p.is_revolved() && p.is_sector())
        throw Error("Billet/sector angle",
                    "is " + as_text(p.sector_angle) + ", and the shape is `" + p.shape_word() + "'",
                    "only bodies of revolution have sectors",
                    "set it to 0, or use symmetry planes");
      if (p.is_sector() && !(p.sector_angle > 0 && p.sector_angle <= 180))
        throw Error("Billet/sector angle",
                    "is " + as_text(p.sector_angle),
                    "it must be in (0, 180], or 0 or 360 for the whole body",
                    "choose the smallest sector that symmetry allows");
      for (const Vec3 &normal : p.symmetry_planes)
        if (!(normal.norm() > 0) || !std::isfinite(normal.norm()))
          throw Error("Billet/symmetry planes",
                      "a normal has length " + as_text(normal.norm()),
                      "outward normals need a direction",
                      "write for example `-1, 0, 0; 0, -1, 0' to keep x >= 0, y >= 0");
      const auto planes = p.symmetry_cuts();
      for (std::size_t i = 0; i < planes.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
          if ((planes[i].normal - planes[j].normal).norm() < 1e-6)
            throw Error("Billet/symmetry planes",
                        "planes " + std::to_string(j + 1) + " and " + std::to_string(i + 1) + " are parallel",
                        "each symmetry plane is given once (those of the sector angle come first)",
                        "remove one of them");
    }

    // Far more than this machine holds is a slip of the pen.
    void check_fineness(const BilletParameters &p)
    {
      const double n_cells = expected_cells(p);
      if (n_cells > 1e8)
        throw Error("Billet/element size",
                    "is " + as_text(p.element_size) + ", which makes about " + as_text(n_cells) +
                      " tetrahedra",
                    "a mesh may have 1e8, some 360 GB in memory",
                    "choose a larger element size");
    }
  } // namespace

  std::string BilletParameters::shape_word() const
  {
    return word_of(shape, shape_words);
  }

  double BilletParameters::whole_height() const
  {
    return shape == Shape::box        ? size[2]
           : shape == Shape::cylinder ? height
           : shape == Shape::ring     ? ring.mu[0]
           : shape == Shape::profile  ? profile.height()
                                      : 0.;
  }

  double BilletParameters::whole_width() const
  {
    return shape == Shape::cylinder  ? 2 * radius
           : shape == Shape::ring    ? 2 * ring.mu[3]
           : shape == Shape::profile ? profile.width()
           : shape == Shape::box     ? size[0]
                                     : 0.;
  }

  bool BilletParameters::is_sector() const
  {
    return sector_angle != 0 && sector_angle != 360;
  }

  std::vector<Plane> BilletParameters::sector_planes() const
  {
    std::vector<Plane> planes;
    if (is_sector())
      planes.push_back({base_centre, Vec3({0, -1, 0})});
    if (is_sector() && sector_angle < 180)
      planes.push_back({base_centre, sector_end_normal(sector_angle)});
    return planes;
  }

  std::vector<Plane> BilletParameters::symmetry_cuts() const
  {
    std::vector<Plane> planes = sector_planes();
    const Vec3         point  = parse_symmetry_point(*this);
    for (const Vec3 &normal : symmetry_planes)
      planes.push_back({point, normal / normal.norm()});
    return planes;
  }

  void BilletParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    using namespace dealii::Patterns;
    prm.enter_subsection("Billet");
    add_enum(
      prm,
      "shape",
      shape,
      shape_words,
      "What the billet is: a box, a cylinder, a ring (its section has seven portions, see mu1 to mu4), a "
      "profile (a body of revolution whose contour is a B-spline), all standing along z, or a mesh from a "
      "file. Units: none.");
    prm.add_parameter(
      "base centre",
      base_centre,
      "Centre of the base; for a profile the point on the axis its z counts from. Units: mm.");
    prm.add_parameter("size", size, "Lengths of the whole box along x, y and z, before cuts. Units: mm.");
    prm.add_parameter("radius", radius, "Radius of the cylinder. Units: mm.", Double(0));
    prm.add_parameter("height", height, "Height of the whole cylinder, before cuts. Units: mm.", Double(0));
    prm.add_parameter("element size",
                      element_size,
                      "Wanted length of the edges of the mesh, unless it comes from a file. Units: mm.",
                      Double(0));
    ring.add_parameters(prm);
    profile.add_parameters(prm);
    prm.add_parameter(
      "symmetry planes",
      symmetry_planes,
      "Outward normals of the symmetry planes that cut the body, separated by semicolons: "
      "`-1, 0, 0; 0, -1, 0' keeps x >= 0, y >= 0. They need not have length one. Units: none.");
    prm.add_parameter(
      "symmetry point",
      symmetry_point,
      "Point all symmetry planes pass through: `base' for the centre of the base, `centre' for the "
      "centre of the whole body, or three coordinates. Units: mm.");
    prm.add_parameter(
      "sector angle",
      sector_angle,
      "Angle of the sector of a body of revolution that is kept, from the direction +x of its axis "
      "towards +y, in (0, 180]; 0 or 360 for the whole body. The faces of the sector "
      "are symmetry planes. Units: degrees.",
      Double(0, 360));
    prm.add_parameter(
      "file name",
      file_name,
      "Gmsh file (.msh, versions 2 and 4) for the shape `file', found as STL files of dies are. Its physical "
      "surfaces become the patches. Units: none.");
    prm.add_parameter("scale", scale, "Factor to mm of the file's lengths. Units: none.", Double(1e-300));
    prm.add_parameter(
      "symmetry patches",
      symmetry_patches,
      "Names or numbers of the physical surfaces of the file that are symmetry planes. Units: none.");
    prm.add_parameter("rotation axis",
                      rotations.axis,
                      "Axis through the origin about which the finished mesh is rotated. Units: none.");
    prm.add_parameter("rotation angle",
                      rotations.angle,
                      "Angle of this rotation, counter-clockwise seen against the axis. Units: degrees.",
                      Double(-360, 360));
    rotations.add_list(prm, "Rotations of the finished mesh,");
    prm.add_parameter(
      "translation", translation, "Displacement of the finished mesh, after the rotation. Units: mm.");
    prm.add_parameter("free form modes",
                      free_form.modes,
                      "How many smooth moves of patches along their normals become parameters of the shape, "
                      "`billet/free form 1' and so on, from the smoothest on; `billet/free form' in "
                      "Design/parameters stands for all. 0 for none. Units: none.",
                      Integer(0, 4000));
    prm.add_parameter("free form patches",
                      free_form.patches,
                      "The patches that move. Others that are plane stay so, and their nodes slide; the rest "
                      "stays. Units: none.");
    prm.add_parameter("free form length",
                      free_form.length,
                      "Moves that change over less than this count more: the length of their Sobolev norm; "
                      "0 for a quarter of the root of the patches' area. Units: mm.",
                      Double(0.));
    prm.add_parameter("volume held by",
                      volume_held_by,
                      "Parameter of the shape that is no design parameter but follows from the others, so "
                      "that the volume of the mesh stays: for example mu4 for a ring, radius for a cylinder, "
                      "`control point 2 r' for a profile. Empty for none. Units: none.");
    prm.leave_subsection();
    tag(prm, "Billet", SettingRole::scene);
    tag(prm, "Billet/file name", SettingTags::Files::one);
    tag(prm, "Billet/shape", read_by_shape());
  }

  ReadBy BilletParameters::read_by_shape()
  {
    return {{"box", {"base centre", "size", "element size", "symmetry point"}},
            {"cylinder", {"base centre", "radius", "height", "element size", "symmetry point"}},
            {"ring",
             {"base centre",
              "mu1",
              "mu2",
              "mu3",
              "mu4",
              "bore radius",
              "base inner radius",
              "base outer radius",
              "inner edge height",
              "outer edge height",
              "element size",
              "symmetry point"}},
            {"profile", {"base centre", "control points", "inner radius", "element size", "symmetry point"}},
            {"file", {"file name", "scale", "symmetry patches"}}};
  }

  void BilletParameters::check() const
  {
    if (shape == Shape::box)
      for (unsigned int d = 0; d < 3; ++d)
        check_positive("size", size[d]);
    if (shape == Shape::cylinder)
    {
      check_positive("radius", radius);
      check_positive("height", height);
    }
    if (is_revolved())
      check_profile(*this);
    check_symmetry(*this);
    if (!is_from_file())
    {
      check_positive("element size", element_size);
      check_fineness(*this);
    }
    if (is_from_file() && file_name.empty())
      throw Error("Billet/file name", "is empty", "the shape `file' needs a mesh", "name a .msh file");
    if (!is_from_file() && !symmetry_patches.empty())
      throw Error("Billet/symmetry patches",
                  "are given, and the shape is `" + shape_word() + "'",
                  "symmetry patches are for meshes from a file",
                  "use symmetry planes");
    rotations.check("Billet");
  }
} // namespace retroforge
