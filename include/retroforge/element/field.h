// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/element/mini_element.h>
#include <retroforge/mesh/tet_mesh.h>

namespace retroforge
{
  /// The unknowns W = (V, beta, P) of a mesh, or anything dual to them. The same on every rank.
  template <typename Number>
  struct Field
  {
    NodalVectors<Number>         V;
    std::vector<Vector3<Number>> beta; ///< one per cell
    std::vector<Number>          P;

    Field() = default;
    explicit Field(const TetMesh &mesh)
        : V(mesh.n_nodes()), beta(mesh.n_cells()), P(mesh.n_nodes(), Number(0.))
    {
    }

    CellValues<Number> on_cell(const TetMesh &mesh, const CellIndex c) const
    {
      CellValues<Number> w;
      for (unsigned int a = 0; a < 4; ++a)
      {
        w.V[a] = V[mesh.cells[c][a]];
        w.P[a] = P[mesh.cells[c][a]];
      }
      w.beta = beta[c];
      return w;
    }

    /// this += scale * other
    void add(const Number &scale, const Field &other)
    {
      for (std::size_t k = 0; k < V.size(); ++k)
      {
        V[k] += other.V[k] * scale;
        P[k] += other.P[k] * scale;
      }
      for (std::size_t c = 0; c < beta.size(); ++c)
        beta[c] += other.beta[c] * scale;
    }
  };

  template <typename Number>
  Four<Vector3<Number>>
  positions_of_cell(const TetMesh &mesh, const NodalVectors<Number> &X, const CellIndex c)
  {
    const auto &nodes = mesh.cells[c];
    return {{X[nodes[0]], X[nodes[1]], X[nodes[2]], X[nodes[3]]}};
  }
} // namespace retroforge
