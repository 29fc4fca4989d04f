// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/steps/point_states.h>

namespace retroforge
{
  template <typename Number>
  std::vector<PointState<Number>>
  point_states(const TetMesh &mesh, const PointState<Number> &initial, const WorkpieceState<3, Number> &state)
  {
    AssertDimension(state.strain.size(), mesh.n_cells());
    std::vector<PointState<Number>> points(state.strain.size(), initial);
    for (std::size_t c = 0; c < points.size(); ++c)
      points[c].strain = state.strain[c];
    if (!state.temperature.empty())
      for (std::size_t c = 0; c < points.size(); ++c)
      {
        points[c].temperature = Number(0.);
        for (const NodeIndex k : mesh.cells[c])
          points[c].temperature += 0.25 * state.temperature[k];
      }
    return points;
  }

  template std::vector<PointState<double>>
  point_states(const TetMesh &, const PointState<double> &, const WorkpieceState<3, double> &);
  template std::vector<PointState<Dual>>
  point_states(const TetMesh &, const PointState<Dual> &, const WorkpieceState<3, Dual> &);

  void reverse_point_states(const TetMesh                         &mesh,
                            const std::vector<PointState<double>> &bar,
                            PointState<double>                    &initial_bar,
                            WorkpieceState<3, double>             &costate)
  {
    AssertDimension(bar.size(), mesh.n_cells());
    AssertDimension(costate.strain.size(), mesh.n_cells());
    for (std::size_t c = 0; c < bar.size(); ++c)
    {
      costate.strain[c] += bar[c].strain;
      if (costate.temperature.empty())
        initial_bar.temperature += bar[c].temperature;
      else
        for (const NodeIndex k : mesh.cells[c])
          costate.temperature[k] += 0.25 * bar[c].temperature;
    }
  }
} // namespace retroforge
