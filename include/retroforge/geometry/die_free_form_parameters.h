// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/types.h>

#include <deal.II/base/parameter_handler.h>

#include <string>

namespace retroforge
{
  /// Smooth moves of a die's surface as design parameters: design/die_free_form.h.
  struct DieFreeFormParameters
  {
    enum class Along
    {
      facing, ///< vertices move along the die's facing
      normal  ///< vertices move along the surface's normals
    };

    unsigned int modes  = 0;
    Along        along  = Along::facing;
    double       length = 0.; ///< l of the Sobolev norm [mm]; 0: a quarter of the root of the area
    Vec3         from, to;    ///< corners of the region that moves [mm]; equal: everything
    unsigned int mirrors = 0; ///< planes through the die's axis

    void add_parameters(dealii::ParameterHandler &prm);
    /// @param shape  of the die     @throws Error
    void check(const std::string &section, const std::string &shape) const;
    bool has_region() const { return (to - from).norm() > 0.; }
  };
} // namespace retroforge
