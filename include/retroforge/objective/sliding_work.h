// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/contact/interface_law.h>

namespace retroforge
{
  /// |dv| = sqrt(dv^2 + v_0^2) - v_0 of a contact point [mm/s], zero where it sticks.
  template <typename Number>
  Number sliding_speed(const ContactNode<Number> &node, const Number &v0)
  {
    using std::sqrt;
    const Vector3<Number> dv     = slip(node);
    const Number          square = dv * dv + v0 * v0;
    return value_of(square) > 0. ? Number(sqrt(square) - v0) : Number(0.);
  }

  /// N |dv|, by which the die wears there [mW].
  template <typename Number>
  Number sliding_work(const ContactNode<Number> &node, const ContactLaw<Number> &law)
  {
    return normal_force(node, law) * sliding_speed(node, law.v0);
  }

  /// Returns the derivatives of  weight * sliding_work().
  inline ContactNodeBar
  reverse_sliding_work(const ContactNode<double> &node, const ContactLaw<double> &law, const double weight)
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
} // namespace retroforge
