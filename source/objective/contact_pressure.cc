// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/objective/contact_pressure.h>
#include <retroforge/objective/objective_settings.h>
#include <retroforge/objective/pairs_of_die.h>
#include <retroforge/solver/contact_pullback.h>

namespace retroforge
{
  namespace
  {
    /// Returns whether pair p is one of the die's, at a node of this rank.
    template <typename Number>
    bool is_mine(const EquilibriumView<Number> &view, const unsigned int p, const unsigned int die)
    {
      return view.stage.contact.pairs[p].point.is_node() && is_of_die(view, p, die);
    }

    constexpr unsigned int none = invalid_index;

    /// Returns for each node its pair with the die, invalid_index where it has none.
    template <typename Number>
    std::vector<unsigned int> pairs_of_nodes(const EquilibriumView<Number> &view, const unsigned int die)
    {
      std::vector<unsigned int> pairs(view.stage.scene.mesh.n_nodes(), none);
      for (unsigned int p = 0; p < view.stage.contact.pairs.size(); ++p)
        if (const ContactPair &pair = view.stage.contact.pairs[p]; pair.die == die && pair.point.is_node())
          pairs[pair.point.nodes[0]] = p;
      return pairs;
    }

    /// Returns whether pair p is one of the die's, and its force counts for the pressure at a node of this
    /// rank. Shares of a force go to the nodes that the point lies between, whichever rank has its velocity.
    template <typename Number>
    bool counts(const EquilibriumView<Number> &view, const unsigned int p, const unsigned int die)
    {
      const ContactPair &pair           = view.stage.contact.pairs[p];
      const auto        &discretization = view.stage.scene.discretization;
      return pair.die == die && (discretization.owns(pair.point.nodes[0]) ||
                                 (!pair.point.is_node() && discretization.owns(pair.point.nodes[1])));
    }

    /// Returns for each pair of a node of this rank: its force and half of those of the edges at it, over a
    /// third of the surface there [MPa].
    template <typename Number>
    std::vector<Number> nodal_pressures(const EquilibriumView<Number> &view, const unsigned int die)
    {
      const Equilibrium<Number>      &stage  = view.stage;
      const std::vector<unsigned int> of     = pairs_of_nodes(view, die);
      const double                    larger = surface_over_S(stage.contact);
      std::vector<Number>             pressure(stage.contact.pairs.size(), Number(0.));
      for (unsigned int p = 0; p < stage.contact.pairs.size(); ++p)
        if (const ContactPair &pair = stage.contact.pairs[p]; counts(view, p, die))
        {
          const Number force =
            normal_force(stage.contact_node(p, view.W, view.active), stage.physics.contact);
          for (unsigned int i = 0; i < pair.point.n_nodes(); ++i)
            if (const unsigned int q = of[pair.point.nodes[i]]; q != none)
              pressure[q] += pair.point.weight() * force / (larger * stage.areas.S[q]);
        }
      return pressure;
    }
  } // namespace

  ContactPressure::ContactPressure(const unsigned int die, const double exponent, const double reference)
      : PathMaximumOf("Contact pressure", exponent, reference), die_(die)
  {
  }

  template <typename Number>
  std::vector<Number> ContactPressure::compute_integrals(const EquilibriumView<Number> &view) const
  {
    const Equilibrium<Number> &stage    = view.stage;
    const auto                 pressure = nodal_pressures(view, die_);
    const double               larger   = surface_over_S(stage.contact);
    std::vector<Number>        sums(2, Number(0.));
    for (unsigned int p = 0; p < stage.contact.pairs.size(); ++p)
      if (is_mine(view, p, die_))
      {
        const Number surface = larger * stage.areas.S[p];
        sums[0] += surface * raised(pressure[p]);
        sums[1] += surface * stage.contact.ramps[p];
      }
    return sums;
  }

  void ContactPressure::reverse_integrals(const EquilibriumView<double> &view,
                                          const std::vector<double>     &weights,
                                          EquilibriumBar                &bar) const
  {
    const Equilibrium<double> &stage    = view.stage;
    const auto                 pressure = nodal_pressures(view, die_);
    const auto                 of       = pairs_of_nodes(view, die_);
    const double               larger   = surface_over_S(stage.contact);
    ContactPullback            pullback(view, bar);
    std::vector<double>        force_bar(pressure.size(), 0.); ///< of the force on the node of a pair
    for (unsigned int p = 0; p < pressure.size(); ++p)
      if (is_mine(view, p, die_))
      {
        // A (F/A)^e,  A = larger S
        ContactNodeBar node_bar;
        node_bar.S = larger * (weights[0] * (1. - exponent()) * raised(pressure[p]) +
                               weights[1] * stage.contact.ramps[p]);
        bar.contact.ramp[p] += weights[1] * larger * stage.areas.S[p];
        pullback.add(p, node_bar);
        force_bar[p] = weights[0] * slope(pressure[p]);
      }
    for (unsigned int p = 0; p < pressure.size(); ++p)
      if (const ContactPair &pair = stage.contact.pairs[p]; counts(view, p, die_))
      {
        double of_point = 0.;
        for (unsigned int i = 0; i < pair.point.n_nodes(); ++i)
          if (const unsigned int q = of[pair.point.nodes[i]]; q != none)
            of_point += pair.point.weight() * force_bar[q];
        if (of_point != 0.)
          pullback.add(p,
                       reverse_normal_force(
                         stage.contact_node(p, view.W, view.active), stage.physics.contact, of_point));
      }
    pullback.finish();
  }

  template std::vector<double> ContactPressure::compute_integrals(const EquilibriumView<double> &) const;
  template std::vector<Dual>   ContactPressure::compute_integrals(const EquilibriumView<Dual> &) const;

  namespace
  {
    struct ContactPressureType : ObjectiveType
    {
      DieSetting die;
      double     sharpness = 20.;

      void add_parameters(dealii::ParameterHandler &prm) override
      {
        die.add_parameters(prm);
        add_sharpness(prm, sharpness);
      }

      void make(const std::string      &where,
                const ObjectiveContext &context,
                NamedObjective         &objective) const override
      {
        objective.path =
          std::make_unique<ContactPressure>(die.find(where, context), sharpness, context.consistency);
      }
    };
  } // namespace

  Choice<ObjectiveType>::Maker contact_pressure_type()
  {
    return {"contact pressure", Choice<ObjectiveType>::make<ContactPressureType>};
  }
} // namespace retroforge
