// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/discretization/field.h>
#include <retroforge/element/mini_element.h>
#include <retroforge/element/quadrature_cell.h>
#include <retroforge/element/taylor_hood.h>

/// @file
/// Cells of fields. What is done cell by cell is written once, as a function of a pair,
///   dispatch_element(discretization, [&](const auto pair) {
///     const auto geometry = cell_geometry(pair.positions(discretization, X, c));
///     ... cell_residual(geometry, pair.on_cell(discretization, W, c), law) ...
///   });
/// for the kernels of all pairs have the same names. A rank does so with the cells that it visits. In two
/// dimensions there are those by quadrature.
namespace retroforge
{
  /// Returns the positions of the geometry nodes of a visited cell.
  template <typename Number>
  Four<Vector3<Number>>
  positions_of_cell(const Discretization<3> &discretization, const NodalVectors<Number> &X, const CellIndex c)
  {
    const NodeIndex *nodes = discretization.geometry_nodes(c);
    return {{X[nodes[0]], X[nodes[1]], X[nodes[2]], X[nodes[3]]}};
  }

  template <typename Number>
  CellGeometry<Number>
  geometry_of_cell(const Discretization<3> &discretization, const NodalVectors<Number> &X, const CellIndex c)
  {
    return cell_geometry(positions_of_cell(discretization, X, c));
  }

  /// Cells in closed form are known by their corners.
  struct StraightCells
  {
    template <typename Number>
    static Four<Vector3<Number>>
    positions(const Discretization<3> &discretization, const NodalVectors<Number> &X, const CellIndex c)
    {
      return positions_of_cell(discretization, X, c);
    }

    static Four<Vec3> no_positions() { return {}; }
  };

  struct MiniPair : StraightCells
  {
    template <typename Number>
    using Values = CellValues<Number>;

    static CellValues<double> no_values() { return {}; }

    /// Returns the values of a cell without its bubble, which is zero.
    template <typename Number>
    static CellValues<Number>
    at_nodes(const Discretization<3> &discretization, const Field<Number> &W, const CellIndex c)
    {
      const unsigned int *velocities = discretization.velocity_places(c),
                         *pressures  = discretization.pressure_places(c);
      CellValues<Number> w;
      for (unsigned int a = 0; a < 4; ++a)
      {
        w.V[a] = W.V.at_place(velocities[a]);
        w.P[a] = W.P.at_place(pressures[a]);
      }
      return w;
    }

    template <typename Number>
    static CellValues<Number>
    on_cell(const Discretization<3> &discretization, const Field<Number> &W, const CellIndex c)
    {
      CellValues<Number> w = at_nodes(discretization, W, c);
      w.beta               = bubble(discretization, W, c);
      return w;
    }

    /// The bubble of a cell.
    template <typename Fields>
    static auto &bubble(const Discretization<3> &discretization, Fields &W, const CellIndex c)
    {
      return W.V.at_place(discretization.velocity_places(c)[4]);
    }

    /// The transpose of on_cell.
    template <typename Number>
    static void add(const Discretization<3>  &discretization,
                    const CellValues<Number> &w,
                    const CellIndex           c,
                    Field<Number>            &W)
    {
      const unsigned int *velocities = discretization.velocity_places(c),
                         *pressures  = discretization.pressure_places(c);
      for (unsigned int a = 0; a < 4; ++a)
      {
        W.V.at_place(velocities[a]) += w.V[a];
        W.P.at_place(pressures[a]) += w.P[a];
      }
      W.V.at_place(velocities[4]) += w.beta;
    }
  };

  struct TaylorHoodPair : StraightCells
  {
    template <typename Number>
    using Values = TaylorHoodValues<Number>;

    static TaylorHoodValues<double> no_values() { return {}; }

    template <typename Number>
    static TaylorHoodValues<Number>
    at_nodes(const Discretization<3> &discretization, const Field<Number> &W, const CellIndex c)
    {
      return on_cell(discretization, W, c);
    }

    template <typename Number>
    static TaylorHoodValues<Number>
    on_cell(const Discretization<3> &discretization, const Field<Number> &W, const CellIndex c)
    {
      const unsigned int *velocities = discretization.velocity_places(c),
                         *pressures  = discretization.pressure_places(c);
      TaylorHoodValues<Number> w;
      for (unsigned int a = 0; a < 10; ++a)
        w.V[a] = W.V.at_place(velocities[a]);
      for (unsigned int a = 0; a < 4; ++a)
        w.P[a] = W.P.at_place(pressures[a]);
      return w;
    }

    /// The transpose of on_cell.
    template <typename Number>
    static void add(const Discretization<3>        &discretization,
                    const TaylorHoodValues<Number> &w,
                    const CellIndex                 c,
                    Field<Number>                  &W)
    {
      const unsigned int *velocities = discretization.velocity_places(c),
                         *pressures  = discretization.pressure_places(c);
      for (unsigned int a = 0; a < 10; ++a)
        W.V.at_place(velocities[a]) += w.V[a];
      for (unsigned int a = 0; a < 4; ++a)
        W.P.at_place(pressures[a]) += w.P[a];
    }
  };

  /// Where a node of the positions is. X has those of the vertices, and a middle lies halfway between the
  /// ends of its edge, or X has all of them, and cells may be curved.
  template <int dim, typename Number>
  dealii::Tensor<1, dim, Number> position_of_node(const Discretization<dim>      &discretization,
                                                  const CellVectors<dim, Number> &X,
                                                  const NodeIndex                 k)
  {
    if (k < X.size())
      return X[k];
    const auto &[a, b] = discretization.ends_of_geometry_node(k);
    return 0.5 * (X[a] + X[b]);
  }

  /// Either of them by quadrature, on cells of any geometry.
  template <int dim>
  struct QuadraturePair
  {
    template <typename Number>
    using Values = QuadratureValues<dim, Number>;

    const ReferenceElement<dim> *element;

    template <typename Number>
    QuadratureGeometry<dim, Number> positions(const Discretization<dim>      &discretization,
                                              const CellVectors<dim, Number> &X,
                                              const CellIndex                 c) const
    {
      QuadratureGeometry<dim, Number> geometry{element, {}};
      for (unsigned int a = 0; a < element->n_positions(); ++a)
        geometry.X.push_back(position_of_node(discretization, X, discretization.geometry_nodes(c)[a]));
      return geometry;
    }

    CellVectors<dim, double> no_positions() const { return CellVectors<dim, double>(element->n_positions()); }
    QuadratureValues<dim, double> no_values() const { return QuadratureValues<dim, double>(*element); }

    template <typename Number>
    QuadratureValues<dim, Number> at_nodes(const Discretization<dim>    &discretization,
                                           const FlowField<dim, Number> &W,
                                           const CellIndex               c) const
    {
      QuadratureValues<dim, Number> w = on_cell(discretization, W, c);
      if (element->has_bubble())
        w.V.back() = dealii::Tensor<1, dim, Number>();
      return w;
    }

    template <typename Number>
    QuadratureValues<dim, Number> on_cell(const Discretization<dim>    &discretization,
                                          const FlowField<dim, Number> &W,
                                          const CellIndex               c) const
    {
      QuadratureValues<dim, Number> w(*element);
      for (unsigned int a = 0; a < w.V.size(); ++a)
        w.V[a] = W.V.at_place(discretization.velocity_places(c)[a]);
      for (unsigned int a = 0; a < w.P.size(); ++a)
        w.P[a] = W.P.at_place(discretization.pressure_places(c)[a]);
      return w;
    }

    /// The transpose of on_cell.
    template <typename Number>
    void add(const Discretization<dim>           &discretization,
             const QuadratureValues<dim, Number> &w,
             const CellIndex                      c,
             FlowField<dim, Number>              &W) const
    {
      for (unsigned int a = 0; a < w.V.size(); ++a)
        W.V.at_place(discretization.velocity_places(c)[a]) += w.V[a];
      for (unsigned int a = 0; a < w.P.size(); ++a)
        W.P.at_place(discretization.pressure_places(c)[a]) += w.P[a];
    }
  };

  template <int dim>
  QuadraturePair(const ReferenceElement<dim> *) -> QuadraturePair<dim>;

  /// Returns f(pair) for the velocity-pressure pair of the discretisation.
  template <int dim, typename F>
  decltype(auto) dispatch_element(const Discretization<dim> &discretization, const F &f)
  {
    if constexpr (dim == 3)
      if (!discretization.quadrature())
        return discretization.pair() == ElementPair::mini ? f(MiniPair()) : f(TaylorHoodPair());
    return f(QuadraturePair<dim>{discretization.quadrature()});
  }

  /// The transpose of a pair's positions: of vertices, or of all nodes of the positions.
  template <int dim, typename CellPositions>
  void add_to_positions(const Discretization<dim>           &discretization,
                        const CellPositions                 &of_cell,
                        const CellIndex                      c,
                        std::vector<dealii::Tensor<1, dim>> &X)
  {
    const NodeIndex *nodes = discretization.geometry_nodes(c);
    for (unsigned int a = 0; a < of_cell.size(); ++a)
      if (nodes[a] < X.size())
        X[nodes[a]] += of_cell[a];
      else
        for (const NodeIndex end : discretization.ends_of_geometry_node(nodes[a]))
          X[end] += 0.5 * of_cell[a];
  }
} // namespace retroforge
