// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/heat/conduction_trace.h>

namespace retroforge
{
  using namespace conduction;

  namespace
  {
    /// Reverse of implicit(): adds the derivatives in all it is made of, and returns those in `from`.
    std::vector<double> reverse_implicit(const ConductionStep<double> &step,
                                         const std::vector<double>    &g,
                                         const NodeFilms<double>      &films,
                                         const double                  part,
                                         const std::vector<double>    &from,
                                         const std::vector<double>    &x,
                                         const std::vector<double>    &x_bar,
                                         std::vector<double>          &g_bar,
                                         NodeFilms<double>            &films_bar,
                                         ConductionStepBar            &bar)
    {
      const std::vector<double> lambda =
        matrix_of(step, g, films, part).solve(x_bar, std::vector<double>(x.size(), 0.));
      const std::vector<double> flow = inflow(step.edges, g, films, x);
      std::vector<double>       from_bar(x.size());
      const double              tau = part * step.dt;
      for (std::size_t i = 0; i < x.size(); ++i)
      {
        bar.dt += part * lambda[i] * flow[i];
        bar.capacities[i] += lambda[i] * (from[i] - x[i]);
        films_bar.source[i] += tau * lambda[i];
        films_bar.conductance[i] -= tau * lambda[i] * x[i];
        from_bar[i] = step.capacities[i] * lambda[i];
      }
      for_each_edge(step.edges, [&](const unsigned int e, const NodeIndex a, const NodeIndex b) {
        g_bar[e] += tau * (lambda[a] - lambda[b]) * (x[b] - x[a]);
      });
      return from_bar;
    }

    void add(const double weight, const std::vector<double> &from, std::vector<double> &to)
    {
      for (std::size_t i = 0; i < to.size(); ++i)
        to[i] += weight * from[i];
    }

    /// A step backwards, in the order against that of trace_of() and result_of().
    class StepBackwards
    {
    public:
      StepBackwards(const ConductionStep<double> &step,
                    const std::vector<double>    &T,
                    const FilmsAt<double>        &films,
                    const std::vector<double>    &T_bar,
                    const std::vector<double>    &at_films_bar,
                    ConductionStepBar            &bar)
          : step_(step)
          , g_(step.conductances)
          , C_(step.capacities)
          , T_(T)
          , T_bar_(T_bar)
          , at_films_bar_(at_films_bar)
          , n_(T.size())
          , trace_(trace_of(step, T, films))
          , bar_(bar)
          , from_bar_(n_, 0.)
          , low_bar_(T_bar)
          , theta_bar_(n_, 0.)
          , over_bar_(g_.size())
          , through_bar_(n_)
          , at_films_(n_)
          , films_low_bar_(n_)
          , films_high_bar_(n_)
      {
        part_bar_.fill(std::vector<double>(n_, 0.));
        wanted_bar_ = part_bar_;
      }

      ReversedConductionStep run(const ReverseFilmsAt &reverse_films)
      {
        reverse_sums();
        reverse_parts();
        reverse_flows();
        reverse_stages();
        reverse_bounded(reverse_films);
        return {from_bar_, at_films_};
      }

    private:
      /// What is added to the bounded solution, limited.
      void reverse_sums()
      {
        const auto reverse_part =
          [&](const double flow, const NodeIndex to, const NodeIndex from, const double bar_of_part) {
            const auto [takes, gives] = ends_of(flow, to, from);
            if (takes != invalid_index)
              part_bar_[in][takes] += bar_of_part * (gives == invalid_index ? 1. : trace_.part[out][gives]);
            if (gives != invalid_index)
              part_bar_[out][gives] += bar_of_part * (takes == invalid_index ? 1. : trace_.part[in][takes]);
          };
        for_each_edge(step_.edges, [&](const unsigned int e, const NodeIndex a, const NodeIndex b) {
          const double part     = part_of(trace_, trace_.over[e], a, b),
                       heat_bar = T_bar_[a] / C_[a] - T_bar_[b] / C_[b];
          bar_.capacities[a] -= T_bar_[a] * part * trace_.over[e] / (C_[a] * C_[a]);
          bar_.capacities[b] += T_bar_[b] * part * trace_.over[e] / (C_[b] * C_[b]);
          over_bar_[e] = part * heat_bar;
          reverse_part(trace_.over[e], a, b, trace_.over[e] * heat_bar);
        });
        for (NodeIndex i = 0; i < n_; ++i)
        {
          const double part = part_of(trace_, trace_.through[i], i, invalid_index);
          bar_.capacities[i] -= T_bar_[i] * part * trace_.through[i] / (C_[i] * C_[i]);
          through_bar_[i]  = part * T_bar_[i] / C_[i];
          const double off = trace_.theta[i] - trace_.T_low[i];
          reverse_part(trace_.through[i],
                       i,
                       invalid_index,
                       trace_.through[i] * T_bar_[i] / C_[i] + off * at_films_bar_[i]);
          low_bar_[i] += (1. - part) * at_films_bar_[i];
          theta_bar_[i] += part * at_films_bar_[i];
          at_films_[i] = trace_.T_low[i] + part * off;
        }
      }

      /// The parts that are let through.
      void reverse_parts()
      {
        for (const unsigned int way : {in, out})
          for (NodeIndex i = 0; i < n_; ++i)
          {
            const double ratio_bar = part_bar_[way][i] * slope_of_let_through(trace_.ratio[way][i]);
            if (ratio_bar == 0.)
              continue;
            const Bound &bound  = trace_.bounds[way][i];
            const double wanted = trace_.wanted[way][i] + insignificant * C_[i], sign = way == in ? 1. : -1.;
            const double room_bar = ratio_bar / wanted;
            wanted_bar_[way][i]   = -ratio_bar * trace_.room[way][i] / (wanted * wanted);
            bar_.capacities[i] += room_bar * sign * (bound_of(trace_, T_, bound) - trace_.T_low[i]) +
                                  wanted_bar_[way][i] * insignificant;
            low_bar_[i] -= sign * C_[i] * room_bar;
            const double bound_bar = sign * C_[i] * room_bar;
            if (bound.of == Bound::Of::before)
              from_bar_[bound.node] += bound_bar;
            else if (bound.of == Bound::Of::bounded)
              low_bar_[bound.node] += bound_bar;
            else
            {
              const double phi = trace_.films_low.conductance[bound.node];
              films_low_bar_.source[bound.node] += bound_bar / phi;
              films_low_bar_.conductance[bound.node] -=
                bound_bar * trace_.films_low.source[bound.node] / (phi * phi);
            }
          }
      }

      /// What second order adds along edges and through films.
      void reverse_flows()
      {
        const auto wanted_by = [&](const NodeIndex i, const double heat) {
          return heat >= 0. ? wanted_bar_[in][i] : -wanted_bar_[out][i];
        };
        for_each_edge(step_.edges, [&](const unsigned int e, const NodeIndex a, const NodeIndex b) {
          const double heat = trace_.over[e];
          over_bar_[e] += wanted_by(a, heat) - wanted_by(b, -heat);
          bar_.dt += over_bar_[e] * heat / step_.dt;
          const double rate_bar = over_bar_[e] * step_.dt;
          bar_.conductances[e] += rate_bar * (trace_.theta[b] - trace_.theta[a]);
          bar_.bounded[e] -= rate_bar * (trace_.T_low[b] - trace_.T_low[a]);
          theta_bar_[b] += rate_bar * g_[e];
          theta_bar_[a] -= rate_bar * g_[e];
          low_bar_[b] -= rate_bar * step_.bounded[e];
          low_bar_[a] += rate_bar * step_.bounded[e];
        });
        for (NodeIndex i = 0; i < n_; ++i)
        {
          through_bar_[i] += wanted_by(i, trace_.through[i]);
          bar_.dt += through_bar_[i] * trace_.through[i] / step_.dt;
          const double rate_bar = through_bar_[i] * step_.dt;
          films_high_bar_.source[i] += rate_bar;
          films_high_bar_.conductance[i] -= rate_bar * trace_.theta[i];
          films_low_bar_.source[i] -= rate_bar;
          films_low_bar_.conductance[i] += rate_bar * trace_.T_low[i];
          theta_bar_[i] -= rate_bar * trace_.films_high.conductance[i];
          low_bar_[i] += rate_bar * trace_.films_low.conductance[i];
        }
      }

      /// The two stages.
      void reverse_stages()
      {
        const double              again  = (1. - alexander) / alexander;
        const std::vector<double> from_2 = combined(1. - again, T_, again, trace_.theta_1);
        std::vector<double>       theta_1_bar(n_, 0.), theta_2_bar(n_, 0.);
        add(alexander, theta_bar_, theta_2_bar);
        add(1. - alexander, theta_bar_, theta_1_bar);
        const auto from_2_bar = reverse_implicit(step_,
                                                 g_,
                                                 trace_.films_high,
                                                 alexander,
                                                 from_2,
                                                 trace_.theta_2,
                                                 theta_2_bar,
                                                 bar_.conductances,
                                                 films_high_bar_,
                                                 bar_);
        add(1. - again, from_2_bar, from_bar_);
        add(again, from_2_bar, theta_1_bar);
        add(1.,
            reverse_implicit(step_,
                             g_,
                             trace_.films_high,
                             alexander,
                             T_,
                             trace_.theta_1,
                             theta_1_bar,
                             bar_.conductances,
                             films_high_bar_,
                             bar_),
            from_bar_);
      }

      /// Films at the middle of the time, the bounded solution, and films at the start.
      void reverse_bounded(const ReverseFilmsAt &reverse_films)
      {
        std::vector<double> middle_bar(n_, 0.);
        reverse_films(combined(0.5, T_, 0.5, trace_.T_low), films_high_bar_, middle_bar);
        add(0.5, middle_bar, from_bar_);
        add(0.5, middle_bar, low_bar_);
        add(1.,
            reverse_implicit(step_,
                             step_.bounded,
                             trace_.films_low,
                             1.,
                             T_,
                             trace_.T_low,
                             low_bar_,
                             bar_.bounded,
                             films_low_bar_,
                             bar_),
            from_bar_);
        reverse_films(T_, films_low_bar_, from_bar_);
      }

      const ConductionStep<double> &step_;
      const std::vector<double>    &g_, &C_, &T_, &T_bar_, &at_films_bar_;
      const std::size_t             n_;
      const Trace<double>           trace_;
      ConductionStepBar            &bar_;

      /// Derivatives in what a step finds on its way, with the names of Trace; `from`, in the temperatures before.
      std::vector<double>                from_bar_, low_bar_, theta_bar_, over_bar_, through_bar_;
      std::array<std::vector<double>, 2> part_bar_, wanted_bar_;
      std::vector<double>                at_films_;
      NodeFilms<double>                  films_low_bar_, films_high_bar_;
    };
  } // namespace

  ReversedConductionStep reverse_conduction_step(const ConductionStep<double> &step,
                                                 const std::vector<double>    &T,
                                                 const FilmsAt<double>        &films,
                                                 const std::vector<double>    &T_bar,
                                                 const std::vector<double>    &at_films_bar,
                                                 const ReverseFilmsAt         &reverse_films,
                                                 ConductionStepBar            &bar)
  {
    return StepBackwards(step, T, films, T_bar, at_films_bar, bar).run(reverse_films);
  }
} // namespace retroforge
