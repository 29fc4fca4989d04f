// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/physics/transformations.h>

#include <retroforge/core/dual.h>
#include <retroforge/core/error.h>
#include <retroforge/geometry/die_parameters.h>
#include <retroforge/geometry/stl_file.h>

#include <cmath>

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
    prm.add_parameter("follows billet",
                      follows_billet,
                      "Where the design makes the billet higher or lower, the die starts as far from it as "
                      "in the nominal design, "
                      "and ends, if it is the leading one, where it ends there: the stroke changes with the "
                      "height, the final gap "
                      "does not. Strokes are told as those of the nominal design. The gradient by the "
                      "billet's nodes is that with "
                      "the dies held. Units: none.");
    prm.add_parameter("depth of contact",
                      depth,
                      "Nodes deeper than this behind a surface are not in contact with it; 0 for a tenth of "
                      "its extent. Units: mm.",
                      Double(0.));
    prm.add_parameter("surface",
                      surface_law,
                      "smooth: facets stand for a smooth surface, normals and gaps are interpolated between "
                      "their corners; facets: they are the surface. On facets the gradient misses the die's "
                      "curvature. Units: none.",
                      dealii::Patterns::Selection("smooth|facets"));
    prm.add_parameter("feature angle",
                      feature_angle,
                      "Edges where the facets of a smooth surface turn by more stay sharp. Units: degrees.",
                      Double(0., 180.));
    prm.add_parameter(
      "largest sagitta",
      largest_sagitta,
      "Edges stay sharp, too, where a smooth surface would be farther from its facets than this part of the "
      "die's extent: folds between large faces. Raise it for coarse facets. Units: none.",
      Double(0.));
    prm.add_parameter(
      "file",
      file,
      "STL file, ASCII or binary; a relative name is looked for beside the parameter file, then in the "
      "folder the program is started in. Units: none.");
    prm.add_parameter("scale", scale, "Factor to mm of the file's lengths. Units: none.", Double(1e-300));
    prm.add_parameter("rotation axis", axis, "Of an STL surface, through its origin. Units: none.");
    prm.add_parameter("rotation angle",
                      angle,
                      "Of an STL surface about that axis, of a tripod or bell about its own. Units: degrees.",
                      Double(-360., 360.));
    prm.add_parameter("chord error",
                      chord_error,
                      "Largest distance of a tripod's or bell's facets from its smooth shape. Units: mm.",
                      Double(1e-6));
    add_tripod(prm, tripod);
    add_bell(prm, bell);
    prm.leave_subsection();
  }

  ReadBy DieParameters::read_by_shape()
  {
    const auto surface = [](std::vector<std::string> own) {
      own.insert(own.end(),
                 {"rotation angle", "depth of contact", "surface", "feature angle", "largest sagitta"});
      return own;
    };
    return {{"stl", surface({"file", "scale", "rotation axis"})},
            {"tripod", surface({"Tripod", "chord error"})},
            {"bell", surface({"Bell", "chord error"})}};
  }

  void DieParameters::check()
  {
    if (!(facing.norm() > 0. && std::isfinite(facing.norm())))
      throw Error(section() + "/facing",
                  facing.norm() > 0. ? "is infinite" : "is the zero vector",
                  "it must point from the die to the workpiece",
                  "use for instance 0, 0, 1 for a lower die");
    facing /= facing.norm();
    if (follows_billet && velocity.norm() > 0. && !(velocity * facing > 0.))
      throw Error(section() + "/follows billet",
                  "is true, but the die does not move along its facing",
                  "its path is lengthened by what the billet grows, towards the workpiece",
                  "correct the velocity or the facing, or leave it out");
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
    if (!(axis.norm() > 0. && std::isfinite(axis.norm())))
      throw Error(
        section() + "/rotation axis", "is zero or infinite", "it must have a direction", "use 0, 0, 1");
  }

  namespace
  {
    template <typename Number>
    std::map<std::string, Number *> by_name(CavityProfile<Number> &profile)
    {
      return {{"depth", &profile.depth},
              {"draft angle", &profile.draft},
              {"edge radius", &profile.edge},
              {"fillet radius", &profile.fillet}};
    }

    template <typename Number>
    std::map<std::string, Number *> by_name(TripodShape<Number> &shape)
    {
      auto all = by_name(shape.profile);
      all.insert({{"hub radius", &shape.hub},
                  {"arm width", &shape.width},
                  {"arm length", &shape.length},
                  {"corner radius", &shape.corner},
                  {"outer radius", &shape.outer}});
      return all;
    }

    template <typename Number>
    std::map<std::string, Number *> by_name(BellShape<Number> &shape)
    {
      auto all = by_name(shape.profile);
      all.insert({{"mouth radius", &shape.mouth}, {"outer radius", &shape.outer}});
      return all;
    }

    /// A shape of another number type, with some of its measures replaced.
    template <template <typename> class Shape, typename Number>
    Shape<Number> changed_shape(Shape<double> shape, const std::map<std::string, Number> &changed)
    {
      Shape<Number> result;
      const auto    from = by_name(shape);
      for (const auto &[name, to] : by_name(result))
      {
        const auto other = changed.find(name);
        *to              = other == changed.end() ? Number(*from.at(name)) : other->second;
      }
      return result;
    }

    std::map<std::string, double *>
    measures_of(const std::string &shape, TripodShape<double> &tripod, BellShape<double> &bell)
    {
      if (shape == "tripod")
        return by_name(tripod);
      if (shape == "bell")
        return by_name(bell);
      return {};
    }
  } // namespace

  std::vector<std::string> DieParameters::measures() const
  {
    DieParameters            copy = *this;
    std::vector<std::string> names;
    for (const auto &[name, value] : measures_of(shape, copy.tripod, copy.bell))
      names.push_back(name);
    return names;
  }

  double DieParameters::measure(const std::string &name) const
  {
    DieParameters copy = *this;
    return *measures_of(shape, copy.tripod, copy.bell).at(name);
  }

  template <typename Number>
  ShapeMesh<Number> DieParameters::shape_mesh(const std::map<std::string, Number> &changed,
                                              Segments                            &segments) const
  {
    segments.again();
    if (shape == "tripod")
      return make_tripod(section() + "/Tripod", changed_shape(tripod, changed), chord_error, segments);
    return make_bell(section() + "/Bell", changed_shape(bell, changed), chord_error, segments);
  }

  template <typename Number>
  NodalVectors<Number> DieParameters::vertices(const std::map<std::string, Number> &changed) const
  {
    Segments segments;
    shape_mesh<double>({}, segments);
    NodalVectors<Number>       vertices = shape_mesh(changed, segments).vertices;
    const dealii::Tensor<2, 3> R        = turn();
    for (Vector3<Number> &x : vertices)
    {
      Vector3<Number> y;
      for (unsigned int i = 0; i < 3; ++i)
        y[i] = point[i] + R[i][0] * x[0] + R[i][1] * x[1] + R[i][2] * x[2];
      x = y;
    }
    return vertices;
  }

  template NodalVectors<double> DieParameters::vertices(const std::map<std::string, double> &) const;
  template NodalVectors<Dual>   DieParameters::vertices(const std::map<std::string, Dual> &) const;

  dealii::Tensor<2, 3> DieParameters::turn() const
  {
    return shape == "stl" ? scale * rotation(axis, angle)
                          : rotation_to(facing) * rotation(Vec3({0., 0., 1.}), angle);
  }

  TriangleSurface DieParameters::surface() const
  {
    NodalVectors<double>  vertices;
    std::vector<Triangle> triangles;
    std::string           where = section();
    if (shape == "stl")
    {
      const TriangleSurface read = read_stl(file);
      vertices                   = read.vertices();
      triangles                  = read.triangles();
      where += "/file (" + file + ")";
    }
    else
    {
      Segments   segments;
      const auto mesh = shape_mesh<double>({}, segments);
      vertices        = mesh.vertices;
      triangles       = mesh.triangles;
    }
    const dealii::Tensor<2, 3> R = turn();
    for (Vec3 &x : vertices)
      x = point + R * x;
    return TriangleSurface(where, vertices, triangles);
  }

  Die DieParameters::die() const
  {
    if (shape == "plane")
      return Die(name, point, facing);
    TriangleSurface made     = surface();
    const double    diagonal = made.diagonal();
    return Die(name,
               std::move(made),
               depth > 0. ? depth : 0.1 * diagonal,
               {surface_law == "smooth", feature_angle, largest_sagitta});
  }
} // namespace retroforge
