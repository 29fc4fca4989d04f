// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/remeshing/peeled_mesh.h>

#include <optional>

namespace retroforge
{
  /// Takes cells away where the boundary crosses itself, the smallest first, until it does not: metal that is
  /// thinner than an element (a lip that the side left as it rolled onto a die, or a chord) cannot be
  /// followed by the mesh. Cells behind the crossing faces go first, then thin metal around: see thin_cells_near().
  /// A cell may go when the boundary stays a surface; those that go lose together less
  /// than the volume of a cube of the wanted length there. Nothing when it does not cross itself, or when
  /// that is not enough: then metal meets metal. What is lost of the volume is for the volume correction.
  /// @param X     current positions
  /// @param size  wanted length of edges at a point
  /// Deterministic. To be called with the same arguments on all ranks or on one.
  std::optional<RepairedMesh> uncross(const TetMesh                             &mesh,
                                      const NodalVectors<double>                &X,
                                      const std::function<double(const Vec3 &)> &size);
} // namespace retroforge
