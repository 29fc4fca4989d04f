// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/point_location.h>
#include <retroforge/transfer/recovered_gradient.h>
#include <retroforge/transfer/transfer.h>

/// @file
/// A row of J, of a node that remeshing has made: what is decided about it, and what follows from that and positions.
///
/// The point x of the old mesh that is closest to the new node y is a mean of corners,  x = sum_a l_a X_a,  of a cell, a face of
/// a patch, an edge of a ridge; l are those of the projection of y on what the corners with l_a > 0 span. The row is
///   sum_a l_a ( q_a + 1/2 G_a·(x - X_a) ),
/// G_a the recovered gradient, or has l alone.
namespace retroforge
{
  /// Where a row comes from: what is decided.
  struct RowSource
  {
    std::vector<NodeIndex> corners;
    std::vector<double>    weights; ///< l >= 0, sum 1
    PatchSet               patches; ///< of the face or edge that x lies in; none inside
    bool                   has_gradient = false;
  };

  /// Decides where rows come from; what is needed for that is built when it is asked for.
  class RowFinder
  {
  public:
    /// Keeps references to its arguments.
    /// @param gradient  of the same mesh
    RowFinder(const TetMesh              &mesh,
              const NodalVectors<double> &X,
              RecoveredGradient<double>  &gradient,
              Interpolation               interpolation);

    /// @param x        position of the new node
    /// @param patches  it is on
    RowSource find(const Vec3 &x, const PatchSet &patches);

  private:
    const TetMesh                 &mesh_;
    const NodalVectors<double>    &X_;
    RecoveredGradient<double>     &gradient_;
    const Interpolation            interpolation_;
    std::optional<CellLocator>     cells_;
    std::optional<BoundaryLocator> boundary_;
  };

  template <typename Number>
  using TransferRow = std::vector<std::pair<NodeIndex, Number>>;

  /// Returns l of a node at y, as a function of it and of the corners' positions X.
  template <typename Number>
  std::vector<Number>
  projected_weights(const RowSource &source, const Vector3<Number> &y, const NodalVectors<Number> &X);

  /// Adds the pull-back of l_bar through projected_weights() to y_bar and X_bar.
  void reverse_projected_weights(const RowSource            &source,
                                 const Vec3                 &y,
                                 const NodalVectors<double> &X,
                                 const std::vector<double>  &l_bar,
                                 Vec3                       &y_bar,
                                 NodalVectors<double>       &X_bar);

  /// Returns the row: ascending nodes, each once, no zeros; it sums to one. Without gradients where the positions, which are
  /// others than those it was decided at, have none.
  /// @param l  the weights
  template <typename Number>
  TransferRow<Number> row_from(const RowSource            &source,
                               const std::vector<Number>  &l,
                               const NodalVectors<Number> &X,
                               RecoveredGradient<Number>  &gradient);

  /// Adds the pull-back of row_from() to l_bar and X_bar.
  /// @param bar  returns the derivative in the row's entry of a node
  template <typename Bar>
  void reverse_row(const RowSource            &source,
                   const std::vector<double>  &l,
                   const NodalVectors<double> &X,
                   RecoveredGradient<double>  &gradient,
                   const Bar                  &bar,
                   std::vector<double>        &l_bar,
                   NodalVectors<double>       &X_bar)
  {
    Vec3 x, x_bar;
    for (std::size_t a = 0; a < l.size(); ++a)
    {
      x += l[a] * X[source.corners[a]];
      l_bar[a] += bar(source.corners[a]);
    }
    if (!source.has_gradient)
      return;
    for (std::size_t a = 0; a < l.size(); ++a)
    {
      if (l[a] == 0.)
        continue;
      const NodeIndex node = source.corners[a];
      const Vec3      arm  = x - X[node];
      Vec3            direction_bar;
      gradient.reverse(node, source.patches, 0.5 * l[a] * arm, bar, X_bar, direction_bar);
      l_bar[a] += 0.5 * arm * direction_bar;
      x_bar += 0.5 * l[a] * direction_bar;
      X_bar[node] -= 0.5 * l[a] * direction_bar;
    }
    for (std::size_t a = 0; a < l.size(); ++a)
    {
      l_bar[a] += x_bar * X[source.corners[a]];
      X_bar[source.corners[a]] += l[a] * x_bar;
    }
  }

  template <typename Number>
  void append(const TransferRow<Number> &row, BasicTransfer<Number> &J)
  {
    for (const auto &[node, weight] : row)
    {
      J.node.push_back(node);
      J.weight.push_back(weight);
    }
    J.begin.push_back(J.node.size());
  }
} // namespace retroforge
