// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/case/parameters.h>

namespace retroforge
{
  /// A sixth of a cylinder between planes, on a coarse mesh.
  inline Parameters cylinder_scene()
  {
    Parameters p;
    p.billet.shape           = BilletParameters::Shape::cylinder;
    p.billet.radius          = 20.;
    p.billet.height          = 24.;
    p.billet.symmetry_planes = {Vec3({0., -1., 0.}), Vec3({-std::sqrt(0.75), 0.5, 0.})};
    p.billet.element_size    = 7.;
    p.dies                   = {DieParameters("lower"), DieParameters("upper")};
    p.dies[0].facing         = Vec3({0., 0., 1.});
    p.dies[1].facing         = Vec3({0., 0., -1.});
    p.dies[1].point          = Vec3({0., 0., 24.});
    p.dies[1].velocity       = Vec3({0., 0., -100.});
    p.dies[0].friction       = 0.4;
    p.dies[1].friction       = 0.3;
    p.material.law.e0        = 0.3;
    p.press.stroke           = 3.;
    p.press.increments       = 4;
    p.contact.penetration    = 1e-2;
    p.contact.slip_fraction  = 0.1;
    p.newton.tolerance       = 1e-12;
    p.adjoint.tolerance      = 1e-13;
    p.linear_solver.method   = LinearSolverParameters::Method::direct;
    return p;
  }

  /// The same between tripods.
  inline Parameters tripod_scene()
  {
    Parameters p          = cylinder_scene();
    p.billet.element_size = 5.;
    for (DieParameters &die : p.dies)
    {
      auto &tripod           = die.shape.choose<TripodDie>();
      tripod.chord_error     = 0.3;
      tripod.feature_angle   = 40.; // for facets as coarse as these
      tripod.largest_sagitta = 1.;
      tripod.shape           = {{}, 10., 10., 46., 4., 60., {5., 20., 2., 2.}};
    }
    return p;
  }

  /// The same under a bell.
  inline Parameters bell_scene()
  {
    Parameters p         = cylinder_scene();
    auto      &bell      = p.dies[1].shape.choose<BellDie>();
    bell.chord_error     = 0.3;
    bell.feature_angle   = 40.;
    bell.largest_sagitta = 1.;
    bell.shape           = {{}, 30., 50., {6., 60., 2., 14.}};
    p.dies[1].point      = Vec3({0., 0., 18.9});
    p.press.stroke       = 2.4;
    return p;
  }
} // namespace retroforge
