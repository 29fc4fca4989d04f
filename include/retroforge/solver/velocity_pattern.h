// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/discretization/discretization.h>

namespace retroforge
{
  /// For each of this rank's velocity nodes the indices of those that it meets in a cell, itself included,
  /// ascending, as DoFTools finds them on the DoFHandler of the velocities; without bubbles. Collective.
  template <int dim>
  Rows<unsigned int> velocity_pattern(const Discretization<dim> &discretization);
} // namespace retroforge
