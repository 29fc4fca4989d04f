// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/contact/contact_kinematics.h>
#include <retroforge/objective/box.h>

#include <optional>

namespace retroforge
{
  /// A weight that is 1 in a box and falls smoothly to 0 within `width` [mm] around it, so that what enters
  /// the box changes nothing suddenly:  prod_i w(low_i - x_i) w(x_i - high_i),  w the smooth FrictionRamp.
  struct SmoothRegion
  {
    Box    box;
    double width;

    /// @throws Error
    void check(const std::string &where) const;

    template <typename Number>
    Number operator()(const Vector3<Number> &x) const;

    /// Returns the gradient in x.
    Vec3 gradient(const Vec3 &x) const;
  };

  /// Returns the weight in a region, 1 without one.
  template <typename Number>
  Number weight_in(const std::optional<SmoothRegion> &region, const Vector3<Number> &x)
  {
    return region ? (*region)(x) : Number(1.);
  }
} // namespace retroforge
