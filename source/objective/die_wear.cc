// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/enum_setting.h>
#include <retroforge/objective/die_wear.h>
#include <retroforge/objective/objective_settings.h>
#include <retroforge/objective/pairs_of_die.h>
#include <retroforge/solver/contact_pullback.h>

namespace retroforge
{
  namespace
  {
    template <typename Number>
    Number sliding_speed(const ContactNode<Number> &node, const Number &v0)
    {
      using std::sqrt;
      const Vector3<Number> dv     = slip(node);
      const Number          square = dv * dv + v0 * v0;
      return value_of(square) > 0. ? Number(sqrt(square) - v0) : Number(0.);
    }

    /// Derivatives of  weight * normal_force * sliding_speed.
    ContactNodeBar reverse_work(const ContactNode<double> &node, const ContactLaw<double> &law, double weight)
    {
      const double   N = normal_force(node, law), speed = sliding_speed(node, law.v0);
      ContactNodeBar bar = reverse_normal_force(node, law, weight * speed);
      if (const double root = speed + law.v0; root > 0.)
      {
        reverse_kinematics(node, weight * N / root * slip(node), 0., bar);
        bar.contact.v0 += weight * N * (law.v0 / root - 1.);
      }
      return bar;
    }
  } // namespace

  DieWear::DieWear(const unsigned int                 die,
                   const Wear                         wear,
                   const PathWindow                  &window,
                   const std::optional<SmoothRegion> &region)
      : die_(die), wear_(wear), window_(window), region_(region)
  {
    window.check("Die wear");
    if (region)
      region->check("Die wear");
  }

  std::map<std::string, double> DieWear::details(const PathRows<double> &rows) const
  {
    double work = 0., area = 0., square = 0.;
    for (const PathRow<double> &row : rows)
    {
      const auto of_row = terms(row, 1.);
      work += of_row[0];
      area += of_row[1];
      square += of_row[2];
    }
    return {{"total [mJ]", work}, {"area [mm^2]", area > 0. ? square / area : 0.}};
  }

  template <typename Number>
  std::vector<Number> DieWear::compute_integrals(const EquilibriumView<Number> &view) const
  {
    const Equilibrium<Number> &stage  = view.stage;
    const ContactLaw<Number>  &law    = stage.physics.contact;
    const double               larger = surface_over_S(stage.contact);
    std::vector<Number>        sums(2, Number(0.));
    for (unsigned int p = 0; p < stage.contact.pairs.size(); ++p)
      if (is_of_die(view, p, die_))
      {
        const ContactPoint       &point  = stage.contact.pairs[p].point;
        const ContactNode<Number> node   = stage.contact_node(p, view.W, view.active);
        const Number              inside = weight_in(region_, point.position(stage.X));
        sums[0] += inside * normal_force(node, law) * sliding_speed(node, law.v0);
        if (point.is_node())
          sums[1] += inside * larger * stage.areas.S[p] * stage.contact.ramps[p];
      }
    return sums;
  }

  void DieWear::reverse_integrals(const EquilibriumView<double> &view,
                                  const std::vector<double>     &weights,
                                  EquilibriumBar                &bar) const
  {
    const Equilibrium<double> &stage  = view.stage;
    const ContactLaw<double>  &law    = stage.physics.contact;
    const double               larger = surface_over_S(stage.contact);
    ContactPullback            pullback(view, bar);
    for (unsigned int p = 0; p < stage.contact.pairs.size(); ++p)
      if (is_of_die(view, p, die_))
      {
        const ContactPoint       &point  = stage.contact.pairs[p].point;
        const ContactNode<double> node   = stage.contact_node(p, view.W, view.active);
        const Vec3                x      = point.position(stage.X);
        const double              inside = weight_in(region_, x);
        double         inside_bar        = weights[0] * normal_force(node, law) * sliding_speed(node, law.v0);
        ContactNodeBar node_bar          = reverse_work(node, law, weights[0] * inside);
        if (point.is_node())
        {
          const double per_area = weights[1] * larger, S = stage.areas.S[p], ramp = stage.contact.ramps[p];
          node_bar.S += per_area * inside * ramp;
          bar.contact.ramp[p] += per_area * inside * S;
          inside_bar += per_area * S * ramp;
        }
        pullback.add(p, node_bar);
        if (region_)
          point.add_to_position(Vec3(inside_bar * region_->gradient(x)), bar.X);
      }
    pullback.finish();
  }

  template std::vector<double> DieWear::compute_integrals(const EquilibriumView<double> &) const;
  template std::vector<Dual>   DieWear::compute_integrals(const EquilibriumView<Dual> &) const;

  namespace
  {
    struct DieWearType : ObjectiveType
    {
      DieSetting     die;
      Wear           wear = Wear::mean;
      WindowSettings window;
      RegionSettings region;

      void add_parameters(dealii::ParameterHandler &prm) override
      {
        die.add_parameters(prm);
        add_enum<Wear>(prm,
                       "wear",
                       wear,
                       {{"mean", Wear::mean}, {"total", Wear::total}},
                       "The wear of a die is its mean over the area in contact, or all of it. Units: none.");
        window.add_parameters(prm);
        region.add_parameters(prm);
      }

      void check_names(const std::string &where, const ObjectiveContext &context) const override
      {
        die.find(where, context);
      }

      void make(const std::string      &where,
                const ObjectiveContext &context,
                NamedObjective         &objective) const override
      {
        objective.scaling = wear == Wear::total ? SymmetryScaling::part : SymmetryScaling::none;
        objective.path    = std::make_unique<DieWear>(
          die.find(where, context), wear, window.make(where, context), region.make(where));
      }
    };
  } // namespace

  Choice<ObjectiveType>::Maker die_wear_type()
  {
    return {"die wear", Choice<ObjectiveType>::make<DieWearType>};
  }
} // namespace retroforge
