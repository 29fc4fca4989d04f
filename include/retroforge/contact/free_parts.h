// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/contact/contact_kinematics.h>

#include <vector>

namespace retroforge
{
  /// Returns for each node how free of dies it is, the product of 1 - w over its pairs: several dies may touch it.
  template <typename Number>
  std::vector<Number> free_parts(const ContactSet<Number> &contact, std::size_t n_nodes);

  /// Adds to the derivatives in the ramps.
  void reverse_free_parts(const ContactSet<double>  &contact,
                          const std::vector<double> &parts_bar,
                          ContactSetBar             &bar);
} // namespace retroforge
