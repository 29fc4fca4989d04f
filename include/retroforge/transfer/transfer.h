// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/tet_mesh.h>

#include <vector>

namespace retroforge
{
  /// Linear map J of nodal values from an old to a new mesh,  q' = J q:  sparse, rows that sum to one.
  ///
  /// Its reverse is  q_bar = J^T q'_bar.  Its weights are functions of the positions of both meshes
  /// (transfer/moving_transfer.h), of which  weight_bar  gathers the derivatives. Positions follow what remeshing did to them
  /// instead (PositionTape); the offset c = X' - J X tells by how much that is off the interpolation.
  /// @cite Laroussi2003, Eq. (57), (89), (96)
  /// @tparam Number  of the weights: double or Dual
  template <typename Number>
  struct BasicTransfer
  {
    unsigned int n_old = 0; ///< nodes of the old mesh
    /// Row k has the entries begin[k] ... begin[k+1] - 1 of the two lists below.
    std::vector<unsigned int> begin = {0};
    std::vector<NodeIndex>    node;   ///< old nodes
    std::vector<Number>       weight; ///< dimensionless
    NodalVectors<double>      offset; ///< c = X' - J X [mm], one per new node; none with dual numbers

    unsigned int n_new() const { return begin.size() - 1; }

    /// J q. Throws Error when q has not one value per old node.
    /// @tparam Value  Number, or a vector of them
    template <typename Value>
    std::vector<Value> apply(const std::vector<Value> &q) const;

    /// J^T q'_bar: each new node gives its value to the old nodes of its row. Throws Error when q'_bar has
    /// not one value per new node.
    /// @tparam Value  double or Vec3
    template <typename Value>
    std::vector<Value> apply_transpose(const std::vector<Value> &q_bar) const;

    /// J q, each value within the range of those that its row takes: weights may be negative.
    std::vector<Number> apply_bounded(const std::vector<Number> &q) const;

    /// The pull-back of apply_bounded at q.  @return q_bar; of q'_bar what is not bounded is left
    std::vector<double> reverse_apply_bounded(const std::vector<double> &q, std::vector<double> &q_bar) const;

    /// Adds the derivatives of q'_bar·(J q) in the weights to weight_bar, one number per entry.
    /// @tparam Value  double or Vec3
    template <typename Value>
    void add_weight_bar(const std::vector<Value> &q,
                        const std::vector<Value> &q_bar,
                        std::vector<double>      &weight_bar) const;

    /// c = X' - J X.
    void set_offset(const NodalVectors<double> &X, const NodalVectors<double> &X_new);

    /// Bytes in use.
    std::size_t memory_consumption() const;
  };

  using TransferOperator = BasicTransfer<double>;

  template <>
  std::vector<double> BasicTransfer<double>::reverse_apply_bounded(const std::vector<double> &q,
                                                                   std::vector<double>       &q_bar) const;
  template <>
  void BasicTransfer<double>::set_offset(const NodalVectors<double> &X, const NodalVectors<double> &X_new);

  /// The interpolation by which values reach new nodes.
  ///
  /// Measured on boxes of about 1200 (6600) nodes, relative L2 error of a Gaussian exp(-|x|^2/(2h)^2) after
  /// 10 and 60 transfers: between two unrelated meshes 0.39 and 0.73 (0.46 and 0.87) linear, 0.12 and 0.30
  /// (0.15 and 0.42) with half gradients; with 3 % of the nodes moved each time 0.022 and 0.104 (0.029 and
  /// 0.108) against 0.0065 and 0.031 (0.011 and 0.034). Undershoot with half gradients: 0.2 to 1.9 % of the
  /// peak. Cost per new node: 4 against 60 microseconds. Hence half gradients are the default. Noise falls,
  /// too, to 0.4 of its norm in 60 transfers; but it is not stable for ever: back and forth 500 times between
  /// one pair of meshes, noise grows again, by 0.2 % each time. The whole gradient makes it grow by 20 %.
  enum class Interpolation
  {
    linear, ///< between the corners of the old cell: weights >= 0, no value leaves the range of the old ones
    /// The linear value  q(x) = sum_a w_a q_a  plus half of the correction by recovered gradients,
    ///   q(x) + 1/2 sum_a w_a G_a·(x - x_a),
    /// which cancels the error of linear interpolation as far as G_a is the gradient of a quadratic field at
    /// the corner a. It is that of the cubic that fits the values around (RecoveredGradient); on a patch it
    /// is tangential and of the patch's values only, on a ridge along it and of the ridge's values. Still
    /// linear in q and exact for linear fields, but with negative weights and about 40 entries a row. Linear
    /// where a corner has no gradient: beside inverted cells, and at edges within a patch.
    half_gradient
  };

  /// Finds J and c. Rows of kept nodes are identities, so that their values do not change even where the node
  /// has moved a little. A new node inside takes its row from the old cell that contains it (the closest
  /// point of the old mesh when it is outside); a new node of the surface from the closest old face of the
  /// same patch, on a ridge between two patches from the closest edge of the old ridge, in a corner from the
  /// old corner. What holds on a patch, ridge or corner (v·n = 0 on a symmetry plane) thus holds after the
  /// transfer; rows of the surface never contain nodes of the inside, whatever the interpolation.
  /// @param X_old     current positions of the old nodes
  /// @param new_mesh  its X are the new positions; its patches are those of the old mesh
  /// @param old_node  of each new node: the old node it is, or invalid_index
  /// Throws Error when sizes or patches do not match.
  TransferOperator make_transfer(const TetMesh                &old_mesh,
                                 const NodalVectors<double>   &X_old,
                                 const TetMesh                &new_mesh,
                                 const std::vector<NodeIndex> &old_node,
                                 Interpolation                 interpolation = Interpolation::half_gradient);
} // namespace retroforge
