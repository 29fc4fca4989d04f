// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/steps/point_states.h>

namespace retroforge
{
  template <typename Number>
  std::vector<PointState<Number>> point_states([[maybe_unused]] const TetMesh  &mesh,
                                               const WorkpieceState<3, Number> &state)
  {
    AssertDimension(state.strain.size(), mesh.n_cells());
    std::vector<PointState<Number>> points(state.strain.size());
    for (std::size_t c = 0; c < points.size(); ++c)
      points[c].strain = state.strain[c];
    return points;
  }

  template std::vector<PointState<double>> point_states(const TetMesh &, const WorkpieceState<3, double> &);
  template std::vector<PointState<Dual>>   point_states(const TetMesh &, const WorkpieceState<3, Dual> &);

  void reverse_point_states([[maybe_unused]] const TetMesh        &mesh,
                            const std::vector<PointState<double>> &bar,
                            WorkpieceState<3, double>             &costate)
  {
    AssertDimension(bar.size(), mesh.n_cells());
    AssertDimension(costate.strain.size(), mesh.n_cells());
    for (std::size_t c = 0; c < bar.size(); ++c)
      costate.strain[c] += bar[c].strain;
  }
} // namespace retroforge
