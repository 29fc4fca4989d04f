// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/contact/coulomb_friction.h>
#include <retroforge/contact/norton_friction.h>
#include <retroforge/core/registry.h>
#include <retroforge/core/text.h>

namespace retroforge
{
  namespace
  {
    Registry<InterfaceLaw> &interface_laws()
    {
      static Registry<InterfaceLaw> laws = [] {
        Registry<InterfaceLaw> all("law of friction", "Norton", std::make_unique<NortonFriction>());
        all.add("Tresca", std::make_unique<TrescaFriction>());
        all.add("Coulomb", std::make_unique<CoulombFriction>());
        return all;
      }();
      return laws;
    }
  } // namespace

  const InterfaceLaw &interface_law(const unsigned int i)
  {
    return interface_laws()[i];
  }

  unsigned int find_interface_law(const std::string &name, const std::string &where)
  {
    return interface_laws().find(name, where);
  }

  void add_interface_law(const std::string &name, std::unique_ptr<const InterfaceLaw> law)
  {
    interface_laws().add(name, std::move(law));
  }

  namespace
  {
    /// @throws Error  where there is no such law, or it has no such coefficient
    template <typename Given>
    ZoneFriction<double> friction_of(const Given &given)
    {
      const std::string   section = given.section();
      const unsigned int  number  = find_interface_law(given.friction_law, section + "/friction law");
      const InterfaceLaw &law     = interface_law(number);
      if (const NumberInfo info = law.coefficient(); given.friction > info.largest)
        throw Error(section + "/friction",
                    "is " + as_text(given.friction) + ", and the law is " + given.friction_law,
                    "its coefficient " + info.name + " is at most " + as_text(info.largest),
                    "use a smaller one, or another law");
      return {given.friction, law.limit() ? given.shear_limit : 0., number};
    }
  } // namespace

  DieState<double> initial_state(const DieParameters &die)
  {
    const ZoneFriction<double> own = friction_of(die);
    DieState<double>           state{die.velocity, Vec3(), own.friction, {}, own.interface_law};
    state.shear_limit = own.shear_limit;
    for (const DieZoneParameters &zone : die.zones)
      state.zones.push_back(friction_of(zone));
    state.temperature = die.temperature;
    return state;
  }

  namespace
  {
    /// On a unit of area, without regularisation.
    struct TypicalSliding
    {
      const ContactLaw<double>   sharp;
      const SlidingPoint<double> point;

      TypicalSliding(const ZoneFriction<double> &friction,
                     const TypicalContact       &at,
                     const MaterialLaw<double>  &metal)
          : point{1.,
                  friction.friction,
                  at.slip * at.slip,
                  at.pressure,
                  friction.shear_limit,
                  at.rate * at.rate,
                  metal,
                  sharp}
      {
      }
      TypicalSliding(const TypicalSliding &) = delete; // its members refer to each other
    };
  } // namespace

  double friction_traction(const ZoneFriction<double> &friction,
                           const TypicalContact       &at,
                           const MaterialLaw<double>  &metal)
  {
    return interface_law(friction.interface_law).factor(TypicalSliding(friction, at, metal).point) * at.slip;
  }

  bool needs_regularisation(const DieState<double> &die, const MaterialLaw<double> &metal)
  {
    return die.any_friction([&](const ZoneFriction<double> &friction) {
      return !std::isfinite(
        interface_law(friction.interface_law).factor(TypicalSliding(friction, {0., 1., 1.}, metal).point));
    });
  }

  double linear_friction(const ZoneFriction<double> &friction,
                         const TypicalContact       &at,
                         const MaterialLaw<double>  &metal,
                         const MaterialLaw<double>  &linear_metal)
  {
    return interface_law(friction.interface_law)
      .linear_coefficient(TypicalSliding(friction, at, metal).point, linear_metal);
  }

  double InterfaceLaw::potential_ratio(const SlidingPoint<double> &) const
  {
    AssertThrow(false, dealii::ExcMessage("friction without a potential"));
    return 0.;
  }

  namespace
  {
    /// Friction of one law at a point, with what it depends on.
    template <typename Number>
    struct Friction
    {
      const InterfaceLaw        &law;
      const unsigned int         zone;   ///< invalid_index: the die's own
      const Number               weight; ///< part of the area
      const Vector3<Number>      dv;
      const SlidingPoint<Number> point;
      const Number               factor;

      Friction(const ContactNode<Number>  &node,
               const unsigned int          zone,
               const Number               &weight,
               const ZoneFriction<Number> &friction,
               const MaterialLaw<Number>  &metal,
               const ContactLaw<Number>   &contact)
          : law(interface_law(friction.interface_law))
          , zone(zone)
          , weight(weight)
          , dv(slip(node))
          , point{node.zones.empty() ? node.Sf : Number(node.Sf * weight),
                  friction.friction,
                  Number(dv * dv),
                  node.active && !law.has_potential() ? Number(contact.rho * approach_excess(node))
                                                      : Number(0.),
                  friction.shear_limit,
                  node.rate2,
                  metal,
                  contact}
          , factor(law.factor(point))
      {
      }
    };

    /// use(friction) of the die's own friction and those of its zones, where they act.
    template <typename Number, typename Use>
    void for_each_friction(const ContactNode<Number> &node,
                           const MaterialLaw<Number> &metal,
                           const ContactLaw<Number>  &contact,
                           const Use                 &use)
    {
      const auto add =
        [&](const unsigned int zone, const Number &weight, const ZoneFriction<Number> &friction) {
          if (value_of(node.Sf) * value_of(weight) * value_of(friction.friction) != 0.)
            use(Friction<Number>(node, zone, weight, friction, metal, contact));
        };
      Number own(1.);
      for (const ZonePart<Number> &part : node.zones)
        own -= part.weight;
      // Weights that add up to 1 do so but for rounding.
      constexpr double rounding = 1e-14;
      if (node.zones.empty() || value_of(own) > rounding)
        add(invalid_index, own, {node.alpha, node.shear_limit, node.interface_law});
      for (unsigned int z = 0; z < node.zones.size(); ++z)
        add(z, node.zones[z].weight, node.zones[z].law);
    }

    /// Adds the derivatives, in all but the slip, of a scalar whose derivative in the factor is `factor_bar`,
    /// and factor times that in its logarithm.
    void reverse_factor(const Friction<double>    &friction,
                        const ContactNode<double> &node,
                        const double               factor_bar,
                        const double               log_bar,
                        double                    &h_bar,
                        ContactNodeBar            &bar)
    {
      SlidingBar numbers;
      friction.law.reverse(friction.point, log_bar, numbers);
      bar.Sf += log_bar / node.Sf;
      bar.zones.resize(node.zones.size());
      if (friction.zone == invalid_index)
      {
        bar.alpha += numbers.coefficient;
        bar.shear_limit += numbers.limit;
        for (ZonePart<double> &part : bar.zones)
          part.weight -= log_bar / friction.weight;
      }
      else
      {
        ZonePart<double> &part = bar.zones[friction.zone];
        part.weight += log_bar / friction.weight;
        part.law.friction += numbers.coefficient;
        part.law.shear_limit += numbers.limit;
      }
      bar.rate2 += numbers.rate2;
      add_numbers(numbers.metal, bar.law);
      add_numbers(numbers.contact, bar.contact);
      const double pressure_bar = node.active ? factor_bar * friction.law.pressure_slope(friction.point) : 0.;
      if (pressure_bar != 0.)
      {
        h_bar += pressure_bar * friction.point.contact.rho;
        bar.contact.rho += pressure_bar * approach_excess(node);
      }
    }
  } // namespace

  template <typename Number>
  Vector3<Number> contact_force(const ContactNode<Number> &node,
                                const MaterialLaw<Number> &law,
                                const ContactLaw<Number>  &contact)
  {
    Vector3<Number> force;
    if (node.active)
      force += node.n * normal_force(node, contact);
    for_each_friction(
      node, law, contact, [&](const Friction<Number> &friction) { force += friction.dv * friction.factor; });
    return force;
  }

  template <typename Number>
  Number friction_power(const ContactNode<Number> &node,
                        const MaterialLaw<Number> &law,
                        const ContactLaw<Number>  &contact)
  {
    Number power(0.);
    for_each_friction(node, law, contact, [&](const Friction<Number> &friction) {
      power += friction.factor * friction.point.slip2;
    });
    return power;
  }

  namespace
  {
    /// phi and psi of closing_moments() by t = a/u_r.
    template <typename Number>
    std::array<Number, 2> standing_parts(const Number &t, const bool sinks)
    {
      const Number part = 1. / (1. + t * t * t * t);
      return {{sinks && value_of(t) < 0. ? Number(1.) : part, part}};
    }

    /// Their derivatives.
    std::array<double, 2> standing_slopes(const double t, const bool sinks)
    {
      const double slope = -4. * t * t * t / std::pow(1. + t * t * t * t, 2);
      return {{sinks && t < 0. ? 0. : slope, slope}};
    }
  } // namespace

  template <typename Number>
  ClosingMoments<Number> closing_moments(const ContactNode<Number> &node,
                                         const ContactLaw<Number>  &contact,
                                         const Number              &rest_speed,
                                         const bool                 sinks)
  {
    const Number N = normal_force(node, contact), u = node.u * node.n;
    const Number a = approach_speed(node.delta, node.tau, node.approach);
    if (!(value_of(rest_speed) > 0.))
      return {{N, Number(N * u), Number(N * u * u), Number(0.), Number(0.)}};
    const auto [phi, psi] = standing_parts(Number(a / rest_speed), sinks);
    return {{N, Number(N * u), Number(N * u * u), Number(N * phi), Number(N * psi * a)}};
  }

  double contact_potential(const ContactNode<double> &node,
                           const MaterialLaw<double> &law,
                           const ContactLaw<double>  &contact)
  {
    double potential = 0.5 * normal_force(node, contact) * approach_excess(node);
    for_each_friction(node, law, contact, [&](const Friction<double> &friction) {
      potential += friction.factor * friction.law.potential_ratio(friction.point);
    });
    return potential;
  }

  dealii::Tensor<2, 3> contact_tangent(const ContactNode<double> &node,
                                       const MaterialLaw<double> &law,
                                       const ContactLaw<double>  &contact)
  {
    dealii::Tensor<2, 3> tangent;
    if (node.active)
      tangent += contact.rho * node.S * outer_product(node.n, node.n);
    for_each_friction(node, law, contact, [&](const Friction<double> &friction) {
      tangent -= friction.factor * outer_product(node.n, node.n);
      for (unsigned int i = 0; i < 3; ++i)
        tangent[i][i] += friction.factor;
      if (const double slope = friction.law.slip_slope(friction.point); slope != 0.)
        tangent += friction.factor * slope * outer_product(friction.dv, friction.dv);
      if (const double slope = node.active ? friction.law.pressure_slope(friction.point) : 0.; slope != 0.)
        tangent += slope * contact.rho * outer_product(friction.dv, node.n);
    });
    return tangent;
  }

  namespace
  {
    /// That of  weight * normal_force,  without the motion's: derivative in h.
    double reverse_penalty(const ContactNode<double> &node,
                           const ContactLaw<double>  &contact,
                           const double               weight,
                           ContactNodeBar            &bar)
    {
      const double h = approach_excess(node);
      bar.S += contact.rho * h * weight;
      bar.contact.rho += node.S * h * weight;
      return contact.rho * node.S * weight;
    }
  } // namespace

  ContactNodeBar reverse_normal_force(const ContactNode<double> &node,
                                      const ContactLaw<double>  &contact,
                                      const double               weight)
  {
    ContactNodeBar bar;
    if (node.active)
      reverse_kinematics(node, Vec3(), reverse_penalty(node, contact, weight, bar), bar);
    return bar;
  }

  ContactNodeBar reverse_closing_moments(const ContactNode<double>    &node,
                                         const ContactLaw<double>     &contact,
                                         const double                  rest_speed,
                                         const bool                    sinks,
                                         const ClosingMoments<double> &weights,
                                         double                       &rest_speed_bar)
  {
    if (!node.active)
      return {};
    const double N = normal_force(node, contact), u = node.u * node.n;
    double       of_N = weights[0] + u * (weights[1] + u * weights[2]), a_bar = 0.;
    const double u_bar = N * (weights[1] + 2. * u * weights[2]);
    const double a     = approach_speed(node.delta, node.tau, node.approach);
    if (rest_speed > 0.)
    {
      const double t            = a / rest_speed;
      const auto [phi, psi]     = standing_parts(t, sinks);
      const auto [phi_t, psi_t] = standing_slopes(t, sinks);
      const double of_psi = a * weights[4], t_bar = N * (phi_t * weights[3] + psi_t * of_psi);
      of_N += phi * weights[3] + psi * of_psi;
      a_bar = N * psi * weights[4] + t_bar / rest_speed;
      rest_speed_bar -= t_bar * t / rest_speed;
    }
    ContactNodeBar bar = reverse_normal_force(node, contact, of_N);
    bar.delta += a_bar * approach_slope(node.delta, node.tau, node.approach);
    bar.tau -= a_bar * a / node.tau;
    bar.u += u_bar * node.n;
    bar.n += u_bar * node.u;
    return bar;
  }

  ContactNodeBar reverse_contact_force(const ContactNode<double> &node,
                                       const MaterialLaw<double> &law,
                                       const ContactLaw<double>  &contact,
                                       const Vec3                &lambda)
  {
    ContactNodeBar bar;
    double         h_bar = 0.;
    if (node.active)
    {
      h_bar = reverse_penalty(node, contact, lambda * node.n, bar);
      bar.n = normal_force(node, contact) * lambda;
    }
    Vec3 dv_bar;
    for_each_friction(node, law, contact, [&](const Friction<double> &friction) {
      const double product = lambda * friction.dv;
      reverse_factor(friction, node, product, friction.factor * product, h_bar, bar);
      dv_bar += friction.factor * (lambda + friction.law.slip_slope(friction.point) * product * friction.dv);
    });
    reverse_kinematics(node, dv_bar, h_bar, bar);
    return bar;
  }

  ContactNodeBar reverse_friction_power(const ContactNode<double> &node,
                                        const MaterialLaw<double> &law,
                                        const ContactLaw<double>  &contact,
                                        const double               weight)
  {
    ContactNodeBar bar;
    double         h_bar = 0.;
    Vec3           dv_bar;
    bool           acts = false;
    for_each_friction(node, law, contact, [&](const Friction<double> &friction) {
      const double dv2 = friction.point.slip2, factor = weight * friction.factor;
      reverse_factor(friction, node, weight * dv2, factor * dv2, h_bar, bar);
      dv_bar += factor * (2. + friction.law.slip_slope(friction.point) * dv2) * friction.dv;
      acts = true;
    });
    if (acts)
      reverse_kinematics(node, dv_bar, h_bar, bar);
    return bar;
  }

#define RETROFORGE_INSTANTIATE(Number)                                                     \
  template Vector3<Number> contact_force(                                                  \
    const ContactNode<Number> &, const MaterialLaw<Number> &, const ContactLaw<Number> &); \
  template Number friction_power(                                                          \
    const ContactNode<Number> &, const MaterialLaw<Number> &, const ContactLaw<Number> &); \
  template ClosingMoments<Number> closing_moments(                                         \
    const ContactNode<Number> &, const ContactLaw<Number> &, const Number &, bool);
  RETROFORGE_INSTANTIATE(double)
  RETROFORGE_INSTANTIATE(Dual)
#undef RETROFORGE_INSTANTIATE
} // namespace retroforge
