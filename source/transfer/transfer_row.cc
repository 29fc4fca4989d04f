// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/dual.h>
#include <retroforge/transfer/transfer_row.h>

#include <algorithm>
#include <numeric>

namespace retroforge
{
  namespace
  {
    // In the middle of an edge the other corners have no part but rounding.
    void drop_rounding(std::vector<double> &weights)
    {
      for (double &weight : weights)
        if (weight < 1e-14)
          weight = 0.;
      const double sum = std::accumulate(weights.begin(), weights.end(), 0.);
      for (double &weight : weights)
        weight /= sum;
    }
  } // namespace

  RowFinder::RowFinder(const TetMesh              &mesh,
                       const NodalVectors<double> &X,
                       RecoveredGradient<double>  &gradient,
                       const Interpolation         interpolation)
      : mesh_(mesh), X_(X), gradient_(gradient), interpolation_(interpolation)
  {
  }

  RowSource RowFinder::find(const Vec3 &x, const PatchSet &patches)
  {
    RowSource source;
    if (patches.empty())
    {
      if (!cells_)
        cells_.emplace(mesh_, X_);
      const CellPoint point = cells_->locate(x);
      source.corners.assign(mesh_.cells[point.cell].begin(), mesh_.cells[point.cell].end());
      source.weights.assign(point.weights.begin(), point.weights.end());
    }
    else
    {
      if (!boundary_)
        boundary_.emplace(mesh_, X_);
      BoundaryPoint point = boundary_->locate(x, patches);
      source              = {std::move(point.nodes), std::move(point.weights), std::move(point.patches)};
    }
    drop_rounding(source.weights);
    // All gradients or none: else linear fields are not exact.
    source.has_gradient = interpolation_ == Interpolation::half_gradient && source.corners.size() > 1 &&
                          std::all_of(source.corners.begin(), source.corners.end(), [&](const NodeIndex a) {
                            return gradient_.has(a, source.patches);
                          });
    return source;
  }

  namespace
  {
    /// The corners that a point is a mean of, and what it takes to project onto them.
    template <typename Number>
    struct Span
    {
      std::vector<std::size_t>     active; ///< their places among the corners
      std::vector<Vector3<Number>> edges;  ///< X_a - X_0
      Vector3<Number>              origin; ///< X_0

      Span(const RowSource &source, const NodalVectors<Number> &X)
      {
        for (std::size_t a = 0; a < source.corners.size(); ++a)
          if (source.weights[a] > 0.)
            active.push_back(a);
        origin = X[source.corners[active[0]]];
        for (std::size_t i = 1; i < active.size(); ++i)
          edges.push_back(X[source.corners[active[i]]] - origin);
      }

      /// Returns (E^T E)^-1 x, by Gauss.
      std::vector<Number> solved(std::vector<Number> x) const
      {
        const std::size_t                n = edges.size();
        std::vector<std::vector<Number>> G(n, std::vector<Number>(n));
        for (std::size_t i = 0; i < n; ++i)
          for (std::size_t j = 0; j < n; ++j)
            G[i][j] = edges[i] * edges[j];
        for (std::size_t k = 0; k < n; ++k)
          for (std::size_t i = k + 1; i < n; ++i)
          {
            const Number part = G[i][k] / G[k][k];
            for (std::size_t j = k; j < n; ++j)
              G[i][j] -= part * G[k][j];
            x[i] -= part * x[k];
          }
        for (std::size_t i = n; i-- > 0;)
        {
          for (std::size_t j = i + 1; j < n; ++j)
            x[i] -= G[i][j] * x[j];
          x[i] /= G[i][i];
        }
        return x;
      }
    };
  } // namespace

  template <typename Number>
  std::vector<Number>
  projected_weights(const RowSource &source, const Vector3<Number> &y, const NodalVectors<Number> &X)
  {
    const Span<Number>  span(source, X);
    std::vector<Number> right;
    for (const Vector3<Number> &edge : span.edges)
      right.push_back(edge * (y - span.origin));
    const auto          found = span.solved(std::move(right));
    std::vector<Number> l(source.corners.size(), Number(0.));
    Number              first(1.);
    for (std::size_t i = 0; i < found.size(); ++i)
    {
      l[span.active[i + 1]] = found[i];
      first -= found[i];
    }
    l[span.active[0]] = first;
    return l;
  }

  // With r = y - x, s = (E^T E)^-1 l_bar and t = E s:  sum l_bar·l_dot = sum_a s_a (X_a - X_0)_dot·r + t·(y_dot - sum_a l_a X_a_dot).
  void reverse_projected_weights(const RowSource            &source,
                                 const Vec3                 &y,
                                 const NodalVectors<double> &X,
                                 const std::vector<double>  &l_bar,
                                 Vec3                       &y_bar,
                                 NodalVectors<double>       &X_bar)
  {
    const Span<double>  span(source, X);
    const auto          l = projected_weights(source, y, X);
    std::vector<double> right;
    for (std::size_t i = 1; i < span.active.size(); ++i)
      right.push_back(l_bar[span.active[i]] - l_bar[span.active[0]]);
    const auto s = span.solved(std::move(right));
    Vec3       t, r = y;
    for (std::size_t i = 0; i < s.size(); ++i)
      t += s[i] * span.edges[i];
    for (std::size_t a = 0; a < l.size(); ++a)
      r -= l[a] * X[source.corners[a]];
    y_bar += t;
    for (std::size_t i = 0; i < span.active.size(); ++i)
      X_bar[source.corners[span.active[i]]] -= l[span.active[i]] * t;
    for (std::size_t i = 0; i < s.size(); ++i)
    {
      X_bar[source.corners[span.active[i + 1]]] += s[i] * r;
      X_bar[source.corners[span.active[0]]] -= s[i] * r;
    }
  }

  namespace
  {
    // Ascending nodes, each once; no zeros; the largest weight takes what the sum lacks of one.
    template <typename Number>
    TransferRow<Number> tidy(TransferRow<Number> row)
    {
      std::stable_sort(
        row.begin(), row.end(), [](const auto &a, const auto &b) { return a.first < b.first; });
      TransferRow<Number> merged;
      for (const auto &[node, weight] : row)
        if (!merged.empty() && merged.back().first == node)
          merged.back().second += weight;
        else
          merged.emplace_back(node, weight);
      merged.erase(std::remove_if(merged.begin(),
                                  merged.end(),
                                  [](const auto &entry) { return value_of(entry.second) == 0.; }),
                   merged.end());
      const auto largest = std::max_element(merged.begin(), merged.end(), [](const auto &a, const auto &b) {
        return value_of(a.second) < value_of(b.second);
      });
      // Summed up in the order of apply(), and twice, as the first correction is rounded itself.
      for (unsigned int pass = 0; pass < 2; ++pass)
      {
        Number sum(0.);
        for (const auto &entry : merged)
          sum += entry.second;
        largest->second += 1. - sum;
      }
      return merged;
    }

    // The arms x - x_a are taken from the point the weights give: for a node outside of the old mesh that
    // is its closest point, and linear fields stay exact there.
    template <typename Number>
    TransferRow<Number> with_gradient(const TransferRow<Number>  &linear,
                                      const PatchSet             &patches,
                                      const NodalVectors<Number> &X,
                                      RecoveredGradient<Number>  &gradient)
    {
      TransferRow<Number> row = linear;
      Vector3<Number>     x;
      for (const auto &[node, weight] : linear)
        x += weight * X[node];
      for (const auto &[node, weight] : linear)
        if (!gradient.add_directional(node, patches, Number(0.5 * weight) * (x - X[node]), row))
          return linear;
      return row;
    }
  } // namespace

  template <typename Number>
  TransferRow<Number> row_from(const RowSource            &source,
                               const std::vector<Number>  &l,
                               const NodalVectors<Number> &X,
                               RecoveredGradient<Number>  &gradient)
  {
    TransferRow<Number> linear;
    for (std::size_t a = 0; a < l.size(); ++a)
      linear.emplace_back(source.corners[a], l[a]);
    return tidy(source.has_gradient ? with_gradient(linear, source.patches, X, gradient) : std::move(linear));
  }

#define RETROFORGE_INSTANTIATE(Number)                                         \
  template std::vector<Number> projected_weights(                              \
    const RowSource &, const Vector3<Number> &, const NodalVectors<Number> &); \
  template TransferRow<Number> row_from(const RowSource &,                     \
                                        const std::vector<Number> &,           \
                                        const NodalVectors<Number> &,          \
                                        RecoveredGradient<Number> &);
  RETROFORGE_INSTANTIATE(double)
  RETROFORGE_INSTANTIATE(Dual)
#undef RETROFORGE_INSTANTIATE
} // namespace retroforge
