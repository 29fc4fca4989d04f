// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/numbers.h>
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/steps/following_mesh.h>

#include <algorithm>

namespace retroforge
{
  FollowingMesh::FollowingMesh(const TetMesh &mesh)
      : mesh_(mesh)
      , motion_(mesh)
      , volume_(mesh.n_nodes(), 0.)
      , area_(mesh.n_nodes(), 0.)
      , below_(mesh.n_nodes())
  {
    for (const auto &cell : mesh.cells)
      for (const NodeIndex a : cell)
        for (const NodeIndex b : cell)
          if (b < a && std::find(below_[a].begin(), below_[a].end(), b) == below_[a].end())
            below_[a].push_back(b);
    for (const auto &cell : mesh.cells)
    {
      cells_.push_back(cell_geometry(corners(cell, mesh.X)));
      for (const NodeIndex k : cell)
        volume_[k] += cells_.back().volume;
    }
    for (const BoundaryFace &face : mesh.faces)
    {
      if (!mesh.is_surface(face))
        continue;
      const auto  at     = [&](const unsigned int a) { return mesh.X[face.nodes[a % 3]]; };
      const Vec3  normal = dealii::cross_product_3d(at(1) - at(0), at(2) - at(0)); // twice the area
      const auto &n      = normal / normal.norm_square();
      Face        on_surface{face.nodes, 0.5 * normal.norm(), {}};
      for (unsigned int a = 0; a < 3; ++a)
        on_surface.g[a] = dealii::cross_product_3d(n, at(a + 2) - at(a + 1));
      for (const NodeIndex k : face.nodes)
        area_[k] += on_surface.area;
      faces_.push_back(on_surface);
    }
  }

  template <typename Number>
  NodalVectors<Number> FollowingMesh::node_gradients(const std::vector<Number> &q) const
  {
    AssertDimension(q.size(), mesh_.n_nodes());
    NodalVectors<Number> gradients(q.size());
    for (CellIndex c = 0; c < cells_.size(); ++c)
    {
      const auto     &cell = mesh_.cells[c];
      Vector3<Number> gradient;
      for (unsigned int a = 0; a < 4; ++a)
        gradient += q[cell[a]] * cells_[c].g[a];
      for (const NodeIndex k : cell)
        if (area_[k] == 0.)
          gradients[k] += gradient * (cells_[c].volume / volume_[k]);
    }
    for (const Face &face : faces_)
    {
      Vector3<Number> gradient;
      for (unsigned int a = 0; a < 3; ++a)
        gradient += q[face.nodes[a]] * face.g[a];
      for (const NodeIndex k : face.nodes)
        gradients[k] += gradient * (face.area / area_[k]);
    }
    return gradients;
  }

  template <typename Number>
  NodalVectors<Number> FollowingMesh::cell_gradients(const std::vector<Number> &q) const
  {
    AssertDimension(q.size(), cells_.size());
    std::vector<Number> at_nodes(mesh_.n_nodes(), Number(0.));
    for (CellIndex c = 0; c < cells_.size(); ++c)
      for (const NodeIndex k : mesh_.cells[c])
        at_nodes[k] += q[c] * (cells_[c].volume / volume_[k]);
    NodalVectors<Number> gradients(q.size());
    for (CellIndex c = 0; c < cells_.size(); ++c)
      for (unsigned int a = 0; a < 4; ++a)
        gradients[c] += at_nodes[mesh_.cells[c][a]] * cells_[c].g[a];
    return gradients;
  }

  namespace
  {
    template <typename Number>
    NodalVectors<Number> difference(const NodalVectors<Number> &X, const NodalVectors<double> &Y)
    {
      NodalVectors<Number> d(X.size());
      for (std::size_t k = 0; k < X.size(); ++k)
        d[k] = X[k] - Vector3<Number>(Y[k]);
      return d;
    }

    template <typename Number>
    bool is_there(const Number &q)
    {
      return value_of(q) != 0.;
    }

    template <typename Vector>
    auto component(const std::vector<Vector> &q, const unsigned int i)
    {
      std::vector<typename Vector::value_type> q_i;
      for (const Vector &x : q)
        q_i.push_back(x[i]);
      return q_i;
    }
  } // namespace

  template <typename Number>
  NodalVectors<Number> FollowingMesh::positions(const NodalVectors<Number> &X) const
  {
    NodalVectors<Number> moved = motion_.of(difference(X, mesh_.X));
    for (std::size_t k = 0; k < X.size(); ++k)
      moved[k] += Vector3<Number>(mesh_.X[k]);
    return moved;
  }

  template <typename Number>
  std::vector<NodeIndex> FollowingMesh::moved_like(const std::vector<Number> &q) const
  {
    std::vector<NodeIndex> first(q.size());
    for (NodeIndex k = 0; k < q.size(); ++k)
    {
      first[k] = k;
      for (const NodeIndex b : below_[k])
        if (value_of(q[b]) == value_of(q[k]))
          first[k] = std::min(first[k], first[b]);
    }
    return first;
  }

  template <typename Number>
  void FollowingMesh::move_nodes(const NodalVectors<Number> &w, std::vector<Number> &q) const
  {
    if (q.empty())
      return;
    const NodalVectors<Number>   gradients = node_gradients(q);
    const std::vector<NodeIndex> moved_as  = moved_like(q);
    for (std::size_t k = 0; k < q.size(); ++k)
      if (is_there(q[k]))
        q[k] += gradients[moved_as[k]] * w[moved_as[k]];
  }

  template <typename Number>
  void FollowingMesh::move_nodes(const NodalVectors<Number> &w, NodalVectors<Number> &q) const
  {
    for (unsigned int i = 0; i < 3 && !q.empty(); ++i)
    {
      std::vector<Number> q_i = component(q, i);
      move_nodes(w, q_i);
      for (std::size_t k = 0; k < q.size(); ++k)
        q[k][i] = q_i[k];
    }
  }

  template <typename Number>
  void FollowingMesh::move_cells(const NodalVectors<Number> &w, std::vector<Number> &q) const
  {
    if (q.empty())
      return;
    const NodalVectors<Number> gradients = cell_gradients(q);
    for (CellIndex c = 0; c < q.size(); ++c)
      for (const NodeIndex k : mesh_.cells[c])
        q[c] += 0.25 * (gradients[c] * w[k]);
  }

  void FollowingMesh::reverse_nodes(const std::vector<double> &q,
                                    const std::vector<double> &q_bar,
                                    NodalVectors<double>      &w_bar) const
  {
    if (q.empty() || q_bar.empty())
      return;
    const NodalVectors<double>   gradients = node_gradients(q);
    const std::vector<NodeIndex> moved_as  = moved_like(q);
    for (std::size_t k = 0; k < q.size(); ++k)
      if (is_there(q[k]))
        w_bar[moved_as[k]] += q_bar[k] * gradients[moved_as[k]];
  }

  void FollowingMesh::reverse_nodes(const NodalVectors<double> &q,
                                    const NodalVectors<double> &q_bar,
                                    NodalVectors<double>       &w_bar) const
  {
    for (unsigned int i = 0; i < 3; ++i)
      reverse_nodes(component(q, i), component(q_bar, i), w_bar);
  }

  void FollowingMesh::reverse_cells(const std::vector<double> &q,
                                    const std::vector<double> &q_bar,
                                    NodalVectors<double>      &w_bar) const
  {
    if (q.empty() || q_bar.empty())
      return;
    const NodalVectors<double> gradients = cell_gradients(q);
    for (CellIndex c = 0; c < q.size(); ++c)
      for (const NodeIndex k : mesh_.cells[c])
        w_bar[k] += (0.25 * q_bar[c]) * gradients[c];
  }

  NodalVectors<double> FollowingMesh::reverse_positions(NodalVectors<double>        X_bar,
                                                        const NodalVectors<double> &w_bar) const
  {
    // w = (P - 1) (X' - X'_0)
    for (std::size_t k = 0; k < X_bar.size(); ++k)
      X_bar[k] += w_bar[k];
    NodalVectors<double> of_operations = motion_.transpose(std::move(X_bar));
    for (std::size_t k = 0; k < w_bar.size(); ++k)
      of_operations[k] -= w_bar[k];
    return of_operations;
  }

  std::unique_ptr<FollowingMesh>
  following_mesh(const bool meshes_follow, const unsigned int increment, const RemeshRecord &remesh)
  {
    return meshes_follow && increment > 0 ? std::make_unique<FollowingMesh>(remesh.mesh) : nullptr;
  }

  template NodalVectors<double> FollowingMesh::positions(const NodalVectors<double> &) const;
  template NodalVectors<Dual>   FollowingMesh::positions(const NodalVectors<Dual> &) const;
  template void FollowingMesh::move_nodes(const NodalVectors<double> &, std::vector<double> &) const;
  template void FollowingMesh::move_nodes(const NodalVectors<Dual> &, std::vector<Dual> &) const;
  template void FollowingMesh::move_nodes(const NodalVectors<double> &, NodalVectors<double> &) const;
  template void FollowingMesh::move_nodes(const NodalVectors<Dual> &, NodalVectors<Dual> &) const;
  template void FollowingMesh::move_cells(const NodalVectors<double> &, std::vector<double> &) const;
  template void FollowingMesh::move_cells(const NodalVectors<Dual> &, std::vector<Dual> &) const;
} // namespace retroforge
