// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/contact/contact_kinematics.h>

/// @file
/// Unilateral contact at points of the surface, and Norton friction lumped at its nodes. The force on the
/// residual is
///   rho S [h]^+ n  +  S^f alpha K (|dv|^2 + v0^2)^((m-1)/2) dv.       @cite Laroussi2003, Eq. (21),
///   (40)-(49)
namespace retroforge
{
  template <typename Number>
  Vector3<Number> contact_force(const ContactNode<Number> &node,
                                const MaterialLaw<Number> &law,
                                const ContactLaw<Number>  &contact);

  /// tau·dv S^f: power lost in friction [mJ/s], as the residual has it.
  template <typename Number>
  Number friction_power(const ContactNode<Number> &node,
                        const MaterialLaw<Number> &law,
                        const ContactLaw<Number>  &contact);

  /// Value of the potential whose gradient in V is contact_force.
  double contact_potential(const ContactNode<double> &node,
                           const MaterialLaw<double> &law,
                           const ContactLaw<double>  &contact);

  /// d contact_force / dV, symmetric.
  dealii::Tensor<2, 3> contact_tangent(const ContactNode<double> &node,
                                       const MaterialLaw<double> &law,
                                       const ContactLaw<double>  &contact);

  /// Derivatives of  lambda·contact_force.
  ContactNodeBar reverse_contact_force(const ContactNode<double> &node,
                                       const MaterialLaw<double> &law,
                                       const ContactLaw<double>  &contact,
                                       const Vec3                &lambda);

  /// Derivatives of  weight * friction_power.
  ContactNodeBar reverse_friction_power(const ContactNode<double> &node,
                                        const MaterialLaw<double> &law,
                                        const ContactLaw<double>  &contact,
                                        double                     weight);
} // namespace retroforge
