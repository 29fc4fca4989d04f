// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/enum_setting.h>
#include <retroforge/core/error.h>
#include <retroforge/core/text.h>
#include <retroforge/objective/die_wear.h>
#include <retroforge/objective/largest_wear.h>
#include <retroforge/objective/objective_settings.h>
#include <retroforge/objective/pairs_of_die.h>
#include <retroforge/objective/sliding_work.h>
#include <retroforge/solver/contact_pullback.h>

namespace retroforge
{
  DieWear::DieWear(const unsigned int                 die,
                   const Wear                         wear,
                   const PathWindow                  &window,
                   const std::optional<SmoothRegion> &region)
      : die_(die), wear_(wear), window_(window), region_(region)
  {
    Assert(wear != Wear::largest, dealii::ExcMessage("the largest wear is another objective"));
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
        sums[0] += inside * sliding_work(node, law);
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
        const ContactPoint       &point      = stage.contact.pairs[p].point;
        const ContactNode<double> node       = stage.contact_node(p, view.W, view.active);
        const Vec3                x          = point.position(stage.X);
        const double              inside     = weight_in(region_, x);
        double                    inside_bar = weights[0] * sliding_work(node, law);
        ContactNodeBar            node_bar   = reverse_sliding_work(node, law, weights[0] * inside);
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
      Wear           wear      = Wear::mean;
      double         radius    = 0.;
      double         sharpness = 20.;
      WindowSettings window;
      RegionSettings region;

      void add_parameters(dealii::ParameterHandler &prm) override
      {
        die.add_parameters(prm);
        add_enum<Wear>(
          prm,
          "wear",
          wear,
          {{"mean", Wear::mean}, {"total", Wear::total}, {"largest", Wear::largest}},
          "The wear of a die is its mean over the area in contact, all of it, or the largest along "
          "the die. Units: none.");
        prm.add_parameter(
          "wear radius",
          radius,
          "The largest wear is one of means over the die within this radius; 0 for two element "
          "sizes. Units: mm.",
          dealii::Patterns::Double(0.));
        add_sharpness(prm, sharpness);
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
        const unsigned int d  = die.find(where, context);
        const PathWindow   of = window.make(where, context);
        objective.scaling     = wear == Wear::total ? SymmetryScaling::part : SymmetryScaling::none;
        if (wear == Wear::largest)
          objective.path =
            std::make_unique<LargestWear>(d,
                                          DieSites(context.dies[d],
                                                   context.billet,
                                                   context.states[context.leading_die].velocity,
                                                   reach(where, context)),
                                          sharpness,
                                          of,
                                          region.make(where));
        else
          objective.path = std::make_unique<DieWear>(d, wear, of, region.make(where));
      }

    private:
      double reach(const std::string &where, const ObjectiveContext &context) const
      {
        constexpr double in_elements = 2.;
        if (radius > 0. && radius < context.element_size)
          throw Error(where + "/wear radius",
                      "is " + as_text(radius) + " mm",
                      "metal touches the die at points that are an element size, " +
                        as_text(context.element_size) + " mm, apart, and within less there may be none",
                      "use an element size or more, or 0 for two of them");
        return radius > 0. ? radius : in_elements * context.element_size;
      }
    };
  } // namespace

  Choice<ObjectiveType>::Maker die_wear_type()
  {
    return {"die wear", Choice<ObjectiveType>::make<DieWearType>};
  }
} // namespace retroforge
