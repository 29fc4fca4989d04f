// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/discretization/discretization_parameters.h>

namespace retroforge
{
  void DiscretizationParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.enter_subsection("Discretization");
    prm.add_parameter(
      "element",
      element,
      "Velocity and pressure in each tetrahedron: mini, linear with a bubble, and linear; or "
      "P2-P1, quadratic and linear (Taylor-Hood), which needs far larger elements for the same "
      "accuracy where dies and billet are flat; where they are curved, flat faces limit both alike, "
      "and P2-P1 has the smoother gradients. Units: none.",
      dealii::Patterns::Selection("mini|P2-P1"));
    prm.leave_subsection();
  }

  ElementPair DiscretizationParameters::pair() const
  {
    return element == "mini" ? ElementPair::mini : ElementPair::taylor_hood;
  }
} // namespace retroforge
