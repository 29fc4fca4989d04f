// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include "../material/hot_metals.h"
#include "recorded_run.h"

namespace retroforge
{
  /// The tilted block of hot metal with a third die, which stands in the second operation.
  inline Parameters block_of_two_strokes()
  {
    Parameters p = conducting(tilted_block());
    p.dies.emplace_back("second");
    p.dies[2].point       = Vec3({0., 0., 30.});
    p.dies[2].facing      = Vec3({0.029809, -0.049900, -0.998309});
    p.dies[2].velocity    = Vec3({0., 0., -80.});
    p.dies[2].friction    = 0.4;
    p.dies[2].temperature = 60.;
    p.press.scheme        = "euler";
    return p;
  }

  /// It is forged under one die, then, after a time in air and one on the lower die, under the other.
  /// @param given  the objectives; those of the parameters when it is empty
  inline ForgingProblem two_strokes(const Parameters &p, const Meshes meshes, Objectives given)
  {
    ForgingProblem problem = problem_between(
      resolved(p, meshes), {p.dies[0].die(), p.dies[1].die(), p.dies[2].die()}, std::move(given), {});
    Operation<double> operation = problem.process.operations.front();
    operation.dies              = {0, 1};
    operation.leading_die       = 1;
    operation.stroke            = 3.;
    problem.process.operations  = {operation, {{0, 2}, 2, 1., {}, 2., {0.4, 0.2, 0}}};
    return problem;
  }
} // namespace retroforge
