// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/patterns.h>
#include <deal.II/base/utilities.h>

#include <retroforge/billet/billet.h>
#include <retroforge/billet/fineness.h>
#include <retroforge/billet/gmsh_mesher.h>
#include <retroforge/billet/length_unit.h>
#include <retroforge/billet/msh_mesh.h>
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
    CutSolid solid_of(const BilletParameters &p)
    {
      CutSolid solid;
      solid.is_cylinder = p.shape == BilletParameters::Shape::cylinder;
      solid.base_centre = p.base_centre;
      solid.size        = p.size;
      solid.radius      = p.whole_width() / 2;
      solid.height      = p.whole_height();
      solid.cuts        = p.symmetry_cuts();
      if (p.is_revolved())
      {
        solid.section = p.shape == BilletParameters::Shape::ring ? p.ring.section() : p.profile.section();
        solid.section_angle     = p.is_sector() ? p.sector_angle : 360;
        solid.n_cuts_of_section = p.sector_planes().size();
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
      TetMesh           mesh  = p.is_from_file() ? read_file(p) : mesh_solid(p);
      const std::string where = p.is_from_file() ? p.file_name : "Billet";
      check_mesh(mesh, where);
      move(mesh, p);
      check_place(mesh);
      renumber(mesh);
      return mesh;
    }
  } // namespace

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
    return p.shape == BilletParameters::Shape::box        ? p.size[0] * p.size[1] * p.size[2]
           : p.shape == BilletParameters::Shape::cylinder ? M_PI * p.radius * p.radius * p.height
           : p.shape == BilletParameters::Shape::ring     ? volume_of_revolution(p.ring.section())
           : p.shape == BilletParameters::Shape::profile  ? volume_of_revolution(p.profile.section())
                                                          : 0.;
  }

  void snap_to_shape(const BilletParameters &parameters, TetMesh &mesh)
  {
    if (parameters.is_from_file())
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
    return p.is_from_file() ? 0. : expected_cells(whole_volume(p), p.element_size);
  }
} // namespace retroforge
