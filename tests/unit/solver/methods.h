// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/solver/saddle_solver.h>

#include <map>
#include <string>

namespace retroforge
{
  /// Returns the method of linear solves that a test prints as `word`.
  inline LinearSolverParameters::Method method_of(const std::string &word)
  {
    using Method                                       = LinearSolverParameters::Method;
    static const std::map<std::string, Method> methods = {{"auto", Method::automatic},
                                                          {"ilu", Method::ilu},
                                                          {"multigrid", Method::multigrid},
                                                          {"direct", Method::direct}};
    return methods.at(word);
  }
} // namespace retroforge
