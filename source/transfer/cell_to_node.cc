// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/dual.h>
#include <retroforge/mesh/cell_faces.h>
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/transfer/cell_to_node.h>

namespace retroforge
{
  namespace
  {
    template <typename Number>
    Number cell_volume(const std::array<NodeIndex, 4> &cell, const NodalVectors<Number> &X)
    {
      const Vector3<Number> a = X[cell[1]] - X[cell[0]], b = X[cell[2]] - X[cell[0]],
                            c = X[cell[3]] - X[cell[0]];
      return (c[0] * (a[1] * b[2] - a[2] * b[1]) + c[1] * (a[2] * b[0] - a[0] * b[2]) +
              c[2] * (a[0] * b[1] - a[1] * b[0])) /
             6.;
    }

    // M_k, the volume of the cells at each node.
    template <typename Number>
    std::vector<Number> volumes_at_nodes(const TetMesh &mesh, const std::vector<Number> &volumes)
    {
      std::vector<Number> sums(mesh.n_nodes(), Number(0.));
      for (CellIndex c = 0; c < mesh.n_cells(); ++c)
        for (const NodeIndex node : mesh.cells[c])
          sums[node] += volumes[c];
      return sums;
    }

    // d|T|/dx_a = -(outward area vector of the face opposite a) / 3
    void reverse_cell_volume(const std::array<NodeIndex, 4> &cell,
                             const NodalVectors<double>     &X,
                             const double                    volume_bar,
                             NodalVectors<double>           &X_bar)
    {
      const TetCorners x = corners(cell, X);
      for (unsigned int a = 0; a < 4; ++a)
      {
        const auto &face = tet_face_corners[a];
        X_bar[cell[a]] -= volume_bar / 6 * cross_product_3d(x[face[1]] - x[face[0]], x[face[2]] - x[face[0]]);
      }
    }
  } // namespace

  template <typename Number>
  std::vector<Number> cell_volumes(const TetMesh &mesh, const NodalVectors<Number> &X)
  {
    AssertDimension(X.size(), mesh.n_nodes());
    std::vector<Number> volumes;
    volumes.reserve(mesh.n_cells());
    for (const auto &cell : mesh.cells)
      volumes.push_back(cell_volume(cell, X));
    return volumes;
  }

  void reverse_cell_volumes(const TetMesh              &mesh,
                            const NodalVectors<double> &X,
                            const std::vector<double>  &volumes_bar,
                            NodalVectors<double>       &X_bar)
  {
    AssertDimension(volumes_bar.size(), mesh.n_cells());
    AssertDimension(X_bar.size(), mesh.n_nodes());
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
      reverse_cell_volume(mesh.cells[c], X, volumes_bar[c], X_bar);
  }

  template <typename Number>
  std::vector<Number>
  cell_to_node(const TetMesh &mesh, const std::vector<Number> &volumes, const std::vector<Number> &q_T)
  {
    AssertDimension(volumes.size(), mesh.n_cells());
    AssertDimension(q_T.size(), mesh.n_cells());
    const auto          M = volumes_at_nodes(mesh, volumes);
    std::vector<Number> q(mesh.n_nodes(), Number(0.));
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
      for (const NodeIndex node : mesh.cells[c])
        q[node] += volumes[c] * q_T[c];
    for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
      q[k] /= M[k];
    return q;
  }

  void reverse_cell_to_node(const TetMesh             &mesh,
                            const std::vector<double> &volumes,
                            const std::vector<double> &q_T,
                            const std::vector<double> &q_k_bar,
                            std::vector<double>       &q_T_bar,
                            std::vector<double>       &volumes_bar)
  {
    AssertDimension(q_k_bar.size(), mesh.n_nodes());
    AssertDimension(q_T_bar.size(), mesh.n_cells());
    AssertDimension(volumes_bar.size(), mesh.n_cells());
    const auto M   = volumes_at_nodes(mesh, volumes);
    const auto q_k = cell_to_node(mesh, volumes, q_T);
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
      for (const NodeIndex k : mesh.cells[c])
      {
        q_T_bar[c] += volumes[c] * q_k_bar[k] / M[k];
        volumes_bar[c] += q_k_bar[k] / M[k] * (q_T[c] - q_k[k]);
      }
  }

  template <typename Number>
  std::vector<Number> node_to_cell(const TetMesh &mesh, const std::vector<Number> &q_k)
  {
    AssertDimension(q_k.size(), mesh.n_nodes());
    std::vector<Number> q_T;
    q_T.reserve(mesh.n_cells());
    for (const auto &cell : mesh.cells)
      q_T.push_back(0.25 * (q_k[cell[0]] + q_k[cell[1]] + q_k[cell[2]] + q_k[cell[3]]));
    return q_T;
  }

  void
  reverse_node_to_cell(const TetMesh &mesh, const std::vector<double> &q_T_bar, std::vector<double> &q_k_bar)
  {
    AssertDimension(q_T_bar.size(), mesh.n_cells());
    AssertDimension(q_k_bar.size(), mesh.n_nodes());
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
      for (const NodeIndex node : mesh.cells[c])
        q_k_bar[node] += 0.25 * q_T_bar[c];
  }

#define RETROFORGE_INSTANTIATE(Number)                                                      \
  template std::vector<Number> cell_volumes(const TetMesh &, const NodalVectors<Number> &); \
  template std::vector<Number> cell_to_node(                                                \
    const TetMesh &, const std::vector<Number> &, const std::vector<Number> &);             \
  template std::vector<Number> node_to_cell(const TetMesh &, const std::vector<Number> &);
  RETROFORGE_INSTANTIATE(double)
  RETROFORGE_INSTANTIATE(Dual)
#undef RETROFORGE_INSTANTIATE
} // namespace retroforge
