// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/dual.h>
#include <retroforge/core/error.h>
#include <retroforge/mesh/boundary_location.h>
#include <retroforge/mesh/point_location.h>
#include <retroforge/transfer/recovered_gradient.h>
#include <retroforge/transfer/transfer.h>

#include <algorithm>
#include <optional>
#include <utility>

namespace retroforge
{
  namespace
  {
    using Row = std::vector<std::pair<NodeIndex, double>>;

    void check_count(const std::string &what, const std::size_t n, const std::size_t expected)
    {
      if (n != expected)
        throw Error("transfer between meshes",
                    std::to_string(n) + " " + what,
                    "there must be " + std::to_string(expected),
                    "pass the meshes and values that belong together");
    }

    void check_arguments(const TetMesh                &old_mesh,
                         const NodalVectors<double>   &X_old,
                         const TetMesh                &new_mesh,
                         const std::vector<NodeIndex> &old_node)
    {
      check_count("positions of old nodes", X_old.size(), old_mesh.n_nodes());
      check_count("origins of new nodes", old_node.size(), new_mesh.n_nodes());
      check_count("patches of the new mesh", new_mesh.patches.size(), old_mesh.patches.size());
      for (const NodeIndex node : old_node)
        if (node != invalid_index && node >= old_mesh.n_nodes())
          throw Error("transfer between meshes",
                      "a new node is said to be old node " + std::to_string(node),
                      "the old mesh has " + std::to_string(old_mesh.n_nodes()) + " nodes, counted from 0",
                      "pass the meshes and origins that belong together");
      for (std::size_t p = 0; p < old_mesh.patches.size(); ++p)
        if (new_mesh.patches[p].name != old_mesh.patches[p].name)
          throw Error("transfer between meshes",
                      "patch " + std::to_string(p) + " is `" + old_mesh.patches[p].name +
                        "' of the old mesh, but `" + new_mesh.patches[p].name + "' of the new one",
                      "both meshes must have the same patches",
                      "remesh with the patches of the old mesh, in their order");
    }

    // Makes the rows of new nodes; what is needed for that is built when the first node asks for it.
    class RowMaker
    {
    public:
      RowMaker(const TetMesh &mesh, const NodalVectors<double> &X, const Interpolation interpolation)
          : mesh_(mesh), X_(X), interpolation_(interpolation)
      {
      }

      Row inside(const Vec3 &x)
      {
        if (!cells_)
          cells_.emplace(mesh_, X_);
        const CellPoint point = cells_->locate(x);
        Row             row;
        for (unsigned int a = 0; a < 4; ++a)
          row.emplace_back(mesh_.cells[point.cell][a], point.weights[a]);
        return tidy(with_gradient(std::move(row), {}));
      }

      Row on_boundary(const Vec3 &x, const PatchSet &patches)
      {
        if (!boundary_)
          boundary_.emplace(mesh_, X_);
        const BoundaryPoint point = boundary_->locate(x, patches);
        Row                 row;
        for (std::size_t i = 0; i < point.nodes.size(); ++i)
          row.emplace_back(point.nodes[i], point.weights[i]);
        return tidy(point.nodes.size() > 1 ? with_gradient(std::move(row), point.patches) : std::move(row));
      }

    private:
      // The arms x - x_a are taken from the point the weights give: for a node outside of the old mesh that
      // is its closest point, and linear fields stay exact there. All gradients or none: else they are not.
      Row with_gradient(const Row &linear, const PatchSet &patches)
      {
        if (interpolation_ == Interpolation::linear)
          return linear;
        if (!gradient_)
          gradient_.emplace(mesh_, X_);
        Row  row = linear;
        Vec3 x;
        for (const auto &[node, weight] : linear)
          x += weight * X_[node];
        for (const auto &[node, weight] : linear)
          if (!gradient_->add_directional(node, patches, 0.5 * weight * (x - X_[node]), row))
            return linear;
        return row;
      }

      // Ascending nodes, each once; no zeros; the largest weight takes what the sum lacks of one.
      static Row tidy(Row row)
      {
        std::stable_sort(
          row.begin(), row.end(), [](const auto &a, const auto &b) { return a.first < b.first; });
        Row merged;
        for (const auto &[node, weight] : row)
          if (!merged.empty() && merged.back().first == node)
            merged.back().second += weight;
          else
            merged.emplace_back(node, weight);
        merged.erase(
          std::remove_if(merged.begin(), merged.end(), [](const auto &entry) { return entry.second == 0; }),
          merged.end());
        const auto largest = std::max_element(
          merged.begin(), merged.end(), [](const auto &a, const auto &b) { return a.second < b.second; });
        // Summed up in the order of apply(), and twice, as the first correction is rounded itself.
        for (unsigned int pass = 0; pass < 2; ++pass)
        {
          double sum = 0;
          for (const auto &entry : merged)
            sum += entry.second;
          largest->second += 1 - sum;
        }
        return merged;
      }

      const TetMesh                   &mesh_;
      const NodalVectors<double>      &X_;
      const Interpolation              interpolation_;
      std::optional<CellLocator>       cells_;
      std::optional<BoundaryLocator>   boundary_;
      std::optional<RecoveredGradient> gradient_;
    };

    void append(const Row &row, TransferOperator &J)
    {
      for (const auto &[node, weight] : row)
      {
        J.node.push_back(node);
        J.weight.push_back(weight);
      }
      J.begin.push_back(J.node.size());
    }

    template <typename T>
    std::size_t bytes(const std::vector<T> &v)
    {
      return v.capacity() * sizeof(T);
    }
  } // namespace

  template <typename Value>
  std::vector<Value> TransferOperator::apply(const std::vector<Value> &q) const
  {
    check_count("values to transfer", q.size(), n_old);
    std::vector<Value> transferred(n_new());
    for (unsigned int k = 0; k < n_new(); ++k)
    {
      Value sum = q[node[begin[k]]] * weight[begin[k]];
      for (unsigned int i = begin[k] + 1; i < begin[k + 1]; ++i)
        sum += q[node[i]] * weight[i];
      transferred[k] = sum;
    }
    return transferred;
  }

  template <typename Value>
  std::vector<Value> TransferOperator::apply_transpose(const std::vector<Value> &q_bar) const
  {
    check_count("values to transfer back", q_bar.size(), n_new());
    std::vector<Value> scattered(n_old, Value());
    for (unsigned int k = 0; k < n_new(); ++k)
      for (unsigned int i = begin[k]; i < begin[k + 1]; ++i)
        scattered[node[i]] += q_bar[k] * weight[i];
    return scattered;
  }

  namespace
  {
    /// The entries of row k with the least and the largest value.
    template <typename Number>
    std::pair<NodeIndex, NodeIndex>
    extremes(const TransferOperator &J, const unsigned int k, const std::vector<Number> &q)
    {
      NodeIndex least = J.node[J.begin[k]], largest = least;
      for (unsigned int i = J.begin[k]; i < J.begin[k + 1]; ++i)
      {
        if (value_of(q[J.node[i]]) < value_of(q[least]))
          least = J.node[i];
        if (value_of(q[J.node[i]]) > value_of(q[largest]))
          largest = J.node[i];
      }
      return {least, largest};
    }

    /// The node whose value bounds row k, or none.
    template <typename Number>
    NodeIndex
    bound(const TransferOperator &J, const unsigned int k, const std::vector<Number> &q, const Number &free)
    {
      const auto [least, largest] = extremes(J, k, q);
      if (value_of(free) < value_of(q[least]))
        return least;
      return value_of(free) > value_of(q[largest]) ? largest : invalid_index;
    }
  } // namespace

  template <typename Number>
  std::vector<Number> TransferOperator::apply_bounded(const std::vector<Number> &q) const
  {
    std::vector<Number> transferred = apply(q);
    for (unsigned int k = 0; k < n_new(); ++k)
      if (const NodeIndex at = bound(*this, k, q, transferred[k]); at != invalid_index)
        transferred[k] = q[at];
    return transferred;
  }

  std::vector<double> TransferOperator::reverse_apply_bounded(const std::vector<double> &q,
                                                              std::vector<double>        q_bar) const
  {
    const std::vector<double> free = apply(q);
    std::vector<double>       of_bounds(n_old, 0.);
    for (unsigned int k = 0; k < n_new(); ++k)
      if (const NodeIndex at = bound(*this, k, q, free[k]); at != invalid_index)
        of_bounds[at] += std::exchange(q_bar[k], 0.);
    std::vector<double> bar = apply_transpose(q_bar);
    for (NodeIndex k = 0; k < n_old; ++k)
      bar[k] += of_bounds[k];
    return bar;
  }

  void TransferOperator::set_offset(const NodalVectors<double> &X, const NodalVectors<double> &X_new)
  {
    AssertDimension(X_new.size(), n_new());
    offset = apply(X);
    for (unsigned int k = 0; k < n_new(); ++k)
      offset[k] = X_new[k] - offset[k];
  }

  std::size_t TransferOperator::memory_consumption() const
  {
    return sizeof(*this) + bytes(begin) + bytes(node) + bytes(weight) + bytes(offset);
  }

  template std::vector<double>  TransferOperator::apply(const std::vector<double> &) const;
  template std::vector<Dual>    TransferOperator::apply(const std::vector<Dual> &) const;
  template NodalVectors<double> TransferOperator::apply(const NodalVectors<double> &) const;
  template NodalVectors<Dual>   TransferOperator::apply(const NodalVectors<Dual> &) const;
  template std::vector<double>  TransferOperator::apply_bounded(const std::vector<double> &) const;
  template std::vector<Dual>    TransferOperator::apply_bounded(const std::vector<Dual> &) const;
  template std::vector<double>  TransferOperator::apply_transpose(const std::vector<double> &) const;
  template NodalVectors<double> TransferOperator::apply_transpose(const NodalVectors<double> &) const;

  TransferOperator make_transfer(const TetMesh                &old_mesh,
                                 const NodalVectors<double>   &X_old,
                                 const TetMesh                &new_mesh,
                                 const std::vector<NodeIndex> &old_node,
                                 const Interpolation           interpolation)
  {
    check_arguments(old_mesh, X_old, new_mesh, old_node);
    const auto       patches = patches_at_nodes(new_mesh);
    RowMaker         rows(old_mesh, X_old, interpolation);
    TransferOperator J;
    J.n_old = old_mesh.n_nodes();
    for (NodeIndex k = 0; k < new_mesh.n_nodes(); ++k)
      if (old_node[k] != invalid_index)
        append({{old_node[k], 1.}}, J);
      else if (patches[k].empty())
        append(rows.inside(new_mesh.X[k]), J);
      else
        append(rows.on_boundary(new_mesh.X[k], patches[k]), J);
    J.set_offset(X_old, new_mesh.X);
    return J;
  }
} // namespace retroforge
