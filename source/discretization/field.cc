// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/discretization/field.h>

namespace retroforge
{
  Field<double> interpolated(const Spaces &spaces, NodalVectors<double> V, std::vector<double> P)
  {
    Field<double> W(spaces);
    W.V = std::move(V);
    W.P = std::move(P);
    if (spaces.edges())
      for (const auto &[a, b] : spaces.edges()->nodes)
        W.V.push_back(0.5 * (W.V[a] + W.V[b]));
    return W;
  }
} // namespace retroforge
