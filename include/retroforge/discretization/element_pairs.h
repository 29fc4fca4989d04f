// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/discretization/field.h>
#include <retroforge/element/mini_element.h>
#include <retroforge/element/taylor_hood.h>

/// @file
/// Cells of fields. What is done cell by cell is written once, as a function of a pair,
///   with_pair(spaces, [&](const auto pair) { ... cell_residual(geometry, pair.on_cell(spaces, W, c), law)
///   ...
///   });
/// for the kernels of all pairs have the same names.
namespace retroforge
{
  struct MiniPair
  {
    template <typename Number>
    using Values = CellValues<Number>;

    /// Without the bubble, which is zero: of any cell where V and P are complete.
    template <typename Number>
    static CellValues<Number> at_nodes(const Spaces &spaces, const Field<Number> &W, const CellIndex c)
    {
      const NodeIndex   *nodes = spaces.velocity_nodes(c);
      CellValues<Number> w;
      for (unsigned int a = 0; a < 4; ++a)
      {
        w.V[a] = W.V[nodes[a]];
        w.P[a] = W.P[nodes[a]];
      }
      return w;
    }

    /// Of a visited cell.
    template <typename Number>
    static CellValues<Number> on_cell(const Spaces &spaces, const Field<Number> &W, const CellIndex c)
    {
      CellValues<Number> w = at_nodes(spaces, W, c);
      w.beta               = W.beta[spaces.bubble(c)];
      return w;
    }

    /// The transpose of on_cell.
    template <typename Number>
    static void add(const Spaces &spaces, const CellValues<Number> &w, const CellIndex c, Field<Number> &W)
    {
      const NodeIndex *nodes = spaces.velocity_nodes(c);
      for (unsigned int a = 0; a < 4; ++a)
      {
        W.V[nodes[a]] += w.V[a];
        W.P[nodes[a]] += w.P[a];
      }
      W.beta[spaces.bubble(c)] += w.beta;
    }
  };

  struct TaylorHoodPair
  {
    template <typename Number>
    using Values = TaylorHoodValues<Number>;

    template <typename Number>
    static TaylorHoodValues<Number> at_nodes(const Spaces &spaces, const Field<Number> &W, const CellIndex c)
    {
      return on_cell(spaces, W, c);
    }

    template <typename Number>
    static TaylorHoodValues<Number> on_cell(const Spaces &spaces, const Field<Number> &W, const CellIndex c)
    {
      const NodeIndex         *nodes = spaces.velocity_nodes(c);
      TaylorHoodValues<Number> w;
      for (unsigned int a = 0; a < 10; ++a)
        w.V[a] = W.V[nodes[a]];
      for (unsigned int a = 0; a < 4; ++a)
        w.P[a] = W.P[nodes[a]];
      return w;
    }

    /// The transpose of on_cell.
    template <typename Number>
    static void
    add(const Spaces &spaces, const TaylorHoodValues<Number> &w, const CellIndex c, Field<Number> &W)
    {
      const NodeIndex *nodes = spaces.velocity_nodes(c);
      for (unsigned int a = 0; a < 10; ++a)
        W.V[nodes[a]] += w.V[a];
      for (unsigned int a = 0; a < 4; ++a)
        W.P[nodes[a]] += w.P[a];
    }
  };

  /// f(MiniPair()) or f(TaylorHoodPair()).
  template <typename F>
  decltype(auto) with_pair(const Spaces &spaces, const F &f)
  {
    return spaces.pair() == ElementPair::mini ? f(MiniPair()) : f(TaylorHoodPair());
  }

  template <typename Number>
  Four<Vector3<Number>>
  positions_of_cell(const TetMesh &mesh, const NodalVectors<Number> &X, const CellIndex c)
  {
    const auto &nodes = mesh.cells[c];
    return {{X[nodes[0]], X[nodes[1]], X[nodes[2]], X[nodes[3]]}};
  }

  template <typename Number>
  CellGeometry<Number> geometry_of_cell(const TetMesh &mesh, const NodalVectors<Number> &X, const CellIndex c)
  {
    return cell_geometry(positions_of_cell(mesh, X, c));
  }
} // namespace retroforge
