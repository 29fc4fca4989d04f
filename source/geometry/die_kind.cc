// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/enum_setting.h>
#include <retroforge/core/error.h>
#include <retroforge/geometry/die_kind.h>
#include <retroforge/geometry/stl_file.h>

#include <cmath>

namespace retroforge
{
  using dealii::Patterns::Double;

  namespace
  {
    class PlaneDie : public DieKind
    {
    public:
      Die make(const DiePlace &place) const override { return Die(place.name, place.point, place.facing); }
    };

    /// The short way from the z axis to a unit vector.
    dealii::Tensor<2, 3> rotation_to(const Vec3 &facing)
    {
      const Vec3 z({0., 0., 1.}), across = cross_product_3d(z, facing);
      if (across.norm() < 1e-12)
        return rotation(Vec3({1., 0., 0.}), facing[2] > 0. ? 0. : 180.);
      return rotation(across, std::atan2(across.norm(), facing[2]) * 180. / dealii::numbers::PI);
    }
  } // namespace

  const Choice<DieKind>::Makers &die_kinds()
  {
    using Kinds                      = Choice<DieKind>;
    static const Kinds::Makers kinds = {{"plane", Kinds::make<PlaneDie>},
                                        {"stl", Kinds::make<StlDie>},
                                        {"tripod", Kinds::make<TripodDie>},
                                        {"bell", Kinds::make<BellDie>},
                                        {"gear", Kinds::make<GearDie>},
                                        {"punch", Kinds::make<PunchDie>}};
    return kinds;
  }

  NodalVectors<double> DieKind::vertices(const DiePlace &, const std::map<std::string, double> &) const
  {
    return {};
  }

  NodalVectors<Dual> DieKind::vertices(const DiePlace &, const std::map<std::string, Dual> &) const
  {
    return {};
  }

  void SurfaceDie::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.add_parameter("depth of contact",
                      depth,
                      "Nodes deeper than this behind a surface are not in contact with it; 0 for a tenth of "
                      "its extent. Units: mm.",
                      Double(0.));
    add_enum<Surface>(prm,
                      "surface",
                      surface_law,
                      {{"smooth", Surface::smooth}, {"facets", Surface::facets}},
                      "smooth: facets stand for a smooth surface, normals and gaps are interpolated between "
                      "their corners; facets: they are the surface. On facets the gradient misses the die's "
                      "curvature. Units: none.");
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
    free_form_parameters.add_parameters(prm);
  }

  void SurfaceDie::check(const std::string &section, const std::string &chosen) const
  {
    free_form_parameters.check(section, chosen);
  }

  void SurfaceDie::add_angle(dealii::ParameterHandler &prm)
  {
    prm.add_parameter(
      "rotation angle",
      rotations.angle,
      "Of an STL surface about that axis, of a die by measures about its own. Units: degrees.",
      Double(-360., 360.));
  }

  Die SurfaceDie::make(const DiePlace &place) const
  {
    TriangleSurface made     = surface(place);
    const double    diagonal = made.diagonal();
    return Die(place.name,
               std::move(made),
               depth > 0. ? depth : 0.1 * diagonal,
               {surface_law == Surface::smooth, feature_angle, largest_sagitta});
  }

  void StlDie::add_parameters(dealii::ParameterHandler &prm)
  {
    SurfaceDie::add_parameters(prm);
    prm.add_parameter(
      "file",
      file,
      "STL file, ASCII or binary; a relative name is looked for beside the parameter file, then in the "
      "folder the program is started in. Units: none.");
    prm.add_parameter("scale", scale, "Factor to mm of the file's lengths. Units: none.", Double(1e-300));
    prm.add_parameter("rotation axis", rotations.axis, "Of an STL surface, through its origin. Units: none.");
    add_angle(prm);
    rotations.add_list(prm, "Rotations of an STL surface,");
  }

  void StlDie::check(const std::string &section, const std::string &chosen) const
  {
    SurfaceDie::check(section, chosen);
    const bool is_chosen = chosen == "stl";
    if (is_chosen && file.empty())
      throw Error(section + "/file",
                  "is empty",
                  "a die of shape stl needs its file",
                  "give the path of an STL file, or choose another shape");
    if (!is_chosen && !file.empty())
      throw Error(section + "/file",
                  "is '" + file + "', but the shape is " + chosen,
                  "only a die of shape stl is read from a file",
                  "set shape = stl, or leave the file out");
    rotations.check(section);
  }

  TriangleSurface StlDie::surface(const DiePlace &place) const
  {
    const TriangleSurface      read     = read_stl(file, place.section + "/file");
    NodalVectors<double>       vertices = read.vertices();
    const dealii::Tensor<2, 3> R        = scale * rotations.matrix();
    for (Vec3 &x : vertices)
      x = place.point + R * x;
    TriangleSurface placed(place.section + "/file (" + file + ")", vertices, read.triangles());
    placed.remarks = read.remarks;
    return placed;
  }

  namespace
  {
    /// A shape of another number type, with some of its measures replaced.
    template <template <typename> class Shape, typename Number>
    Shape<Number> changed_shape(const Shape<double> &shape, const std::map<std::string, Number> &changed)
    {
      std::map<std::string, Number> values = changed;
      Shape<double>::for_each_measure(shape, [&](const Measure &measure, const double x) {
        values.insert({measure.name, Number(x)});
      });
      std::vector<unsigned int> counts;
      Shape<double>::for_each_count(
        shape, [&](const char *, const char *, const unsigned int n) { counts.push_back(n); });
      Shape<Number> result;
      std::size_t   next = 0;
      Shape<Number>::for_each_count(result,
                                    [&](const char *, const char *, unsigned int &n) { n = counts[next++]; });
      Shape<Number>::for_each_measure(
        result, [&](const Measure &measure, Number &x) { x = values.at(measure.name); });
      return result;
    }
  } // namespace

  template <template <typename> class Shape>
  void CavityDie<Shape>::add_parameters(dealii::ParameterHandler &prm)
  {
    SurfaceDie::add_parameters(prm);
    add_angle(prm);
    prm.add_parameter("chord error",
                      chord_error,
                      "Largest distance of the facets of a die by measures from its smooth shape. Units: mm.",
                      Double(1e-6));
    prm.enter_subsection(Shape<double>::section());
    Shape<double>::for_each_count(shape, [&](const char *name, const std::string &meaning, unsigned int &n) {
      prm.add_parameter(name, n, meaning + " Units: none.", dealii::Patterns::Integer(1, 1000));
    });
    Shape<double>::for_each_measure(shape, [&](const Measure &measure, double &x) {
      prm.add_parameter(measure.name,
                        x,
                        measure.meaning + " Units: " + measure.unit + ".",
                        measure.unit == "degrees" ? Double(0., 80.) : Double(0.));
    });
    prm.leave_subsection();
  }

  template <template <typename> class Shape>
  std::map<std::string, Measure> CavityDie<Shape>::measures() const
  {
    std::map<std::string, Measure> measures;
    Shape<double>::for_each_measure(shape, [&](Measure measure, const double x) {
      measure.value          = x;
      measures[measure.name] = measure;
    });
    return measures;
  }

  template <template <typename> class Shape>
  template <typename Number>
  ShapeMesh<Number> CavityDie<Shape>::mesh(const DiePlace                      &place,
                                           const std::map<std::string, Number> &changed,
                                           Segments                            &segments) const
  {
    segments.again();
    auto mesh = shape_mesh(
      place.section + "/" + Shape<double>::section(), changed_shape(shape, changed), chord_error, segments);
    const dealii::Tensor<2, 3> R = rotation_to(place.facing) * rotation(Vec3({0., 0., 1.}), rotations.angle);
    for (Vector3<Number> &x : mesh.vertices)
    {
      Vector3<Number> y;
      for (unsigned int i = 0; i < 3; ++i)
        y[i] = place.point[i] + (R[i][0] * x[0] + R[i][1] * x[1] + R[i][2] * x[2]);
      x = y;
    }
    return mesh;
  }

  template <template <typename> class Shape>
  TriangleSurface CavityDie<Shape>::surface(const DiePlace &place) const
  {
    Segments   segments;
    const auto made = mesh<double>(place, {}, segments);
    return TriangleSurface(place.section, made.vertices, made.triangles);
  }

  template <template <typename> class Shape>
  template <typename Number>
  NodalVectors<Number> CavityDie<Shape>::changed_vertices(const DiePlace                      &place,
                                                          const std::map<std::string, Number> &changed) const
  {
    Segments segments;
    mesh<double>(place, {}, segments);
    return mesh(place, changed, segments).vertices;
  }

  template <template <typename> class Shape>
  NodalVectors<double> CavityDie<Shape>::vertices(const DiePlace                      &place,
                                                  const std::map<std::string, double> &changed) const
  {
    return changed_vertices(place, changed);
  }

  template <template <typename> class Shape>
  NodalVectors<Dual> CavityDie<Shape>::vertices(const DiePlace                    &place,
                                                const std::map<std::string, Dual> &changed) const
  {
    return changed_vertices(place, changed);
  }

  template class CavityDie<TripodShape>;
  template class CavityDie<BellShape>;
  template class CavityDie<GearShape>;
  template class CavityDie<PunchShape>;
} // namespace retroforge
