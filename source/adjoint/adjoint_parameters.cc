// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/adjoint/adjoint_parameters.h>
#include <retroforge/core/enum_setting.h>
#include <retroforge/core/setting_tags.h>

namespace retroforge
{
  void AdjointParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.enter_subsection("Adjoint");
    add_enum<Method>(prm,
                     "method",
                     method,
                     {{"adjoint", Method::adjoint}, {"direct", Method::direct}},
                     "How `gradient` differentiates: adjoint, one backward sweep for all parameters and "
                     "every node; or direct, "
                     "one forward sweep per parameter for all objectives, without the nodes. Units: none.");
    prm.add_parameter("tolerance",
                      tolerance,
                      "Relative tolerance of the adjoint and tangent linear systems. Units: none.",
                      dealii::Patterns::Double(1e-14, 1e-2));
    add_enum<Remeshings>(
      prm,
      "remeshings",
      remeshings,
      {{"hold", Remeshings::hold}, {"follow", Remeshings::follow}},
      "What derivatives and replays do at other values of the design where the mesh was made anew. "
      "follow: new meshes go as the shape does, not along with the metal, and come sooner where quality "
      "asked for them and the metal is strained farther, which gives the trend across runs that decide "
      "anew. hold: they go where the operations of the run take them, at the same strokes, which gives the "
      "slope between two jumps (manual, gradients). Units: none.");
    using Derivatives = ShapeDerivatives::Method;
    add_enum<Derivatives>(
      prm,
      "derivatives",
      shape_derivatives.method,
      {{"exact", Derivatives::exact},
       {"semi-analytic", Derivatives::forward},
       {"semi-analytic central", Derivatives::central}},
      "How residual and dissipation are differentiated in the positions of the nodes: exact, or by "
      "differences inside the elements (semi-analytic), to compare with. Units: none.");
    prm.add_parameter(
      "perturbation",
      shape_derivatives.perturbation,
      "Step of the semi-analytic derivatives, relative to the size of the element. Units: none.",
      dealii::Patterns::Double(1e-15, 1e-1));
    prm.leave_subsection();
    tag(prm, "Adjoint", SettingRole::results);
    tag(prm,
        "Adjoint/derivatives",
        ReadBy{{"semi-analytic", {"perturbation"}}, {"semi-analytic central", {"perturbation"}}});
  }
} // namespace retroforge
