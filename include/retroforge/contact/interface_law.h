// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/contact/contact_kinematics.h>
#include <retroforge/geometry/die_parameters.h>

#include <optional>

/// @file
/// What acts between metal and die at a point of contact: unilateral contact by a penalty, and friction by
/// the law that the die's section in the parameter file names, or that of a zone of the die. The force on the residual is
///   N n + f dv,   N = rho S [h]^+,   f = factor(S^f, coefficient, |dv|^2, N/S, numbers of the metal there, its
///   strain rate, and numbers of contact).
/// It acts on the residual, so that f is not negative: the traction on the metal is -f dv / S^f. At a point that is part of
/// zones each law has the part of S^f that the weight of its zone says, the die's own the rest: forces, powers and
/// potentials are the sums.
namespace retroforge
{
  /// Arguments of the friction law at a point.
  template <typename Number>
  struct SlidingPoint
  {
    Number area;        ///< S^f [mm^2]
    Number coefficient; ///< friction coefficient of the die: DieState::friction
    Number slip2;       ///< |dv|^2 [mm^2/s^2]
    /// N/S [MPa]; 0 where the point is not pressed, less where it is held and pulls. To a law with a
    /// potential, which cannot follow it, it is not told: 0.
    Number pressure;
    Number limit; ///< second coefficient of the die: DieState::shear_limit
    Number rate2; ///< e^2 of the metal, frozen over the increment (surface_rates.h) [1/s^2]

    const MaterialLaw<Number> &metal;
    const ContactLaw<Number>  &contact;
  };

  /// Derivatives of a scalar in the numbers of a SlidingPoint.
  struct SlidingBar
  {
    double              coefficient = 0., limit = 0., rate2 = 0.;
    MaterialLaw<double> metal;
    ContactLaw<double>  contact;
  };

  /// A law of friction for all dies that name it. It has no numbers of its own: these are the die's
  /// coefficient, and those of the metal and of contact. Laws derive from InterfaceLawOf.
  class InterfaceLaw
  {
  public:
    virtual ~InterfaceLaw() = default;

    /// Returns the die's coefficient as users know it.
    virtual NumberInfo coefficient() const = 0;

    /// Returns the second coefficient, by which the metal bounds friction, of laws that have one.
    virtual std::optional<NumberInfo> limit() const { return {}; }

    /// Tells whether friction follows the strain rate of the metal.
    virtual bool follows_rate() const { return false; }

    /// Tells whether friction is proportional to the slip.
    virtual bool is_linear(const MaterialLaw<double> &) const { return false; }

    /// Tells whether friction is the gradient in V of a potential, and its tangent symmetric. Where it follows the pressure,
    /// it is not.
    virtual bool has_potential() const = 0;

    /// Returns f [N s/mm], which is proportional to the area.
    virtual double factor(const SlidingPoint<double> &point) const = 0;
    virtual Dual   factor(const SlidingPoint<Dual> &point) const   = 0;

    /// Returns d log(f) / d|dv| over |dv|  [s^2/mm^2].
    virtual double slip_slope(const SlidingPoint<double> &point) const = 0;

    /// Returns df / d(N/S)  [mm s].
    virtual double pressure_slope(const SlidingPoint<double> &) const { return 0.; }

    /// Returns the potential over f, where there is one: d potential / d|dv| = f |dv|  [mm^2/s^2].
    virtual double potential_ratio(const SlidingPoint<double> &point) const;

    /// Adds the derivatives in the coefficients, the strain rate and the numbers of metal and contact of a scalar whose
    /// derivative in log(f) is `log_bar`. That in the penalty by way of the pressure is the caller's.
    virtual void reverse(const SlidingPoint<double> &point, double log_bar, SlidingBar &bar) const = 0;

    /// Returns the coefficient of Norton's law beside a linear metal for the same traction: a start from rest
    /// is the flow of such a metal.
    /// @param point  of area 1, at a slip and a pressure that are typical; without regularisation
    virtual double linear_coefficient(const SlidingPoint<double> &point,
                                      const MaterialLaw<double>  &linear_metal) const
    {
      return factor(point) / linear_metal.K;
    }
  };

  /// An InterfaceLaw made from class Law, which has for any Number
  ///   Number compute_factor(const SlidingPoint<Number> &) const;
  /// and the functions that InterfaceLaw leaves open.
  template <typename Law>
  class InterfaceLawOf : public InterfaceLaw
  {
  public:
    double factor(const SlidingPoint<double> &point) const override
    {
      return static_cast<const Law &>(*this).compute_factor(point);
    }
    Dual factor(const SlidingPoint<Dual> &point) const override
    {
      return static_cast<const Law &>(*this).compute_factor(point);
    }
  };

  /// Returns law number i, as DieState::interface_law counts them; 0 is Norton's.
  const InterfaceLaw &interface_law(unsigned int i);

  /// Returns the number of the law that a parameter file calls `name`.
  /// @param where  the setting that names it
  /// @throws Error  where there is none of this name
  unsigned int find_interface_law(const std::string &name, const std::string &where);

  /// Adds a law to those there are, by a new name, before anything names it.
  void add_interface_law(const std::string &name, std::unique_ptr<const InterfaceLaw> law);

  /// Returns the state that a die starts in.
  /// @throws Error  where it names no law of friction that there is, or a coefficient that its law has not
  DieState<double> initial_state(const DieParameters &die);

  /// What is typical of the metal at a die.
  struct TypicalContact
  {
    double slip;     ///< speed along the die [mm/s]
    double pressure; ///< [MPa]
    double rate;     ///< equivalent strain rate [1/s]
  };

  /// Returns the traction of friction on a die or in a zone of it, without regularisation [MPa].
  double friction_traction(const ZoneFriction<double> &friction,
                           const TypicalContact       &at,
                           const MaterialLaw<double>  &metal);

  /// Tells whether a die's friction on a point that sticks is infinitely stiff without regularisation.
  bool needs_regularisation(const DieState<double> &die, const MaterialLaw<double> &metal);

  /// Tells whether friction on a die follows the strain rate of the metal, anywhere.
  template <typename Number>
  bool follows_rate(const DieState<Number> &die)
  {
    return die.any_friction([](const ZoneFriction<Number> &friction) {
      return interface_law(friction.interface_law).follows_rate();
    });
  }

  /// Returns that friction's coefficient in Norton's law beside a linear metal, for the same traction.
  double linear_friction(const ZoneFriction<double> &friction,
                         const TypicalContact       &at,
                         const MaterialLaw<double>  &metal,
                         const MaterialLaw<double>  &linear_metal);

  /// Returns N  [N]: the die's force on the residual of a point, along its normal. A vertex of quadratic
  /// velocities that is pressed because the middles around it are may pull a little: were that cut off,
  /// derivatives would hang on its last digits.
  template <typename Number>
  Number normal_force(const ContactNode<Number> &node, const ContactLaw<Number> &contact)
  {
    return node.active ? Number(contact.rho * node.S * approach_excess(node)) : Number(0.);
  }

  /// Returns the excess h at which the normal force is `force`  [mm/s].
  inline double
  excess_under(const double force, const ContactNode<double> &node, const ContactLaw<double> &contact)
  {
    return force / (contact.rho * node.S);
  }

  template <typename Number>
  Vector3<Number> contact_force(const ContactNode<Number> &node,
                                const MaterialLaw<Number> &law,
                                const ContactLaw<Number>  &contact);

  /// f |dv|^2: power lost in friction [mJ/s], as the residual has it.
  template <typename Number>
  Number friction_power(const ContactNode<Number> &node,
                        const MaterialLaw<Number> &law,
                        const ContactLaw<Number>  &contact);

  /// (N, N u, N u^2, N phi, N psi a),  u = u·n,  a the speed at which the gap may close,
  /// psi = 1/(1 + (a/u_r)^4), phi the same, but 1 for the depth of a point that sinks under pressure, as edges do:
  /// the force that closes the gap or opens it [N], its power [mJ/s], what tells whether points close at one speed
  /// [mJ mm/s^2], and, as far as the die stands on the point, the force and its power if it closed the gap.
  template <typename Number>
  using ClosingMoments = std::array<Number, 5>;

  /// @param rest_speed  u_r, below which the die stands on a point; 0: phi is 0 [mm/s]
  /// @param sinks       whether the point does under pressure
  template <typename Number>
  ClosingMoments<Number> closing_moments(const ContactNode<Number> &node,
                                         const ContactLaw<Number>  &contact,
                                         const Number              &rest_speed,
                                         bool                       sinks);

  /// Value of the potential whose gradient in V is contact_force, where the law has one.
  double contact_potential(const ContactNode<double> &node,
                           const MaterialLaw<double> &law,
                           const ContactLaw<double>  &contact);

  /// d contact_force / dV.
  dealii::Tensor<2, 3> contact_tangent(const ContactNode<double> &node,
                                       const MaterialLaw<double> &law,
                                       const ContactLaw<double>  &contact);

  /// Derivatives of  weight * normal_force.
  ContactNodeBar
  reverse_normal_force(const ContactNode<double> &node, const ContactLaw<double> &contact, double weight);

  /// Derivatives of  lambda·contact_force.
  ContactNodeBar reverse_contact_force(const ContactNode<double> &node,
                                       const MaterialLaw<double> &law,
                                       const ContactLaw<double>  &contact,
                                       const Vec3                &lambda);

  /// Derivatives of  weights·closing_moments; that in the rest speed is added to rest_speed_bar.
  ContactNodeBar reverse_closing_moments(const ContactNode<double>    &node,
                                         const ContactLaw<double>     &contact,
                                         double                        rest_speed,
                                         bool                          sinks,
                                         const ClosingMoments<double> &weights,
                                         double                       &rest_speed_bar);

  /// Derivatives of  weight * friction_power.
  ContactNodeBar reverse_friction_power(const ContactNode<double> &node,
                                        const MaterialLaw<double> &law,
                                        const ContactLaw<double>  &contact,
                                        double                     weight);
} // namespace retroforge
