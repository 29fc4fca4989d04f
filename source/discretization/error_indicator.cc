// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/discretization/error_indicator.h>
#include <retroforge/element/cell_geometry.templates.h>
#include <retroforge/element/corner_rates.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  namespace
  {
    void add(const double factor, const Symmetric<double> &e, Symmetric<double> &sum)
    {
      for (unsigned int k = 0; k < 6; ++k)
        sum[k] += factor * e[k];
    }

    void remove_trace(Symmetric<double> &e)
    {
      const double third = trace(e) / 3.;
      for (unsigned int i = 0; i < 3; ++i)
        e[i] -= third;
    }

    /// Of a field linear in the cell at the four points of equal weights that integrate it to degree two.
    PointRates<double> at_points(const PointRates<double> &corners)
    {
      const double       near = (5. + 3. * std::sqrt(5.)) / 20., far = (5. - std::sqrt(5.)) / 20.;
      PointRates<double> points = {};
      for (unsigned int q = 0; q < 4; ++q)
        for (unsigned int c = 0; c < 4; ++c)
          add(c == q ? near : far, corners[c], points[q]);
      return points;
    }

    struct DeviatoricRates
    {
      std::vector<PointRates<double>> at_corners;
      std::vector<double>             volume; ///< of the cells, at least 0
    };

    DeviatoricRates deviatoric_rates(const TetMesh              &mesh,
                                     const Spaces               &spaces,
                                     const NodalVectors<double> &X,
                                     const Field<double>        &W)
    {
      DeviatoricRates rates;
      with_pair(spaces, [&](const auto pair) {
        for (CellIndex c = 0; c < mesh.n_cells(); ++c)
        {
          const auto geometry = geometry_of_cell(mesh, X, c);
          rates.volume.push_back(std::max(geometry.volume, 0.));
          rates.at_corners.push_back(corner_strain_rates(geometry, pair.at_nodes(spaces, W, c)));
          for (Symmetric<double> &e : rates.at_corners.back())
            remove_trace(e);
        }
      });
      return rates;
    }

    std::vector<Symmetric<double>> recovered(const TetMesh &mesh, const DeviatoricRates &rates)
    {
      std::vector<Symmetric<double>> at_nodes(mesh.n_nodes(), Symmetric<double>{});
      std::vector<double>            weight(mesh.n_nodes(), 0.);
      for (CellIndex c = 0; c < mesh.n_cells(); ++c)
        for (unsigned int a = 0; a < 4; ++a)
        {
          add(rates.volume[c], rates.at_corners[c][a], at_nodes[mesh.cells[c][a]]);
          weight[mesh.cells[c][a]] += rates.volume[c];
        }
      for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
        if (weight[k] > 0.)
          for (double &e : at_nodes[k])
            e /= weight[k];
      return at_nodes;
    }
  } // namespace

  std::vector<double> indicated_errors(const TetMesh              &mesh,
                                       const Spaces               &spaces,
                                       const NodalVectors<double> &X,
                                       const Field<double>        &W,
                                       const MaterialLaw<double>  &law)
  {
    const DeviatoricRates rates    = deviatoric_rates(mesh, spaces, X, W);
    const auto            at_nodes = recovered(mesh, rates);
    std::vector<double>   errors(mesh.n_cells(), 0.);
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    {
      const auto              &n      = mesh.cells[c];
      const double             weight = 0.25 * rates.volume[c];
      const PointRates<double> own    = at_points(rates.at_corners[c]),
                               better = at_points(
                                 {{at_nodes[n[0]], at_nodes[n[1]], at_nodes[n[2]], at_nodes[n[3]]}});
      const PointRates<double> s = stresses(own, law, weight), s_better = stresses(better, law, weight);
      for (unsigned int q = 0; q < 4; ++q)
      {
        Symmetric<double> e = better[q], jump = s_better[q];
        add(-1., own[q], e);
        add(-1., s[q], jump);
        errors[c] += std::max(0., double_contraction(jump, e));
      }
    }
    return errors;
  }
} // namespace retroforge
