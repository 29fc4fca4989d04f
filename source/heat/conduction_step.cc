// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/heat/conduction_trace.h>

namespace retroforge
{
  using namespace conduction;

  namespace
  {
    /// The bounded solution, and what second order may add to it.
    template <typename Number>
    ConductionResult<Number> result_of(const ConductionStep<Number> &step, const Trace<Number> &trace)
    {
      ConductionResult<Number> result{trace.T_low, std::vector<Number>(trace.T_low.size()), trace.T_low};
      for_each_edge(step.edges, [&](const unsigned int e, const NodeIndex a, const NodeIndex b) {
        const Number heat = part_of(trace, trace.over[e], a, b) * trace.over[e];
        result.T[a] += heat / step.capacities[a];
        result.T[b] -= heat / step.capacities[b];
      });
      for (NodeIndex i = 0; i < result.T.size(); ++i)
      {
        const Number part = part_of(trace, trace.through[i], i, invalid_index),
                     heat = part * trace.through[i];
        result.at_films[i] += part * (trace.theta[i] - trace.T_low[i]);
        result.film_heat[i] =
          heat + step.dt * (trace.films_low.source[i] - trace.films_low.conductance[i] * trace.T_low[i]);
        result.T[i] += heat / step.capacities[i];
      }
      return result;
    }
  } // namespace

  template <typename Number>
  ConductionResult<Number> conduction_step(const ConductionStep<Number> &step,
                                           const std::vector<Number>    &T,
                                           const FilmsAt<Number>        &films)
  {
    return result_of(step, trace_of(step, T, films));
  }

  template ConductionResult<double>
  conduction_step(const ConductionStep<double> &, const std::vector<double> &, const FilmsAt<double> &);
  template ConductionResult<Dual>
  conduction_step(const ConductionStep<Dual> &, const std::vector<Dual> &, const FilmsAt<Dual> &);
} // namespace retroforge
