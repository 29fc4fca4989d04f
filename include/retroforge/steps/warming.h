// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/solver/equilibrium.h>

/// @file
/// Adiabatic warming: the work of deformation of the cells, of which chi becomes heat, is shared out among their
/// nodes, each of which has the capacity of its part of the volume (lumped, so that a uniform flow warms uniformly):
///   dT_k = dt chi/(rho c) (sum_c D_c) / (sum_c |c|),  c the cells at node k, D_c their dissipation  [mJ/s].
/// Nodes move with the metal, so that nothing is averaged twice: heat does not spread from increment to increment.
namespace retroforge
{
  /// Volumes of all cells and, of each node, the sum over the cells at it [mm^3].
  template <typename Number>
  struct NodeVolumes
  {
    std::vector<Number> of_cell, of_node;

    NodeVolumes(const TetMesh &mesh, const NodalVectors<Number> &X);
  };

  /// Adds the derivatives of  volume_bar * of_cell[c].
  void reverse_cell_volume(const TetMesh              &mesh,
                           const NodalVectors<double> &X,
                           CellIndex                   c,
                           double                      volume_bar,
                           NodalVectors<double>       &X_bar);

  /// Adds it to the temperatures of all nodes, for the part view.weight of the time dt [s], on every rank.
  /// Collective.
  template <typename Number>
  void add_warming(const EquilibriumView<Number> &view, const Number &dt, std::vector<Number> &T);

  /// Reverse of add_warming: adds to the derivatives in the stage's unknowns and positions, in the laws and the
  /// states of the metal, in the numbers of its heat, and in dt, this rank's part.
  /// @param T_bar  of all nodes; the derivative after is that before
  void reverse_add_warming(const EquilibriumView<double> &view,
                           double                         dt,
                           const std::vector<double>     &T_bar,
                           EquilibriumBar                &bar);
} // namespace retroforge
