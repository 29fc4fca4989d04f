// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/steps/increment.h>

namespace retroforge
{
  /// What all meshes of a run have in common.
  struct ForgingModel
  {
    DiscretizationChoice   discretization;
    std::vector<Die>       dies;
    StepModel              step;
    NewtonParameters       newton;
    LinearSolverParameters linear_solver;
    MPI_Comm               comm;
  };

  /// One mesh and all that works on it: the part of a run between two remeshings.
  struct MeshEpoch
  {
    Scene        scene;
    LinearSystem system;
    Increment    increment;

    MeshEpoch(TetMesh mesh, const ForgingModel &model, Timings &timings)
        : scene(std::move(mesh), model.discretization, model.dies, model.comm)
        , system(scene, model.linear_solver, timings)
        , increment(scene, model.step, model.newton, system, timings)
    {
    }
    MeshEpoch(const MeshEpoch &) = delete; // its members refer to each other
  };
} // namespace retroforge
