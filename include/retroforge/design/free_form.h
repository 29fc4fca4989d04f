// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/design/billet_shapes.h>

namespace retroforge
{
  /// Free form: named patches of any billet moved along their normals. The parameters are coefficients of the
  /// modes of the patches' surface (surface_modes): with as many modes as nodes every shape is there.
  /// Coefficients are in mm, of root mean square for the first.
  ///
  /// Inside the billet the moves are continued by Laplace's equation. Nodes of symmetry planes and of other
  /// patches that are plane slide in their planes; other patches stay.
  ///
  /// @return parameters `free form 1`, ... in the axes of the mesh; none where no modes are asked for
  /// @throws Error  for a patch that is not there, none named, or fewer nodes than modes
  std::vector<ShapeParameter> free_form_shapes(const FreeFormParameters &parameters, const TetMesh &mesh);
} // namespace retroforge
