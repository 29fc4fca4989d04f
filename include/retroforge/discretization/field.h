// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/discretization/spaces.h>

namespace retroforge
{
  /// The unknowns W = (V, beta, P) of a pair's spaces, or anything dual to them. Every rank has room for
  /// all nodes and for the bubbles of the cells it visits, and is right where it works (FieldExchange).
  template <typename Number>
  struct Field
  {
    NodalVectors<Number>         V;    ///< one per velocity node
    std::vector<Vector3<Number>> beta; ///< one per bubble kept, see Spaces::bubble
    std::vector<Number>          P;    ///< one per pressure node

    Field() = default;
    explicit Field(const Spaces &spaces)
        : V(spaces.n_velocity_nodes()), beta(spaces.n_bubbles()), P(spaces.n_pressure_nodes(), Number(0.))
    {
    }

    /// this += scale * other
    void add(const Number &scale, const Field &other)
    {
      for (std::size_t k = 0; k < V.size(); ++k)
        V[k] += other.V[k] * scale;
      for (std::size_t k = 0; k < P.size(); ++k)
        P[k] += other.P[k] * scale;
      for (std::size_t c = 0; c < beta.size(); ++c)
        beta[c] += other.beta[c] * scale;
    }
  };

  /// A field without bubbles from values at the nodes of the mesh: linear along edges.
  Field<double> interpolated(const Spaces &spaces, NodalVectors<double> V, std::vector<double> P);
} // namespace retroforge
