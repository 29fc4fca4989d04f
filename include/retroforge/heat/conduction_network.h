// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/numbers.h>
#include <retroforge/mesh/topology.h>

#include <array>

/// @file
/// Conduction by linear elements with lumped capacity, as a network: a node has the volume  V_i = sum_c |c|/4  of the
/// cells at it, and an edge the conductance  G_ij = -sum_c |c| grad lambda_i·grad lambda_j  per conductivity, so that
/// k sum_j G_ij (T_j - T_i)  is the heat that flows to node i. Beside it stands one without the negative conductances
/// across from obtuse angles, whose temperatures are bounded:  (G + sqrt(G² + w²))/2,  w = (V_i V_j)^(1/6)/1000, smooth
/// where angles are right.
namespace retroforge
{
  /// The edges of the network: pairs of nodes that share a cell.
  struct NetworkEdges
  {
    std::vector<std::array<NodeIndex, 2>>    nodes;    ///< of each, the smaller one first, ascending
    std::vector<std::array<unsigned int, 6>> of_cells; ///< of each cell, in the order of tet_edge_corners

    NetworkEdges(const TetMesh &mesh, const Topology &topology);
  };

  /// `use(edge, first node, second node)` for each edge.
  template <typename Use>
  void for_each_edge(const NetworkEdges &edges, const Use &use)
  {
    for (unsigned int e = 0; e < edges.nodes.size(); ++e)
      use(e, edges.nodes[e][0], edges.nodes[e][1]);
  }

  template <typename Number>
  struct ConductionNetwork
  {
    std::vector<Number> volumes;      ///< of nodes [mm^3]
    std::vector<Number> conductances; ///< of edges per conductivity [mm]
    std::vector<Number> bounded;      ///< the same without negative ones
  };

  /// Returns zero derivatives in a network.
  ConductionNetwork<double> no_derivatives(const ConductionNetwork<double> &network);

  template <typename Number>
  ConductionNetwork<Number>
  conduction_network(const TetMesh &mesh, const NetworkEdges &edges, const NodalVectors<Number> &X);

  /// Adds the pull-back of conduction_network to X_bar.
  void reverse_conduction_network(const TetMesh                   &mesh,
                                  const NetworkEdges              &edges,
                                  const NodalVectors<double>      &X,
                                  const ConductionNetwork<double> &bar,
                                  NodalVectors<double>            &X_bar);
} // namespace retroforge
