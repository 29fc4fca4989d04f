// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/heat/conduction_step.h>
#include <retroforge/heat/network_matrix.h>

#include <array>
#include <cmath>

/// @file
/// What a step of conduction finds on its way, for the step and for its reverse.
namespace retroforge
{
  namespace conduction
  {
    inline const double alexander = 1. - std::sqrt(0.5); // gamma of his scheme

    template <typename Number>
    std::vector<double> values(const std::vector<Number> &x)
    {
      std::vector<double> v(x.size());
      for (std::size_t i = 0; i < x.size(); ++i)
        v[i] = value_of(x[i]);
      return v;
    }

    /// C + tau (L + Phi)
    template <typename Number>
    NetworkMatrix matrix_of(const ConductionStep<Number> &step,
                            const std::vector<Number>    &g,
                            const NodeFilms<Number>      &films,
                            const double                  part)
    {
      const double        tau = part * value_of(step.dt);
      std::vector<double> D(films.conductance.size()), couplings(g.size());
      for (std::size_t i = 0; i < D.size(); ++i)
        D[i] = value_of(step.capacities[i]) + tau * value_of(films.conductance[i]);
      for (std::size_t e = 0; e < g.size(); ++e)
        couplings[e] = tau * value_of(g[e]);
      return NetworkMatrix(step.edges, std::move(D), std::move(couplings));
    }

    /// Heat that flows to each node [mW]:  S - (L + Phi) T.
    template <typename Number>
    std::vector<Number> inflow(const NetworkEdges        &edges,
                               const std::vector<Number> &g,
                               const NodeFilms<Number>   &films,
                               const std::vector<Number> &T)
    {
      std::vector<Number> flow(T.size());
      for (std::size_t i = 0; i < T.size(); ++i)
        flow[i] = films.source[i] - films.conductance[i] * T[i];
      for_each_edge(edges, [&](const unsigned int e, const NodeIndex a, const NodeIndex b) {
        const Number over = g[e] * (T[b] - T[a]);
        flow[a] += over;
        flow[b] -= over;
      });
      return flow;
    }

    /// The solution of  C x = C from + rhs + part dt inflow(x).
    inline std::vector<double> implicit(const ConductionStep<double> &step,
                                        const std::vector<double>    &g,
                                        const NodeFilms<double>      &films,
                                        const double                  part,
                                        const std::vector<double>    &from)
    {
      std::vector<double> b(from.size());
      for (std::size_t i = 0; i < b.size(); ++i)
        b[i] = step.capacities[i] * from[i] + part * step.dt * films.source[i];
      return matrix_of(step, g, films, part).solve(b, from);
    }

    inline std::vector<Dual> implicit(const ConductionStep<Dual> &step,
                                      const std::vector<Dual>    &g,
                                      const NodeFilms<Dual>      &films,
                                      const double                part,
                                      const std::vector<Dual>    &from)
    {
      const NetworkMatrix A = matrix_of(step, g, films, part);
      std::vector<double> b(from.size());
      for (std::size_t i = 0; i < b.size(); ++i)
        b[i] = step.capacities[i].val() * from[i].val() + part * step.dt.val() * films.source[i].val();
      const std::vector<double> value = A.solve(b, values(from));
      std::vector<Dual>         x(value.begin(), value.end());
      // The derivative of the residual at a fixed solution.
      const std::vector<Dual> flow = inflow(step.edges, g, films, x);
      for (std::size_t i = 0; i < b.size(); ++i)
        b[i] = (step.capacities[i] * (from[i] - x[i]) + part * step.dt * flow[i]).dx(0);
      const std::vector<double> dot = A.solve(b, std::vector<double>(b.size(), 0.));
      for (std::size_t i = 0; i < x.size(); ++i)
      {
        x[i]                 = Dual(value[i]);
        x[i].fastAccessDx(0) = dot[i];
      }
      return x;
    }

    /// a x + b y
    template <typename Number>
    std::vector<Number>
    combined(const double a, const std::vector<Number> &x, const double b, const std::vector<Number> &y)
    {
      std::vector<Number> sum(x.size());
      for (std::size_t i = 0; i < x.size(); ++i)
        sum[i] = a * x[i] + b * y[i];
      return sum;
    }

    /// Where a bound of a node's temperature comes from.
    struct Bound
    {
      enum class Of
      {
        before,
        bounded,
        film
      } of           = Of::bounded;
      NodeIndex node = invalid_index;
    };

    /// All that a step finds on its way.
    template <typename Number>
    struct Trace
    {
      NodeFilms<Number>   films_low, films_high;
      std::vector<Number> T_low, theta_1, theta_2, theta; ///< stages, and their mean
      std::vector<Number> over, through; ///< what second order adds along edges and through films [mJ]
      /// Of each node: heat that it may still take and give, what it would [mJ], their ratio, and the part of that.
      std::array<std::vector<Number>, 2> room, wanted, ratio, part;
      std::array<std::vector<Bound>, 2>  bounds; ///< largest and least temperature
    };

    constexpr unsigned int in = 0, out = 1;

    /// Flows that warm or cool a node by less than this are limited as if they did by as much [K]. So, near a uniform
    /// temperature, a step is the bounded one with its derivatives; a ratio of room and want alone would have none.
    constexpr double insignificant = 0.1;

    /// The part of a flow that is let through: at most the ratio of room and want, at most 1, and smooth.
    template <typename Number>
    Number let_through(const Number &ratio)
    {
      if (value_of(ratio) <= 0.5)
        return ratio;
      const Number rest = 1.5 - ratio;
      return value_of(rest) > 0. ? Number(1. - 0.5 * rest * rest) : Number(1.);
    }

    inline double slope_of_let_through(const double ratio)
    {
      return ratio <= 0.5 ? 1. : std::max(1.5 - ratio, 0.);
    }

    template <typename Number>
    Number bound_of(const Trace<Number> &trace, const std::vector<Number> &T, const Bound &bound)
    {
      switch (bound.of)
      {
        case Bound::Of::before:
          return T[bound.node];
        case Bound::Of::bounded:
          return trace.T_low[bound.node];
        default:
          return trace.films_low.source[bound.node] / trace.films_low.conductance[bound.node];
      }
    }

    template <typename Number>
    std::array<std::vector<Bound>, 2>
    find_bounds(const NetworkEdges &edges, const Trace<Number> &trace, const std::vector<Number> &T)
    {
      // Of a node itself, then of its neighbours: the largest and the least.
      std::array<std::vector<Bound>, 2> own, all;
      const auto value = [&](const Bound &bound) { return value_of(bound_of(trace, T, bound)); };
      for (NodeIndex i = 0; i < T.size(); ++i)
      {
        const Bound before{Bound::Of::before, i}, bounded{Bound::Of::bounded, i};
        const bool  rises = value(before) < value(bounded);
        own[in].push_back(rises ? bounded : before);
        own[out].push_back(rises ? before : bounded);
      }
      all              = own;
      const auto widen = [&](const NodeIndex i, const Bound &high, const Bound &low) {
        if (value(high) > value(all[in][i]))
          all[in][i] = high;
        if (value(low) < value(all[out][i]))
          all[out][i] = low;
      };
      for_each_edge(edges, [&](unsigned int, const NodeIndex a, const NodeIndex b) {
        widen(a, own[in][b], own[out][b]);
        widen(b, own[in][a], own[out][a]);
      });
      for (NodeIndex i = 0; i < T.size(); ++i)
        if (value_of(trace.films_low.conductance[i]) > 0.)
          widen(i, {Bound::Of::film, i}, {Bound::Of::film, i});
      return all;
    }

    /// The nodes that take and give a flow; invalid_index: a film.
    inline std::pair<NodeIndex, NodeIndex>
    ends_of(const double flow, const NodeIndex to, const NodeIndex from)
    {
      return flow >= 0. ? std::make_pair(to, from) : std::make_pair(from, to);
    }

    template <typename Number>
    Number part_of(const Trace<Number> &trace, const Number &flow, const NodeIndex to, const NodeIndex from)
    {
      const auto [takes, gives] = ends_of(value_of(flow), to, from);
      Number part(1.);
      if (takes != invalid_index)
        part *= trace.part[in][takes];
      if (gives != invalid_index)
        part *= trace.part[out][gives];
      return part;
    }

    template <typename Number>
    Trace<Number>
    trace_of(const ConductionStep<Number> &step, const std::vector<Number> &T, const FilmsAt<Number> &films)
    {
      const NetworkEdges        &edges = step.edges;
      const std::vector<Number> &g     = step.conductances;
      AssertDimension(g.size(), edges.nodes.size());
      AssertDimension(step.capacities.size(), T.size());
      Trace<Number> trace{films(T), NodeFilms<Number>(0), {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}};
      trace.T_low      = implicit(step, step.bounded, trace.films_low, 1., T);
      trace.films_high = films(combined(0.5, T, 0.5, trace.T_low));
      // C theta_1 = C T + gamma dt f(theta_1),  C theta_2 = C T + (1-gamma)/gamma C (theta_1 - T) + gamma dt f(theta_2)
      const double again = (1. - alexander) / alexander;
      trace.theta_1      = implicit(step, g, trace.films_high, alexander, T);
      trace.theta_2 =
        implicit(step, g, trace.films_high, alexander, combined(1. - again, T, again, trace.theta_1));
      trace.theta = combined(1. - alexander, trace.theta_1, alexander, trace.theta_2);
      trace.over.resize(g.size());
      trace.through.resize(T.size());
      for (auto *list : {&trace.room, &trace.wanted, &trace.ratio, &trace.part})
        for (auto &way : *list)
          way.assign(T.size(), Number(0.));
      const auto want = [&](const NodeIndex i, const Number &heat) {
        if (value_of(heat) >= 0.)
          trace.wanted[in][i] += heat;
        else
          trace.wanted[out][i] -= heat;
      };
      for_each_edge(edges, [&](const unsigned int e, const NodeIndex a, const NodeIndex b) {
        trace.over[e] = step.dt * (g[e] * (trace.theta[b] - trace.theta[a]) -
                                   step.bounded[e] * (trace.T_low[b] - trace.T_low[a]));
        want(a, trace.over[e]);
        want(b, -trace.over[e]);
      });
      for (NodeIndex i = 0; i < T.size(); ++i)
      {
        trace.through[i] =
          step.dt * (trace.films_high.source[i] - trace.films_high.conductance[i] * trace.theta[i] -
                     (trace.films_low.source[i] - trace.films_low.conductance[i] * trace.T_low[i]));
        want(i, trace.through[i]);
      }
      trace.bounds = find_bounds(edges, trace, T);
      for (const unsigned int way : {in, out})
        for (NodeIndex i = 0; i < T.size(); ++i)
        {
          const Number bound = bound_of(trace, T, trace.bounds[way][i]);
          trace.room[way][i] =
            step.capacities[i] * (way == in ? bound - trace.T_low[i] : trace.T_low[i] - bound);
          trace.ratio[way][i] =
            trace.room[way][i] / (trace.wanted[way][i] + insignificant * step.capacities[i]);
          trace.part[way][i] = let_through(trace.ratio[way][i]);
        }
      return trace;
    }
  } // namespace conduction
} // namespace retroforge
