// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/patterns.h>
#include <deal.II/base/utilities.h>

#include <retroforge/billet/billet.h>
#include <retroforge/billet/fineness.h>
#include <retroforge/billet/gmsh_mesher.h>
#include <retroforge/billet/length_unit.h>
#include <retroforge/billet/surface_slivers.h>
#include <retroforge/core/error.h>
#include <retroforge/geometry/triangle_surface.h>
#include <retroforge/mesh/broadcast.h>
#include <retroforge/mesh/mesh_checks.h>
#include <retroforge/mesh/renumber.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  namespace
  {
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
      if (p.shape == "ring")
        if (const std::string complaint = p.ring.complaint(p.ring.mu); !complaint.empty())
          throw Error("Billet",
                      complaint,
                      "no portion of the ring's contour may vanish, and radii and heights are positive",
                      "see the sketch of the ring in doc/theory/billet_shapes.md");
      if (p.shape == "profile")
        if (const std::string complaint = p.profile.complaint(p.profile.control_points); !complaint.empty())
          throw Error("Billet/control points",
                      complaint,
                      "the contour runs upwards around the inner line, and each ray from there meets it once",
                      "write for example `20, 0; 26, 15; 26, 30; 20, 45'");
      if (p.shape == "profile" && p.profile.control_points.front()[1] != 0.)
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

    bool is_sector(const BilletParameters &p)
    {
      return p.sector_angle != 0 && p.sector_angle != 360;
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

    std::vector<Plane> sector_planes(const BilletParameters &p)
    {
      std::vector<Plane> planes;
      if (is_sector(p))
        planes.push_back({p.base_centre, Vec3({0, -1, 0})});
      if (is_sector(p) && p.sector_angle < 180)
        planes.push_back({p.base_centre, sector_end_normal(p.sector_angle)});
      return planes;
    }

    void check_symmetry(const BilletParameters &p)
    {
      if (p.shape == "file" && (!p.symmetry_planes.empty() || is_sector(p)))
        throw Error("Billet/symmetry planes",
                    "the shape is `file', and symmetry planes or a sector angle are given",
                    "a mesh from a file is not cut",
                    "name its planes in `symmetry patches'");
      if (p.shape != "cylinder" && !p.is_revolved() && is_sector(p))
        throw Error("Billet/sector angle",
                    "is " + as_text(p.sector_angle) + ", and the shape is `" + p.shape + "'",
                    "only bodies of revolution have sectors",
                    "set it to 0, or use symmetry planes");
      if (is_sector(p) && !(p.sector_angle > 0 && p.sector_angle <= 180))
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
      if (n_cells > 1e9)
        throw Error("Billet/element size",
                    "is " + as_text(p.element_size) + ", which makes about " + as_text(n_cells) +
                      " tetrahedra",
                    "a mesh may have 1e9",
                    "choose a larger element size");
    }

    CutSolid solid_of(const BilletParameters &p)
    {
      CutSolid solid;
      solid.is_cylinder = p.shape == "cylinder";
      solid.base_centre = p.base_centre;
      solid.size        = p.size;
      solid.radius      = p.whole_width() / 2;
      solid.height      = p.whole_height();
      solid.cuts        = p.symmetry_cuts();
      if (p.is_revolved())
      {
        solid.section           = p.shape == "ring" ? p.ring.section() : p.profile.section();
        solid.section_angle     = is_sector(p) ? p.sector_angle : 360;
        solid.n_cuts_of_section = sector_planes(p).size();
      }
      return solid;
    }

    PatchShape planar_shape(const std::string &name, const Vec3 &point, const Vec3 &normal)
    {
      return {{name, {}}, Plane{point, normal}, {}, {}};
    }

    // A level segment makes a plane, an upright one a cylinder.
    PatchShape revolved_shape(const Portion &portion, const Vec3 &c)
    {
      const Vec2 first = portion.curve.value(0), last = portion.curve.value(1);
      if (portion.curve.is_segment() && first[1] == last[1])
        return planar_shape(portion.patch,
                            c + Vec3({0, 0, first[1]}),
                            Vec3({0, 0, last[0] > first[0] ? 1. : -1.})); // the contour is clockwise
      if (portion.curve.is_segment() && first[0] == last[0])
        return {{portion.patch, {}}, {}, CylinderSurface{c, Vec3({0, 0, 1}), first[0]}, {}};
      return {{portion.patch, {}}, {}, {}, RevolvedCurve{c, portion.curve}};
    }

    // In the order bottom, top, sides, edges of the other shapes.
    void add_revolved_shapes(std::vector<PatchShape> &shapes, const CutSolid &solid)
    {
      for (const char *name : {"bottom",
                               "top",
                               "side inner",
                               "side outer",
                               "edge top outer",
                               "edge bottom outer",
                               "edge bottom inner"})
        for (const Portion &portion : solid.section)
          if (portion.patch == name)
            shapes.push_back(revolved_shape(portion, solid.base_centre));
    }

    // Symmetry planes first: a face of the solid that lies in one of them is not surface.
    std::vector<PatchShape> shapes_of(const CutSolid &solid)
    {
      std::vector<PatchShape> shapes;
      for (std::size_t i = 0; i < solid.cuts.size(); ++i)
        shapes.push_back({{"symmetry " + std::to_string(i + 1), solid.cuts[i]}, solid.cuts[i], {}, {}});
      if (!solid.section.empty())
      {
        add_revolved_shapes(shapes, solid);
        return shapes;
      }
      const Vec3 &c = solid.base_centre;
      shapes.push_back(planar_shape("bottom", c, Vec3({0, 0, -1})));
      shapes.push_back(planar_shape("top", c + Vec3({0, 0, solid.height}), Vec3({0, 0, 1})));
      if (solid.is_cylinder)
        shapes.push_back({{"side", {}}, {}, CylinderSurface{c, Vec3({0, 0, 1}), solid.radius}, {}});
      else
        for (unsigned int d = 0; d < 2; ++d)
          for (const int sign : {-1, 1})
          {
            Vec3 normal;
            normal[d] = sign;
            shapes.push_back(
              planar_shape(std::string("side ") + (sign < 0 ? "-" : "+") + (d == 0 ? "x" : "y"),
                           c + solid.size[d] / 2 * normal,
                           normal));
          }
      return shapes;
    }

    void check_all_planes_cut(const TetMesh &mesh, const CutSolid &solid)
    {
      for (std::size_t i = 0; i < solid.cuts.size(); ++i)
      {
        const std::string name = "symmetry " + std::to_string(i + 1);
        if (std::none_of(mesh.patches.begin(), mesh.patches.end(), [&](const Patch &patch) {
              return patch.name == name;
            }))
          throw Error("Billet/symmetry planes",
                      "plane " + std::to_string(i + 1) + " does not touch the billet",
                      "each symmetry plane must bound what is left of the billet",
                      "remove it or move the symmetry point");
      }
    }

    // Symmetry patches stand last in the mesh, after the billet's own.
    void put_symmetry_last(TetMesh &mesh)
    {
      std::vector<unsigned int> order(mesh.patches.size()), number(mesh.patches.size());
      for (unsigned int p = 0; p < order.size(); ++p)
        order[p] = p;
      std::stable_partition(
        order.begin(), order.end(), [&](const unsigned int p) { return !mesh.patches[p].symmetry; });
      std::vector<Patch> patches;
      for (unsigned int p = 0; p < order.size(); ++p)
      {
        number[order[p]] = p;
        patches.push_back(mesh.patches[order[p]]);
      }
      mesh.patches = patches;
      for (auto &face : mesh.faces)
        face.patch = number[face.patch];
    }

    TetMesh mesh_solid(const BilletParameters &p)
    {
      const CutSolid   in_mm  = solid_of(p);
      const LengthUnit unit   = unit_of(in_mm);
      const CutSolid   solid  = in_unit(unit, in_mm);
      const auto       assign = [shapes = shapes_of(solid)](TetMesh &mesh) {
        return assign_patches(mesh, shapes, 1e-6 * mesh_size(mesh), "Billet");
      };
      const auto improve = [&](TetMesh &mesh, const double angle) {
        assign(mesh);
        take_away_surface_slivers(mesh, angle);
      };
      TetMesh mesh = mesh_with_gmsh(solid, unit.rounded_from_mm(p.element_size), improve, "Billet");
      if (mesh.cells.empty())
        return mesh;
      snap_nodes(mesh, assign(mesh));
      check_all_planes_cut(mesh, solid);
      put_symmetry_last(mesh);
      put_in_mm(unit, mesh);
      return mesh;
    }

    void move(TetMesh &mesh, const BilletParameters &p)
    {
      const bool turns = !p.rotations.are_none();
      if (!turns && p.translation.norm() == 0)
        return;
      const dealii::Tensor<2, 3> R     = p.rotations.matrix();
      const auto                 moved = [&](const Vec3 &x) { return (turns ? R * x : x) + p.translation; };
      for (NodalVectors<double> *X : {&mesh.X, &mesh.of_file.X})
        for (Vec3 &x : *X)
          x = moved(x);
      for (auto &patch : mesh.patches)
        if (patch.symmetry)
          patch.symmetry =
            Plane{moved(patch.symmetry->point), turns ? R * patch.symmetry->normal : patch.symmetry->normal};
    }

    /// Far from the origin no digits are left for the shape.
    void check_place(const TetMesh &mesh)
    {
      const auto [low, high] = bounding_box(mesh.X);
      const double away      = std::max(low.norm(), high.norm());
      if (!(away <= 1e6 * (high - low).norm()))
        throw Error("Billet/translation",
                    "brings the billet, of an extent of " + as_text((high - low).norm()) + " mm, " +
                      as_text(away) + " mm away from the origin",
                    "it stands within a million times its extent",
                    "move billet and dies nearer to the origin (base centre, translation)");
    }

    TetMesh read_file(const BilletParameters &p)
    {
      TetMesh mesh = read_msh(p.file_name, p.symmetry_patches);
      for (NodalVectors<double> *X : {&mesh.X, &mesh.of_file.X})
        for (Vec3 &x : *X)
          x *= p.scale;
      for (Patch &patch : mesh.patches)
        if (patch.symmetry)
          patch.symmetry->point *= p.scale;
      return mesh;
    }

    TetMesh make_on_one_rank(const BilletParameters &p)
    {
      TetMesh           mesh  = p.shape == "file" ? read_file(p) : mesh_solid(p);
      const std::string where = p.shape == "file" ? p.file_name : "Billet";
      check_mesh(mesh, where);
      move(mesh, p);
      check_place(mesh);
      renumber(mesh);
      return mesh;
    }
  } // namespace

  double BilletParameters::whole_height() const
  {
    return shape == "box"        ? size[2]
           : shape == "cylinder" ? height
           : shape == "ring"     ? ring.mu[0]
           : shape == "profile"  ? profile.height()
                                 : 0.;
  }

  double BilletParameters::whole_width() const
  {
    return shape == "cylinder"  ? 2 * radius
           : shape == "ring"    ? 2 * ring.mu[3]
           : shape == "profile" ? profile.width()
           : shape == "box"     ? size[0]
                                : 0.;
  }

  std::vector<Plane> BilletParameters::symmetry_cuts() const
  {
    std::vector<Plane> planes = sector_planes(*this);
    const Vec3         point  = parse_symmetry_point(*this);
    for (const Vec3 &normal : symmetry_planes)
      planes.push_back({point, normal / normal.norm()});
    return planes;
  }

  void BilletParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    using namespace dealii::Patterns;
    prm.enter_subsection("Billet");
    prm.add_parameter(
      "shape",
      shape,
      "What the billet is: a box, a cylinder, a ring (its section has seven portions, see mu1 to mu4), a "
      "profile (a body of revolution whose contour is a B-spline), all standing along z, or a mesh from a "
      "file. Units: none.",
      Selection("box|cylinder|ring|profile|file"));
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
    if (shape != "box" && shape != "cylinder" && !is_revolved() && shape != "file")
      throw Error("Billet/shape",
                  "is `" + shape + "'",
                  "it must be box, cylinder, ring, profile or file",
                  "choose one of them");
    if (shape == "box")
      for (unsigned int d = 0; d < 3; ++d)
        check_positive("size", size[d]);
    if (shape == "cylinder")
    {
      check_positive("radius", radius);
      check_positive("height", height);
    }
    if (is_revolved())
      check_profile(*this);
    check_symmetry(*this);
    if (shape != "file")
    {
      check_positive("element size", element_size);
      check_fineness(*this);
    }
    if (shape == "file" && file_name.empty())
      throw Error("Billet/file name", "is empty", "the shape `file' needs a mesh", "name a .msh file");
    if (shape != "file" && !symmetry_patches.empty())
      throw Error("Billet/symmetry patches",
                  "are given, and the shape is `" + shape + "'",
                  "symmetry patches are for meshes from a file",
                  "use symmetry planes");
    rotations.check("Billet");
  }

  double shape_volume(const BilletParameters &parameters)
  {
    return volume_with_gmsh(solid_of(parameters), "Billet");
  }

  TetMesh make_billet(const BilletParameters &parameters, MPI_Comm communicator)
  {
    parameters.check();
    return make_on_root(
      "Billet", [&]() { return make_on_one_rank(parameters); }, communicator);
  }

  double whole_volume(const BilletParameters &p)
  {
    return p.shape == "box"        ? p.size[0] * p.size[1] * p.size[2]
           : p.shape == "cylinder" ? M_PI * p.radius * p.radius * p.height
           : p.shape == "ring"     ? volume_of_revolution(p.ring.section())
           : p.shape == "profile"  ? volume_of_revolution(p.profile.section())
                                   : 0.;
  }

  void snap_to_shape(const BilletParameters &parameters, TetMesh &mesh)
  {
    if (parameters.shape == "file")
      return;
    const std::vector<PatchShape> known = shapes_of(solid_of(parameters));
    std::vector<PatchShape>       shapes;
    for (const Patch &patch : mesh.patches)
      for (const PatchShape &shape : known)
        if (shape.patch.name == patch.name)
          shapes.push_back(shape);
    AssertThrow(shapes.size() == mesh.patches.size(), dealii::ExcInternalError());
    const dealii::Tensor<2, 3> R = parameters.rotations.matrix();
    for (Vec3 &x : mesh.X)
      x = transpose(R) * (x - parameters.translation);
    snap_nodes(mesh, shapes);
    for (Vec3 &x : mesh.X)
      x = R * x + parameters.translation;
  }

  double expected_cells(const BilletParameters &p)
  {
    return p.shape == "file" ? 0. : expected_cells(whole_volume(p), p.element_size);
  }
} // namespace retroforge
