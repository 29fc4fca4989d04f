// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/physics/transformations.h>

#include <retroforge/core/error.h>
#include <retroforge/geometry/die_parameters.h>
#include <retroforge/geometry/stl_file.h>

namespace retroforge
{
  using dealii::Patterns::Double;

  namespace
  {
    void add_profile(dealii::ParameterHandler &prm, CavityProfile<double> &profile)
    {
      prm.add_parameter("depth", profile.depth, "Of the floor below the face. Units: mm.", Double(0.));
      prm.add_parameter(
        "draft angle", profile.draft, "Of the wall against the axis. Units: degrees.", Double(0., 80.));
      prm.add_parameter("edge radius", profile.edge, "Between face and wall. Units: mm.", Double(0.));
      prm.add_parameter("fillet radius", profile.fillet, "Between wall and floor. Units: mm.", Double(0.));
    }

    void add_tripod(dealii::ParameterHandler &prm, TripodShape<double> &tripod)
    {
      prm.enter_subsection("Tripod");
      prm.add_parameter("hub radius", tripod.hub, "In the plane of the face. Units: mm.", Double(0.));
      prm.add_parameter("arm width", tripod.width, "In the plane of the face. Units: mm.", Double(0.));
      prm.add_parameter(
        "arm length", tripod.length, "From the axis to the round end of an arm. Units: mm.", Double(0.));
      prm.add_parameter(
        "corner radius", tripod.corner, "In plan, between hub and arm. Units: mm.", Double(0.));
      prm.add_parameter("outer radius", tripod.outer, "Of the face. Units: mm.", Double(0.));
      add_profile(prm, tripod.profile);
      prm.leave_subsection();
    }

    void add_bell(dealii::ParameterHandler &prm, BellShape<double> &bell)
    {
      prm.enter_subsection("Bell");
      prm.add_parameter("mouth radius", bell.mouth, "In the plane of the face. Units: mm.", Double(0.));
      prm.add_parameter("outer radius", bell.outer, "Of the face. Units: mm.", Double(0.));
      add_profile(prm, bell.profile);
      prm.leave_subsection();
    }

    dealii::Tensor<2, 3> rotation(const Vec3 &axis, const double degrees)
    {
      return dealii::Physics::Transformations::Rotations::rotation_matrix_3d(
        dealii::Point<3>(axis / axis.norm()), degrees * dealii::numbers::PI / 180.);
    }

    /// The short way from the z axis to a unit vector.
    dealii::Tensor<2, 3> rotation_to(const Vec3 &facing)
    {
      const Vec3 z({0., 0., 1.}), across = cross_product_3d(z, facing);
      if (across.norm() < 1e-12)
        return rotation(Vec3({1., 0., 0.}), facing[2] > 0. ? 0. : 180.);
      return rotation(across, std::atan2(across.norm(), facing[2]) * 180. / dealii::numbers::PI);
    }
  } // namespace

  void DieParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.enter_subsection(section());
    prm.add_parameter(
      "shape",
      shape,
      "plane; stl: the surface in `file`, whose normals point to the workpiece; tripod, bell: a "
      "flat face with a cavity. Units: none.",
      dealii::Patterns::Selection("plane|stl|tripod|bell"));
    prm.add_parameter("point",
                      point,
                      "At the start of the run, a point of the working face; of a tripod or bell, where its "
                      "axis meets the face; of an STL surface, by how much it is moved. Units: mm.");
    prm.add_parameter(
      "facing",
      facing,
      "Normal of the working face, pointing from the die to the workpiece; of any length. `die "
      "NAME/offset' moves the die along it. Units: none.");
    prm.add_parameter("velocity", velocity, "Velocity of the die, constant. Units: mm/s.");
    prm.add_parameter(
      "friction",
      friction,
      "alpha of the Norton friction law tau = -alpha K |dv|^(m-1) dv; 0 is a frictionless die. "
      "Units: mm^(-m).",
      Double(0.));
    prm.add_parameter("depth of contact",
                      depth,
                      "Nodes deeper than this behind a surface are not in contact with it; 0 for a tenth of "
                      "its extent. Units: mm.",
                      Double(0.));
    prm.add_parameter(
      "file", file, "STL file, ASCII or binary, from the folder the program is started in. Units: none.");
    prm.add_parameter("scale", scale, "Factor to mm of the file's lengths. Units: none.", Double(1e-300));
    prm.add_parameter("rotation axis", axis, "Of an STL surface, through its origin. Units: none.");
    prm.add_parameter(
      "rotation angle",
      angle,
      "Of an STL surface about that axis, of a tripod or bell about its own. Units: degrees.");
    prm.add_parameter("chord error",
                      chord_error,
                      "Largest distance of a tripod's or bell's facets from its smooth shape. Units: mm.",
                      Double(1e-6));
    add_tripod(prm, tripod);
    add_bell(prm, bell);
    prm.leave_subsection();
  }

  void DieParameters::check()
  {
    if (!(facing.norm() > 0.))
      throw Error(section() + "/facing",
                  "is the zero vector",
                  "it must point from the die to the workpiece",
                  "use for instance 0, 0, 1 for a lower die");
    facing /= facing.norm();
    if (shape == "stl" && file.empty())
      throw Error(section() + "/file",
                  "is empty",
                  "a die of shape stl needs its file",
                  "give the path of an STL file, or choose another shape");
    if (shape != "stl" && !file.empty())
      throw Error(section() + "/file",
                  "is '" + file + "', but the shape is " + shape,
                  "only a die of shape stl is read from a file",
                  "set shape = stl, or leave the file out");
    if (!(axis.norm() > 0.))
      throw Error(
        section() + "/rotation axis", "is the zero vector", "it must have a direction", "use 0, 0, 1");
  }

  TriangleSurface DieParameters::surface() const
  {
    NodalVectors<double>  vertices;
    std::vector<Triangle> triangles;
    dealii::Tensor<2, 3>  turn;
    std::string           where = section();
    if (shape == "stl")
    {
      const TriangleSurface read = read_stl(file);
      vertices                   = read.vertices();
      triangles                  = read.triangles();
      turn                       = scale * rotation(axis, angle);
      where += "/file (" + file + ")";
    }
    else
    {
      const auto mesh = shape == "tripod" ? make_tripod(where + "/Tripod", tripod, chord_error)
                                          : make_bell(where + "/Bell", bell, chord_error);
      vertices        = mesh.vertices;
      triangles       = mesh.triangles;
      turn            = rotation_to(facing) * rotation(Vec3({0., 0., 1.}), angle);
    }
    for (Vec3 &x : vertices)
      x = point + turn * x;
    return TriangleSurface(where, vertices, triangles);
  }

  Die DieParameters::die() const
  {
    if (shape == "plane")
      return Die(name, point, facing);
    TriangleSurface made     = surface();
    const double    diagonal = made.diagonal();
    return Die(name, std::move(made), depth > 0. ? depth : 0.1 * diagonal);
  }
} // namespace retroforge
