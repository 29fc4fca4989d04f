// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/setting_tags.h>
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
    prm.add_parameter("triangulation",
                      triangulation,
                      "How the mesh lies on the ranks of a parallel run: shared, every rank has all cells of "
                      "deal.II's triangulation; or fully distributed, its own and those around them, which "
                      "takes less memory on many ranks. Results are the same. Units: none.",
                      dealii::Patterns::Selection("shared|fully distributed"));
    prm.add_parameter(
      "assembly",
      assembly,
      "How integrals over tetrahedra are computed: closed form, by code written for the pair of "
      "elements; or quadrature, by code for any pair, whose derivatives are those of dual "
      "numbers at the points, some ten times slower. Results are the same to rounding: one is "
      "the check of the other. Units: none.",
      dealii::Patterns::Selection("closed form|quadrature"));
    prm.add_parameter(
      "geometry degree",
      geometry_degree,
      "Degree of positions as functions on a tetrahedron: 1, or with `assembly = quadrature` 2, "
      "which gives them nodes in the middles of edges, too. These stay halfway between the ends, "
      "so that results are the same to rounding: a trial of what curved cells need. Units: none.",
      dealii::Patterns::Integer(1, 2));
    prm.leave_subsection();
    tag(prm, "Discretization", SettingRole::scene);
  }

  DiscretizationChoice DiscretizationParameters::choice() const
  {
    return {element == "mini" ? ElementPair::mini : ElementPair::taylor_hood,
            triangulation == "shared" ? TriangulationKind::shared : TriangulationKind::fully_distributed,
            assembly == "closed form" ? Assembly::closed_form : Assembly::quadrature,
            Kinematics::three_dimensions,
            static_cast<unsigned int>(geometry_degree)};
  }
} // namespace retroforge
