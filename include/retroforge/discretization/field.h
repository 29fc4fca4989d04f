// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/discretization/discretization.h>
#include <retroforge/discretization/node_vector.h>

namespace retroforge
{
  /// The unknowns W = (V, P) of a discretisation's spaces, or anything dual to them. Velocities stand at the
  /// nodes of their space, which include the bubbles of the cells. A rank has what it works with: its own
  /// nodes and those it reads.
  template <int dim, typename Number>
  struct FlowField
  {
    NodeVector<dim, Number> V; ///< [mm/s]
    NodeVector<1, Number>   P; ///< [MPa]

    FlowField() = default;
    explicit FlowField(const Discretization<dim> &discretization)
        : V(discretization.velocity_nodes()), P(discretization.pressure_nodes())
    {
    }

    bool empty() const { return V.empty(); }

    /// Tells whether these are entries at the nodes of a discretisation, or of one that is partitioned alike.
    bool belongs_to(const Discretization<dim> &discretization) const
    {
      const auto is_on = [](const auto &values, const auto &nodes) {
        return values.numbering() == nodes ||
               (values.numbering() &&
                values.numbering()->partitioner()->is_compatible(*nodes->partitioner()));
      };
      return is_on(V, discretization.velocity_nodes()) && is_on(P, discretization.pressure_nodes());
    }

    /// this += scale * other
    void add(const Number &scale, const FlowField &other)
    {
      AssertDimension(other.V.size(), V.size());
      AssertDimension(other.P.size(), P.size());
      for (unsigned int i = 0; i < V.size(); ++i)
        V.at_place(i) += other.V.at_place(i) * scale;
      for (unsigned int i = 0; i < P.size(); ++i)
        P.at_place(i) += other.P.at_place(i) * scale;
    }

    /// Values of other ranks that this one reads. Collective.
    void update_ghosts()
    {
      V.update_ghosts();
      P.update_ghosts();
    }

    /// Whole sums, of what each rank has summed over its own cells and contacts, wherever this rank reads
    /// them. Collective.
    void sum_ghosts()
    {
      V.sum_ghosts();
      P.sum_ghosts();
      update_ghosts();
    }
  };

  template <typename Number>
  using Field = FlowField<3, Number>;

  /// A field without bubbles from values at the vertices: linear along edges.
  template <int dim>
  FlowField<dim, double> interpolated(const Discretization<dim>                 &discretization,
                                      const std::vector<dealii::Tensor<1, dim>> &V,
                                      const std::vector<double>                 &P);
} // namespace retroforge
