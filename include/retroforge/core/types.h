// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/base/tensor.h>

#include <vector>

/// Simulation of hot metal forging and its exact gradients.
namespace retroforge
{
  /// A point or vector of space, components on the fixed axes.
  template <typename Number>
  using Vector3 = dealii::Tensor<1, 3, Number>;
  using Vec3    = Vector3<double>;

  /// One vector per node (velocity, position, ...), indexed by node.
  template <typename Number>
  using NodalVectors = std::vector<Vector3<Number>>;

  using NodeIndex = unsigned int;
  using CellIndex = unsigned int;

  inline constexpr unsigned int invalid_index = static_cast<unsigned int>(-1);
} // namespace retroforge
