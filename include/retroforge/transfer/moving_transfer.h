// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/transfer/transfer_row.h>

namespace retroforge
{
  /// The weights of J as functions of the positions of both meshes: decisions stay what they were where J was made, which cell,
  /// face or edge a node has its row from, and on what sides of these it lies. They are found again when they are asked for.
  class MovingTransfer
  {
  public:
    /// Keeps references to its arguments.
    /// @param X_old     positions of the old nodes where J was made
    /// @param new_mesh  its X are the new positions there
    MovingTransfer(const TetMesh              &old_mesh,
                   const NodalVectors<double> &X_old,
                   const TetMesh              &new_mesh,
                   const TransferOperator     &J);

    /// Returns J at other positions, without its offset.
    template <typename Number>
    BasicTransfer<Number> at(const NodalVectors<Number> &X_old, const NodalVectors<Number> &X_new);

    /// Adds the derivatives in positions, where J was made, to X_old_bar and X_new_bar.
    /// @param weight_bar  those in the weights of J
    void reverse(const std::vector<double> &weight_bar,
                 NodalVectors<double>      &X_old_bar,
                 NodalVectors<double>      &X_new_bar);

  private:
    bool             is_kept(NodeIndex k) const;
    const RowSource &source(NodeIndex k);

    const TetMesh                        &old_mesh_, &new_mesh_;
    const NodalVectors<double>           &X_old_;
    const TransferOperator               &J_;
    const std::vector<PatchSet>           patches_;
    RecoveredGradient<double>             gradient_;
    RowFinder                             finder_;
    std::vector<std::optional<RowSource>> sources_;
  };
} // namespace retroforge
