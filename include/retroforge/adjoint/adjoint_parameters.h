// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/element/semi_analytic.h>

#include <deal.II/base/parameter_handler.h>

namespace retroforge
{
  /// The section Adjoint.
  struct AdjointParameters
  {
    enum class Method
    {
      adjoint, ///< one backward sweep for all parameters and every node
      direct   ///< one forward sweep per parameter
    };

    /// At other values of the design.
    enum class Remeshings
    {
      follow, ///< new meshes go as the shape does, and come when the state does that they came at
      hold    ///< they go where the operations take them, at the same strokes
    };

    Method           method     = Method::adjoint;
    double           tolerance  = 1e-6;
    Remeshings       remeshings = Remeshings::follow;
    ShapeDerivatives shape_derivatives;

    void add_parameters(dealii::ParameterHandler &prm);
  };
} // namespace retroforge
