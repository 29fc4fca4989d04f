// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/nearest_name.h>
#include <retroforge/core/text.h>
#include <retroforge/mesh/surface_areas.h>
#include <retroforge/objective/radius.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  RadiusObjective::RadiusObjective(const RadiusStatistic    statistic,
                                   std::vector<std::string> patches,
                                   const Vec3              &point,
                                   const Vec3              &axis)
      : statistic_(statistic), patches_(std::move(patches)), point_(point), axis_(axis / axis.norm())
  {
    if (!(axis.norm() > 0. && std::isfinite(axis.norm())))
      throw Error(
        "Radius", "the axis has length " + as_text(axis.norm()), "it is a direction", "use 0, 0, 1");
    if (patches_.empty())
      throw Error("Radius",
                  "no patch is named",
                  "some part of the surface must be measured",
                  "name the patches of the free side");
  }

  std::vector<Triangle> RadiusObjective::triangles(const TetMesh &mesh) const
  {
    std::vector<Triangle> chosen;
    for (const BoundaryFace &face : mesh.faces)
      if (std::count(patches_.begin(), patches_.end(), mesh.patches[face.patch].name) > 0)
        chosen.push_back(face.nodes);
    return chosen;
  }

  RadiusObjective::Decisions RadiusObjective::compute_decisions(const FinalView<double> &view) const
  {
    const TetMesh &mesh = view.scene.mesh;
    const auto     S    = lumped_areas(triangles(mesh), view.X);
    double         sum = 0., total = 0.;
    for (NodeIndex k = 0; k < S.size(); ++k)
    {
      sum += S[k] * from_axis(view.X[k]).norm();
      total += S[k];
    }
    return {sum / total};
  }

  template <typename Number>
  Vector3<Number> RadiusObjective::from_axis(const Vector3<Number> &x) const
  {
    Vector3<Number> d;
    Number          along(0.);
    for (unsigned int i = 0; i < 3; ++i)
    {
      d[i] = x[i] - point_[i];
      along += d[i] * axis_[i];
    }
    for (unsigned int i = 0; i < 3; ++i)
      d[i] -= along * axis_[i];
    return d;
  }

  template <typename Number>
  std::vector<Number> RadiusObjective::compute_integrals(const FinalView<Number> &view,
                                                         const Decisions         &decisions) const
  {
    using std::sqrt;
    std::vector<Number>      sums(3, Number(0.));
    const Discretization<3> &discretization = view.scene.discretization;
    const auto               S              = lumped_areas(triangles(view.scene.mesh), view.X);
    for (const NodeIndex k : discretization.pressure_nodes()->owned())
      if (value_of(S[k]) > 0.)
      {
        const Vector3<Number> d  = from_axis(view.X[k]);
        const Number          d2 = d * d;
        const Number          x  = (value_of(d2) > 0. ? Number(sqrt(d2)) : Number(0.)) - decisions.reference;
        sums[0] += S[k];
        sums[1] += S[k] * x;
        sums[2] += S[k] * x * x;
      }
    return sums;
  }

  void RadiusObjective::reverse_integrals(const FinalView<double>   &view,
                                          const Decisions           &decisions,
                                          const std::vector<double> &weights,
                                          FinalBar                  &bar) const
  {
    const Discretization<3> &discretization = view.scene.discretization;
    const auto               faces          = triangles(view.scene.mesh);
    const auto               S              = lumped_areas(faces, view.X);
    std::vector<double>      S_bar(S.size(), 0.);
    for (const NodeIndex k : discretization.pressure_nodes()->owned())
      if (S[k] > 0.)
      {
        const Vec3   d = from_axis(view.X[k]);
        const double x = d.norm() - decisions.reference;
        S_bar[k]       = weights[0] + weights[1] * x + weights[2] * x * x;
        if (d.norm() > 0.)
          bar.X[k] += S[k] * (weights[1] + 2. * weights[2] * x) / d.norm() * d;
      }
    reverse_lumped_areas(faces, view.X, S_bar, bar.X);
  }

  template std::vector<double> RadiusObjective::compute_integrals(const FinalView<double> &,
                                                                  const Decisions &) const;
  template std::vector<Dual>   RadiusObjective::compute_integrals(const FinalView<Dual> &,
                                                                const Decisions &) const;

  namespace
  {
    template <RadiusStatistic statistic>
    struct RadiusType : ObjectiveType
    {
      std::vector<std::string> patches;
      Vec3                     axis_point, axis = Vec3({0., 0., 1.});

      void add_parameters(dealii::ParameterHandler &prm) override
      {
        prm.add_parameter(
          "patches",
          patches,
          "Of the billet, whose radius is measured: `side' of a cylinder, `side outer' and `side inner' of a "
          "ring or profile. Units: none.");
        prm.add_parameter("axis point", axis_point, "On the axis that the radius is from. Units: mm.");
        prm.add_parameter("axis", axis, "Its direction. Units: none.");
      }

      static std::vector<std::string> known(const ObjectiveContext &context)
      {
        std::vector<std::string> known;
        for (const Patch &patch : context.billet.patches)
          if (!patch.symmetry)
            known.push_back(patch.name);
        return known;
      }

      void check_names(const std::string &where, const ObjectiveContext &context) const override
      {
        const auto all = known(context);
        for (const std::string &patch : patches)
          if (std::find(all.begin(), all.end(), patch) == all.end())
            throw Error(where + "/patches",
                        "there is no patch '" + patch + "'",
                        "the patches of this billet are: " + join(all),
                        "name some of these");
      }

      void make(const std::string      &where,
                const ObjectiveContext &context,
                NamedObjective         &objective) const override
      {
        if (patches.empty())
          throw Error(where + "/patches",
                      "names no patch",
                      "a part of the surface must be measured",
                      "name the free side; the patches of this billet are: " + join(known(context)));
        objective.at_end = std::make_unique<RadiusObjective>(statistic, patches, axis_point, axis);
      }
    };
  } // namespace

  Choice<ObjectiveType>::Maker cylinder_distance_type()
  {
    return {"cylinder distance", Choice<ObjectiveType>::make<RadiusType<RadiusStatistic::variance>>};
  }

  Choice<ObjectiveType>::Maker mean_radius_type()
  {
    return {"mean radius", Choice<ObjectiveType>::make<RadiusType<RadiusStatistic::mean>>};
  }
} // namespace retroforge
