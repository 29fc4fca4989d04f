// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/element/cell_geometry.templates.h>
#include <retroforge/heat/conduction_network.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  NetworkEdges::NetworkEdges(const TetMesh &mesh, const Topology &topology)
  {
    std::vector<unsigned int> first(mesh.n_nodes()); // edge to the first neighbour with a larger index
    for (NodeIndex a = 0; a < mesh.n_nodes(); ++a)
    {
      first[a] = nodes.size();
      for (const NodeIndex b : topology.neighbours[a])
        if (b > a)
          nodes.push_back({{a, b}});
    }
    const auto between = [&](const NodeIndex i, const NodeIndex j) -> unsigned int {
      const std::array<NodeIndex, 2> edge{{std::min(i, j), std::max(i, j)}};
      return std::lower_bound(nodes.begin() + first[edge[0]], nodes.end(), edge) - nodes.begin();
    };
    of_cells.resize(mesh.n_cells());
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
      for (unsigned int e = 0; e < 6; ++e)
        of_cells[c][e] =
          between(mesh.cells[c][tet_edge_corners[e][0]], mesh.cells[c][tet_edge_corners[e][1]]);
  }

  namespace
  {
    template <typename Number>
    CellGeometry<Number> geometry_of(const TetMesh &mesh, const NodalVectors<Number> &X, const CellIndex c)
    {
      Four<Vector3<Number>> x;
      for (unsigned int a = 0; a < 4; ++a)
        x[a] = X[mesh.cells[c][a]];
      return cell_geometry(x);
    }

    constexpr double relative_width = 1e-3;

    template <typename Number>
    Number positive_part(const Number &G, const Number &V_a, const Number &V_b)
    {
      using std::pow;
      using std::sqrt;
      const Number w = relative_width * pow(Number(V_a * V_b), 1. / 6.);
      return 0.5 * (G + sqrt(Number(G * G + w * w)));
    }

    /// Adds the derivatives of  bar * positive_part.
    void reverse_positive_part(const double G,
                               const double V_a,
                               const double V_b,
                               const double bar,
                               double      &G_bar,
                               double      &a_bar,
                               double      &b_bar)
    {
      const double w = relative_width * std::pow(V_a * V_b, 1. / 6.), root = std::sqrt(G * G + w * w);
      G_bar += 0.5 * bar * (1. + G / root);
      const double log_bar = 0.5 * bar * w * w / root / 6.; // in the logarithm of V_a V_b
      a_bar += log_bar / V_a;
      b_bar += log_bar / V_b;
    }
  } // namespace

  ConductionNetwork<double> no_derivatives(const ConductionNetwork<double> &network)
  {
    const std::vector<double> of_edges(network.conductances.size(), 0.);
    return {std::vector<double>(network.volumes.size(), 0.), of_edges, of_edges};
  }

  template <typename Number>
  ConductionNetwork<Number>
  conduction_network(const TetMesh &mesh, const NetworkEdges &edges, const NodalVectors<Number> &X)
  {
    ConductionNetwork<Number> network{std::vector<Number>(mesh.n_nodes(), Number(0.)),
                                      std::vector<Number>(edges.nodes.size(), Number(0.)),
                                      {}};
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    {
      const auto cell = geometry_of(mesh, X, c);
      for (const NodeIndex k : mesh.cells[c])
        network.volumes[k] += 0.25 * cell.volume;
      for (unsigned int e = 0; e < 6; ++e)
        network.conductances[edges.of_cells[c][e]] -=
          cell.volume * (cell.g[tet_edge_corners[e][0]] * cell.g[tet_edge_corners[e][1]]);
    }
    for (unsigned int e = 0; e < edges.nodes.size(); ++e)
      network.bounded.push_back(positive_part(
        network.conductances[e], network.volumes[edges.nodes[e][0]], network.volumes[edges.nodes[e][1]]));
    return network;
  }

  template ConductionNetwork<double>
  conduction_network(const TetMesh &, const NetworkEdges &, const NodalVectors<double> &);
  template ConductionNetwork<Dual>
  conduction_network(const TetMesh &, const NetworkEdges &, const NodalVectors<Dual> &);

  void reverse_conduction_network(const TetMesh                   &mesh,
                                  const NetworkEdges              &edges,
                                  const NodalVectors<double>      &X,
                                  const ConductionNetwork<double> &network_bar,
                                  NodalVectors<double>            &X_bar)
  {
    AssertDimension(network_bar.volumes.size(), mesh.n_nodes());
    AssertDimension(network_bar.conductances.size(), edges.nodes.size());
    const auto                network = conduction_network(mesh, edges, X);
    ConductionNetwork<double> bar     = network_bar;
    for (unsigned int e = 0; e < edges.nodes.size(); ++e)
    {
      const auto [a, b] = edges.nodes[e];
      reverse_positive_part(network.conductances[e],
                            network.volumes[a],
                            network.volumes[b],
                            bar.bounded[e],
                            bar.conductances[e],
                            bar.volumes[a],
                            bar.volumes[b]);
    }
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    {
      const auto cell       = geometry_of(mesh, X, c);
      double     volume_bar = 0.;
      Four<Vec3> g_bar = {}, x_bar = {};
      for (const NodeIndex k : mesh.cells[c])
        volume_bar += 0.25 * bar.volumes[k];
      for (unsigned int e = 0; e < 6; ++e)
      {
        const auto [a, b]  = tet_edge_corners[e];
        const double G_bar = bar.conductances[edges.of_cells[c][e]];
        volume_bar -= G_bar * (cell.g[a] * cell.g[b]);
        g_bar[a] -= G_bar * cell.volume * cell.g[b];
        g_bar[b] -= G_bar * cell.volume * cell.g[a];
      }
      reverse_cell_geometry(cell, volume_bar, g_bar, x_bar);
      for (unsigned int a = 0; a < 4; ++a)
        X_bar[mesh.cells[c][a]] += x_bar[a];
    }
  }
} // namespace retroforge
