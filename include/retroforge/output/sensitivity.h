// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/adjoint/objective_sensitivity.h>
#include <retroforge/design/design.h>

namespace retroforge
{
  /// The derivatives by all nodes of the billet, as sensitivity.vtu, and by all vertices of each die that has
  /// some, as sensitivity_die_NAME.vtu.  @throws Error  if a file cannot be written
  void write_sensitivity(const std::string                       &directory,
                         const TetMesh                           &billet,
                         const NodalVectors<double>              &X_0,
                         const std::vector<Die>                  &dies,
                         const std::vector<ObjectiveSensitivity> &sensitivities);
} // namespace retroforge
