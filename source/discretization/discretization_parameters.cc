// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/enum_setting.h>
#include <retroforge/core/setting_tags.h>
#include <retroforge/discretization/discretization_parameters.h>

namespace retroforge
{
  void DiscretizationParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.enter_subsection("Discretization");
    add_enum<ElementPair>(
      prm,
      "element",
      choice.pair,
      {{"mini", ElementPair::mini}, {"P2-P1", ElementPair::taylor_hood}},
      "Velocity and pressure in each tetrahedron: mini, linear with a bubble, and linear; or "
      "P2-P1, quadratic and linear (Taylor-Hood), which needs far larger elements for the same "
      "accuracy where dies and billet are flat; where dies are curved it may come to a small error of the "
      "energy sooner, and takes longer to a gradient (manual: which pair when). Units: none.");
    add_enum<TriangulationKind>(
      prm,
      "triangulation",
      choice.triangulation,
      {{"by ranks", TriangulationKind::by_ranks},
       {"shared", TriangulationKind::shared},
       {"fully distributed", TriangulationKind::fully_distributed}},
      "How the mesh lies on the ranks of a parallel run: shared, every rank has all cells of "
      "deal.II's triangulation; fully distributed, its own and those around them, which "
      "takes less memory; or by ranks, shared on one rank and fully distributed on several. "
      "Results are the same. Units: none.");
    add_enum<Assembly>(
      prm,
      "assembly",
      choice.assembly,
      {{"closed form", Assembly::closed_form}, {"quadrature", Assembly::quadrature}},
      "How integrals over tetrahedra are computed: closed form, by code written for the pair of "
      "elements; or quadrature, by code for any pair, whose derivatives are those of dual "
      "numbers at the points, some ten times slower. Results are the same to rounding: one is "
      "the check of the other. Units: none.");
    prm.add_parameter(
      "geometry degree",
      choice.geometry_degree,
      "Degree of positions as functions on a tetrahedron: 1, or with `assembly = quadrature` 2, "
      "which gives them nodes in the middles of edges, too. These stay halfway between the ends, "
      "so that results are the same to rounding: a trial of what curved cells need. Units: none.",
      dealii::Patterns::Integer(1, 2));
    prm.leave_subsection();
    tag(prm, "Discretization", SettingRole::scene);
  }
} // namespace retroforge
