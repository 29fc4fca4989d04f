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

    /// Evaluates a field linear in the cell at the four points of equal weights that integrate to degree two.
    PointRates<double> at_points(const PointRates<double> &corners)
    {
      const double       near = (5. + 3. * std::sqrt(5.)) / 20., far = (5. - std::sqrt(5.)) / 20.;
      PointRates<double> points = {};
      for (unsigned int q = 0; q < 4; ++q)
        for (unsigned int c = 0; c < 4; ++c)
          add(c == q ? near : far, corners[c], points[q]);
      return points;
    }

    /// Deviatoric strain rates and volumes of the visited cells, in their order.
    struct DeviatoricRates
    {
      std::vector<PointRates<double>> at_corners;
      std::vector<double>             volume; ///< at least 0
    };

    DeviatoricRates deviatoric_rates(const Discretization<3>    &discretization,
                                     const NodalVectors<double> &X,
                                     const Field<double>        &W)
    {
      DeviatoricRates rates;
      dispatch_element(discretization, [&](const auto pair) {
        for (const CellIndex c : discretization.visited_cells())
        {
          const auto geometry = cell_geometry(pair.positions(discretization, X, c));
          rates.volume.push_back(std::max(cell_volume(geometry), 0.));
          rates.at_corners.push_back(corner_strain_rates(geometry, pair.at_nodes(discretization, W, c)));
          for (Symmetric<double> &e : rates.at_corners.back())
            remove_trace(e);
        }
      });
      return rates;
    }

    /// At the nodes of pressures, ghosts included: a rank visits all cells at its own nodes.
    NodeVector<6, double> recovered(const Discretization<3> &discretization, const DeviatoricRates &rates)
    {
      const auto           &nodes = discretization.pressure_nodes();
      NodeVector<6, double> at_nodes(nodes->of_width(6));
      std::vector<double>   weight(nodes->n_places(), 0.);
      for (const CellIndex c : discretization.visited_cells())
      {
        const unsigned int i = discretization.place_of_cell(c);
        for (unsigned int a = 0; a < 4; ++a)
        {
          const unsigned int place = discretization.pressure_places(c)[a];
          for (unsigned int k = 0; k < 6; ++k)
            at_nodes.at_place(place)[k] += rates.volume[i] * rates.at_corners[i][a][k];
          weight[place] += rates.volume[i];
        }
      }
      for (unsigned int place = 0; place < nodes->n_owned(); ++place)
        if (weight[place] > 0.)
          at_nodes.at_place(place) /= weight[place];
      at_nodes.update_ghosts();
      return at_nodes;
    }

    Symmetric<double> to_symmetric(const dealii::Tensor<1, 6> &entries)
    {
      Symmetric<double> e;
      for (unsigned int k = 0; k < 6; ++k)
        e[k] = entries[k];
      return e;
    }
  } // namespace

  std::vector<double> indicated_errors(const Discretization<3>               &discretization,
                                       const NodalVectors<double>            &X,
                                       const Field<double>                   &W,
                                       const Material<double>                &material,
                                       const std::vector<PointState<double>> &points)
  {
    Assert(X.size() == discretization.n_vertices(),
           dealii::ExcDimensionMismatch(X.size(), discretization.n_vertices()));
    Assert(W.belongs_to(discretization), dealii::ExcMessage("the velocities are of another discretisation"));
    const DeviatoricRates rates    = deviatoric_rates(discretization, X, W);
    const auto            at_nodes = recovered(discretization, rates);
    std::vector<double>   errors(discretization.cells().range().n, 0.);
    for (const CellIndex c : discretization.cells().owned())
    {
      const unsigned int  i      = discretization.place_of_cell(c);
      const unsigned int *n      = discretization.pressure_places(c);
      const double        weight = 0.25 * rates.volume[i];
      const auto          law    = material.at(points[c]);
      PointRates<double>  at_corners;
      for (unsigned int a = 0; a < 4; ++a)
        at_corners[a] = to_symmetric(at_nodes.at_place(n[a]));
      const PointRates<double> own = at_points(rates.at_corners[i]), better = at_points(at_corners);
      const PointRates<double> s = stresses(own, law, weight), s_better = stresses(better, law, weight);
      for (unsigned int q = 0; q < 4; ++q)
      {
        Symmetric<double> e = better[q], jump = s_better[q];
        add(-1., own[q], e);
        add(-1., s[q], jump);
        errors[c] += std::max(0., double_contraction(jump, e));
      }
    }
    discretization.cells().complete(errors.data(), 1);
    return errors;
  }
} // namespace retroforge
