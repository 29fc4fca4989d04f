// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/dual.h>
#include <retroforge/core/error.h>
#include <retroforge/transfer/transfer_row.h>

#include <utility>

namespace retroforge
{
  namespace
  {
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

    template <typename T>
    std::size_t bytes(const std::vector<T> &v)
    {
      return v.capacity() * sizeof(T);
    }
  } // namespace

  template <typename Number>
  template <typename Value>
  std::vector<Value> BasicTransfer<Number>::apply(const std::vector<Value> &q) const
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

  template <typename Number>
  template <typename Value>
  std::vector<Value> BasicTransfer<Number>::apply_transpose(const std::vector<Value> &q_bar) const
  {
    check_count("values to transfer back", q_bar.size(), n_new());
    std::vector<Value> scattered(n_old, Value());
    for (unsigned int k = 0; k < n_new(); ++k)
      for (unsigned int i = begin[k]; i < begin[k + 1]; ++i)
        scattered[node[i]] += q_bar[k] * weight[i];
    return scattered;
  }

  template <typename Number>
  template <typename Value>
  void BasicTransfer<Number>::add_weight_bar(const std::vector<Value> &q,
                                             const std::vector<Value> &q_bar,
                                             std::vector<double>      &weight_bar) const
  {
    AssertDimension(weight_bar.size(), weight.size());
    for (unsigned int k = 0; k < n_new(); ++k)
      for (unsigned int i = begin[k]; i < begin[k + 1]; ++i)
        weight_bar[i] += q_bar[k] * q[node[i]];
  }

  namespace
  {
    /// The entries of row k with the least and the largest value.
    template <typename Number>
    std::pair<NodeIndex, NodeIndex>
    extremes(const BasicTransfer<Number> &J, const unsigned int k, const std::vector<Number> &q)
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
    NodeIndex bound(const BasicTransfer<Number> &J,
                    const unsigned int           k,
                    const std::vector<Number>   &q,
                    const Number                &free)
    {
      const auto [least, largest] = extremes(J, k, q);
      if (value_of(free) < value_of(q[least]))
        return least;
      return value_of(free) > value_of(q[largest]) ? largest : invalid_index;
    }
  } // namespace

  template <typename Number>
  std::vector<Number> BasicTransfer<Number>::apply_bounded(const std::vector<Number> &q) const
  {
    std::vector<Number> transferred = apply(q);
    for (unsigned int k = 0; k < n_new(); ++k)
      if (const NodeIndex at = bound(*this, k, q, transferred[k]); at != invalid_index)
        transferred[k] = q[at];
    return transferred;
  }

  template <>
  std::vector<double> BasicTransfer<double>::reverse_apply_bounded(const std::vector<double> &q,
                                                                   std::vector<double>       &q_bar) const
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

  template <>
  void BasicTransfer<double>::set_offset(const NodalVectors<double> &X, const NodalVectors<double> &X_new)
  {
    AssertDimension(X_new.size(), n_new());
    offset = apply(X);
    for (unsigned int k = 0; k < n_new(); ++k)
      offset[k] = X_new[k] - offset[k];
  }

  template <typename Number>
  std::size_t BasicTransfer<Number>::memory_consumption() const
  {
    return sizeof(*this) + bytes(begin) + bytes(node) + bytes(weight) + bytes(offset);
  }

  template struct BasicTransfer<double>;
  template struct BasicTransfer<Dual>;
  template std::vector<double>  BasicTransfer<double>::apply(const std::vector<double> &) const;
  template NodalVectors<double> BasicTransfer<double>::apply(const NodalVectors<double> &) const;
  template std::vector<Dual>    BasicTransfer<Dual>::apply(const std::vector<Dual> &) const;
  template NodalVectors<Dual>   BasicTransfer<Dual>::apply(const NodalVectors<Dual> &) const;
  template std::vector<double>  BasicTransfer<double>::apply_transpose(const std::vector<double> &) const;
  template NodalVectors<double> BasicTransfer<double>::apply_transpose(const NodalVectors<double> &) const;
  template void                 BasicTransfer<double>::add_weight_bar(const std::vector<double> &,
                                                      const std::vector<double> &,
                                                      std::vector<double> &) const;
  template void                 BasicTransfer<double>::add_weight_bar(const NodalVectors<double> &,
                                                      const NodalVectors<double> &,
                                                      std::vector<double> &) const;

  TransferOperator make_transfer(const TetMesh                &old_mesh,
                                 const NodalVectors<double>   &X_old,
                                 const TetMesh                &new_mesh,
                                 const std::vector<NodeIndex> &old_node,
                                 const Interpolation           interpolation)
  {
    check_arguments(old_mesh, X_old, new_mesh, old_node);
    const auto                patches = patches_at_nodes(new_mesh);
    RecoveredGradient<double> gradient(old_mesh, X_old);
    RowFinder                 finder(old_mesh, X_old, gradient, interpolation);
    TransferOperator          J;
    J.n_old = old_mesh.n_nodes();
    for (NodeIndex k = 0; k < new_mesh.n_nodes(); ++k)
      if (old_node[k] != invalid_index)
        append<double>({{old_node[k], 1.}}, J);
      else
      {
        const RowSource source = finder.find(new_mesh.X[k], patches[k]);
        append(row_from(source, source.weights, X_old, gradient), J);
      }
    J.set_offset(X_old, new_mesh.X);
    return J;
  }
} // namespace retroforge
