// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/element/cell_geometry.templates.h>
#include <retroforge/steps/kept_heat.h>

#include <algorithm>
#include <numeric>

namespace retroforge
{
  namespace
  {
    constexpr double insignificant = 0.1; // [K]

    template <typename Number>
    CellGeometry<Number> geometry_of(const HeatOnMesh<Number> &on, const CellIndex c)
    {
      Four<Vector3<Number>> x;
      for (unsigned int a = 0; a < 4; ++a)
        x[a] = on.X[on.mesh.cells[c][a]];
      return cell_geometry(x);
    }

    /// Mean temperature of a cell.
    template <typename Number>
    Number of_cell(const HeatOnMesh<Number> &on, const CellIndex c)
    {
      Number sum(0.);
      for (const NodeIndex k : on.mesh.cells[c])
        sum += 0.25 * on.T[k];
      return sum;
    }

    /// Mean over the volume, and that.
    template <typename Number>
    std::pair<Number, Number> mean(const HeatOnMesh<Number> &on)
    {
      Number sum(0.), volume(0.);
      for (CellIndex c = 0; c < on.mesh.n_cells(); ++c)
      {
        const Number part = geometry_of(on, c).volume;
        sum += part * of_cell(on, c);
        volume += part;
      }
      return {sum / volume, volume};
    }

    void reverse_mean(const HeatOnMesh<double> &on,
                      const double              mean,
                      const double              volume,
                      const double              mean_bar,
                      NodalVectors<double>     &X_bar,
                      std::vector<double>      &T_bar)
    {
      for (CellIndex c = 0; c < on.mesh.n_cells(); ++c)
      {
        const auto cell  = geometry_of(on, c);
        Four<Vec3> x_bar = {};
        reverse_cell_geometry(cell, mean_bar * (of_cell(on, c) - mean) / volume, Four<Vec3>(), x_bar);
        for (unsigned int a = 0; a < 4; ++a)
        {
          X_bar[on.mesh.cells[c][a]] += x_bar[a];
          T_bar[on.mesh.cells[c][a]] += 0.25 * mean_bar * cell.volume / volume;
        }
      }
    }

    /// The node before that has the highest temperature, where heat is missing, or the lowest.
    template <typename Number>
    NodeIndex extreme(const std::vector<Number> &T, const bool highest)
    {
      const auto less = [](const Number &a, const Number &b) { return value_of(a) < value_of(b); };
      return (highest ? std::max_element(T.begin(), T.end(), less)
                      : std::min_element(T.begin(), T.end(), less)) -
             T.begin();
    }
  } // namespace

  template <typename Number>
  std::vector<Number> keep_heat(const HeatOnMesh<Number> &before, const HeatOnMesh<Number> &after)
  {
    const Number        missing = mean(before).first - mean(after).first;
    const double        sign    = value_of(missing) > 0. ? 1. : -1.;
    const Number        limit   = before.T[extreme(before.T, sign > 0.)];
    const Number        lambda  = missing / (limit - mean(after).first + sign * insignificant);
    std::vector<Number> T       = after.T;
    for (Number &x : T)
      x += lambda * (limit - x);
    return T;
  }

  template std::vector<double> keep_heat(const HeatOnMesh<double> &, const HeatOnMesh<double> &);
  template std::vector<Dual>   keep_heat(const HeatOnMesh<Dual> &, const HeatOnMesh<Dual> &);

  std::vector<double> reverse_keep_heat(const HeatOnMesh<double>  &before,
                                        const HeatOnMesh<double>  &after,
                                        const std::vector<double> &bar,
                                        NodalVectors<double>      &X_before_bar,
                                        std::vector<double>       &T_before_bar,
                                        NodalVectors<double>      &X_after_bar)
  {
    const auto [mean_before, volume_before] = mean(before);
    const auto [mean_after, volume_after]   = mean(after);
    const double    missing = mean_before - mean_after, sign = missing > 0. ? 1. : -1.;
    const NodeIndex at    = extreme(before.T, sign > 0.);
    const double    limit = before.T[at], way = limit - mean_after + sign * insignificant,
                 lambda            = missing / way;
    double              lambda_bar = 0.;
    std::vector<double> T_bar      = bar;
    for (std::size_t k = 0; k < bar.size(); ++k)
    {
      lambda_bar += bar[k] * (limit - after.T[k]);
      T_bar[k] *= 1. - lambda;
    }
    const double way_bar = -lambda_bar * lambda / way, missing_bar = lambda_bar / way;
    T_before_bar[at] += way_bar + lambda * std::accumulate(bar.begin(), bar.end(), 0.);
    reverse_mean(before, mean_before, volume_before, missing_bar, X_before_bar, T_before_bar);
    reverse_mean(after, mean_after, volume_after, -missing_bar - way_bar, X_after_bar, T_bar);
    return T_bar;
  }
} // namespace retroforge
