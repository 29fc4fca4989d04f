// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/element/mini_element.h>
#include <retroforge/element/taylor_hood.h>

namespace retroforge
{
  /// Strain rates eps = sym grad v [1/s] at the corners of a cell, without the bubble: what the mini element
  /// has in common with its neighbours is linear, and its rates are constant.
  PointRates<double> corner_strain_rates(const CellGeometry<double> &geometry, const CellValues<double> &w);

  /// Returns the strain rates of a quadratic velocity at the corners: they are linear in the cell, so that
  /// the corners determine them.
  PointRates<double> corner_strain_rates(const CellGeometry<double>     &geometry,
                                         const TaylorHoodValues<double> &w);
} // namespace retroforge
