// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/design/billet_shapes.h>

namespace retroforge
{
  /// The mesh that forgings of a billet begin with, and how its nodes follow the shape,
  ///   X_0(mu) = X + sum_j (mu_j - at_j) dX_0/dmu_j.
  struct FirstMesh
  {
    TetMesh      mesh;
    BilletShapes shapes; ///< parameters of the billet's kind, then of the free form; in the axes of the mesh
    std::vector<double> at; ///< values of the shapes' parameters that the mesh was made with
  };

  /// A mesh made at the nominal values of the shape.   @throws Error  for a free form that cannot be
  FirstMesh first_mesh(const BilletParameters &billet, const TetMesh &mesh);

  /// Returns the parameters of a billet's measures with their directions at the nodes of a mesh at X, which
  /// was made with these measures.
  std::vector<ShapeParameter> shape_parameters(const BilletParameters &billet, const NodalVectors<double> &X);
} // namespace retroforge
