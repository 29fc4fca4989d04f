// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/contact/penetration.h>
#include <retroforge/core/text.h>
#include <retroforge/core/version.h>
#include <retroforge/design/mesh_anew.h>
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/output/blas.h>
#include <retroforge/output/warnings.h>
#include <retroforge/run/run_summary.h>

#include <algorithm>

namespace retroforge
{
  namespace
  {
    /// How often the objective's value stands in the whole part; NaN where it says nothing of that.
    double copies(const Case &forging_case, const NamedObjective &objective, const WholePart &whole)
    {
      if (objective.scaling == SymmetryScaling::none)
        return Summary::unknown;
      return objective.scaling == SymmetryScaling::part
               ? whole.copies
               : whole_part(forging_case.billet, forging_case.process.dies[objective.die].velocity).force;
    }

    void summarise_restarts(const std::vector<NumericsSegment> &segments, Summary &summary)
    {
      for (std::size_t s = 1; s < segments.size(); ++s)
      {
        const RecordedInput &input = segments[s].input;
        summary.restarts.push_back({input.first + 1, input.stroke, {}});
        for (const ChangedSetting &setting :
             changed_numerics(segments[s - 1].input.parameters, input.parameters))
          summary.restarts.back().changed[setting.path] = {setting.before, setting.now};
      }
    }
  } // namespace

  namespace
  {
    /// k/(rho c) of hot steel [mm^2/s], where heat does not flow.
    constexpr double diffusivity = 5.6;

    double mean_temperature(const TetMesh &mesh, const WorkpieceState<3, double> &workpiece)
    {
      double sum = 0., whole = 0.;
      for (const auto &cell : mesh.cells)
      {
        const double part = tet_volume(corners(cell, workpiece.X));
        whole += part;
        for (const NodeIndex k : cell)
          sum += 0.25 * part * workpiece.temperature[k];
      }
      return sum / whole;
    }

    /// Warming by the work of deformation,  chi E/(rho c |Omega|),  and the depth  sqrt(a t)  of a chill.
    Summary::Heat summarise_heat(const Process<double> &process,
                                 const ForgingState    &forged,
                                 const double           volume,
                                 const double           edge_length)
    {
      Summary::Heat heat;
      if (forged.increments == 0)
        return heat;
      const HeatLaw<double> &law = process.heat;
      heat.warms                 = law.warms();
      heat.conducts              = law.conducts();
      heat.warming               = law.fraction * forged.energy.deformation / (law.capacity * volume);
      heat.seconds               = process.time_on_dies(forged.stroke, forged.operation);
      bool chills                = !heat.conducts || law.contact_film > 0.;
      if (heat.conducts)
        for (unsigned int o = 0; o <= forged.operation; ++o)
        {
          const auto &waiting = process.operations[o].waiting;
          heat.waits.push_back({waiting.transfer, waiting.dwell});
          chills = chills || (law.dwell_film > 0. && waiting.dwell > 0.);
        }
      const double a = heat.conducts ? law.conductivity / law.capacity : diffusivity;
      heat.chilled   = chills ? std::sqrt(a * heat.seconds) : 0.;
      heat.elements  = heat.chilled / edge_length;
      if (!forged.workpiece.temperature.empty())
        heat.mean_temperature = mean_temperature(forged.epoch->scene.mesh, forged.workpiece);
      return heat;
    }
  } // namespace

  double shape_volume(const Case &forging_case)
  {
    if (!has_measures(forging_case.parameters.billet))
      return Summary::unknown;
    const TetMesh &made = forging_case.first.mesh;
    return shape_volume(forging_case.first.shapes.measured(forging_case.first.at)) /
           volume(made.cells, made.X) * volume(made.cells, forging_case.X_0);
  }

  void summarise_run(const Case            &forging_case,
                     const Process<double> &process,
                     const ForgingState    &forged,
                     Summary               &summary)
  {
    summary.command               = word_of(forging_case.command.command.value());
    summary.version               = version;
    summary.commit                = commit;
    summary.blas                  = blas_in_use();
    summary.ranks                 = dealii::Utilities::MPI::n_mpi_processes(forging_case.comm);
    summary.n_nodes               = forging_case.billet.n_nodes();
    summary.n_cells               = forging_case.billet.n_cells();
    summary.newton_iterations     = forged.newton;
    summary.krylov_iterations     = forged.krylov;
    summary.linear_solves_forward = forged.linear_solves;
    summary.remeshings            = forged.remeshed.size();
    summary.increments            = forged.increments;
    summary.cuts                  = forged.cuts;
    summary.volume_initial        = volume(forging_case.billet.cells, forging_case.X_0);
    summary.volume_final          = volume(forged.epoch->scene.mesh.cells, forged.workpiece.X);
    summary.volume_repaired       = forged.removed_volume;
    summary.heat                  = summarise_heat(process,
                                  forged,
                                  summary.volume_final,
                                  forging_case.parameters.edge_length(forging_case.nominal_billet));
    summarise_restarts(forging_case.segments, summary);
  }

  namespace
  {
    /// Where the metal is strained or warm beyond its table of flow stresses; "" where it is not, or has none.
    std::string beyond_table(const Process<double> &process, const WorkpieceState<3, double> &workpiece)
    {
      const auto &table = process.material.table;
      if (!table)
        return "";
      const double strain  = *std::max_element(workpiece.strain.begin(), workpiece.strain.end());
      const auto  &T       = workpiece.temperature;
      const double before  = process.material.initial.temperature,
                   warmest = T.empty() ? before : *std::max_element(T.begin(), T.end()),
                   coldest = T.empty() ? before : *std::min_element(T.begin(), T.end());
      // Where the run begins outside of the table, a warning before it tells so.
      const bool cools = coldest < std::min(before, table->least_temperature());
      if (strain <= table->largest_strain() && warmest <= table->largest_temperature() && !cools)
        return "";
      return "the metal was strained up to " + as_text(strain) + " and is at " + as_text(coldest) + " to " +
             as_text(warmest) + " C, and Material/table ends at " + as_text(table->largest_strain()) +
             " and at " + as_text(table->least_temperature()) + " and " +
             as_text(table->largest_temperature()) + " C: beyond, stresses are those at its edge.";
    }

    /// Part of the metal at temperatures where the numbers of its law do not hold.
    double part_beyond(const std::vector<double> &valid, const ForgingState &state)
    {
      const WorkpieceState<3, double> &workpiece = state.workpiece;
      double                           beyond = 0., whole = 0.;
      for (const auto &cell : state.epoch->scene.mesh.cells)
      {
        const double part = tet_volume(corners(cell, workpiece.X)) / double(cell.size());
        for (const NodeIndex k : cell)
        {
          whole += part;
          beyond += is_beyond(valid, workpiece.temperature[k]) ? part : 0.;
        }
      }
      return beyond / whole;
    }
  } // namespace

  std::vector<std::string>
  beyond_law(const Case &forging_case, const Process<double> &process, const ForgingState &state)
  {
    std::vector<std::string> warnings;
    if (const std::string beyond = beyond_table(process, state.workpiece); !beyond.empty())
      warnings.push_back(beyond);
    constexpr double           much  = 0.05;
    const std::vector<double> &valid = forging_case.parameters.material.valid_temperatures,
                              &T     = state.workpiece.temperature;
    // Where all of it begins beyond, a warning before the run tells so.
    if (valid.empty() || T.empty() || is_beyond(valid, process.material.initial.temperature))
      return warnings;
    if (const double part = part_beyond(valid, state); part > much)
    {
      const auto [coldest, warmest] = std::minmax_element(T.begin(), T.end());
      warnings.push_back("the metal ends at " + as_text(*coldest) + " to " + as_text(*warmest) + " C, " +
                         as_text(100. * part) + " % of it where the law's numbers do not hold: from " +
                         as_text(valid[0]) + " to " + as_text(valid[1]) +
                         " C (Material/valid temperatures).");
    }
    return warnings;
  }

  Summary::Depth
  depth_in_dies(const Case &forging_case, const Process<double> &process, const ForgingState &state)
  {
    const Scene            &scene   = state.epoch->scene;
    const std::vector<Die> &dies    = forging_case.model.dies;
    const Penetration       deepest = deepest_point(scene.mesh,
                                              scene.topology,
                                              dies,
                                              process.at_stroke(state.stroke, state.operation).dies,
                                              state.workpiece.X,
                                              forging_case.comm);
    return {deepest.depth,
            deepest.depth / forging_case.edge_length(),
            state.stroke,
            {{deepest.place[0], deepest.place[1], deepest.place[2]}},
            deepest.die == invalid_index ? "" : dies[deepest.die].name};
  }

  std::vector<std::string> warnings_at_end(const Case &forging_case, const ForwardRun &run)
  {
    const ForgingState &state = run.state();
    Summary             summary;
    summary.volume_initial = volume(forging_case.billet.cells, run.X_0());
    summary.volume_final   = volume(state.epoch->scene.mesh.cells, state.workpiece.X);
    summary.deepest        = depth_in_dies(forging_case, run.process(), state);
    std::vector<std::string> warnings =
      warnings_of(summary, forging_case.parameters.contact.largest_depth, {});
    for (const std::string &beyond : beyond_law(forging_case, run.process(), state))
      warnings.push_back(beyond);
    return warnings;
  }

  std::vector<std::optional<ValueSpan>> spans_of(const Objectives                      &objectives,
                                                 const ObjectiveTrace                  &trace,
                                                 const std::vector<IncrementDecisions> &run)
  {
    std::vector<std::optional<ValueSpan>> spans;
    for (std::size_t o = 0; o < objectives.size(); ++o)
    {
      const auto &path = objectives[o].path;
      if (path && path->is_of_forces())
        spans.push_back(span_of(shares_of_increments(*path, trace.recorded().rows[o]), run));
      else
        spans.push_back({});
    }
    return spans;
  }

  void judge_slopes(const Combination                           &combination,
                    const std::vector<std::optional<ValueSpan>> &spans,
                    const std::vector<IncrementDecisions>       &run,
                    const Design                                &design,
                    const std::vector<double>                   &mu,
                    ObjectiveSensitivity                        &sensitivity)
  {
    constexpr double percent = 0.01;
    const auto       effect  = [&](const std::size_t j) {
      return percent * design.parameters()[j].scale * sensitivity.gradient[j];
    };
    const unsigned int remeshed = std::count_if(
      run.begin(), run.end(), [&](const IncrementDecisions &at) { return at.remeshed && at.begin > 0.; });
    if (sensitivity.unit == "C" || sensitivity.unit == "K")
    {
      for (std::size_t j = 0; j < mu.size(); ++j)
        sensitivity.trust.push_back(trust_in_slope_of_temperature(remeshed, effect(j)));
      return;
    }
    // Of a sum, what made of the fewest increments and remeshed most often counts.
    ValueSpan worst;
    worst.part = 1.;
    for (std::size_t o = 0; o < spans.size(); ++o)
      if (combination.weights[o] != 0.)
      {
        if (!spans[o])
        {
          sensitivity.trust.assign(mu.size(), trust_in_slope_of_final_state(remeshed));
          return;
        }
        worst.part     = std::min(worst.part, spans[o]->part);
        worst.remeshed = std::max(worst.remeshed, spans[o]->remeshed);
        worst.in_die   = worst.in_die || spans[o]->in_die;
      }
    constexpr double rounding = 1e-6;
    const double     value    = sensitivity.value;
    for (std::size_t j = 0; j < mu.size(); ++j)
      sensitivity.trust.push_back(
        trust_in_slope(worst,
                       effect(j) / value,
                       std::abs(sensitivity.gradient[j] * mu[j] - value) <= rounding * std::abs(value)));
  }

  void summarise_objectives(const Case                                  &forging_case,
                            const ObjectiveTrace                        &trace,
                            const ForgingState                          &forged,
                            const std::vector<double>                   &values,
                            const std::vector<std::optional<ValueSpan>> &spans,
                            Summary                                     &summary)
  {
    const auto evaluations = trace.evaluate(forged);
    for (std::size_t o = 0; o < forging_case.objectives.size(); ++o)
    {
      summary.objectives.push_back(
        {forging_case.objectives[o].name,
         values[o],
         forging_case.objectives[o].unit(),
         evaluations[o].parts,
         evaluations[o].details,
         copies(forging_case, forging_case.objectives[o], summary.whole) * values[o]});
      if (spans[o])
        summary.objectives.back().note = note_on(*spans[o]);
    }
    if (forging_case.parameters.objectives.combined)
      summary.objectives.push_back({forging_case.combinations[0].name,
                                    forging_case.combine(values)[0],
                                    forging_case.combinations[0].unit,
                                    {},
                                    {}});
  }

  void summarise_gradients(const Case                              &forging_case,
                           const std::vector<ObjectiveSensitivity> &sensitivities,
                           Summary                                 &summary)
  {
    for (std::size_t j = 0; j < forging_case.mu.size() && !sensitivities.empty(); ++j)
    {
      const DesignParameter &parameter = forging_case.design.parameters()[j];
      summary.parameters.push_back({parameter.name, forging_case.mu[j], parameter.unit, {}, parameter.scale});
      for (const ObjectiveSensitivity &objective : sensitivities)
      {
        summary.parameters.back().gradient[objective.name] = objective.gradient[j];
        if (!objective.trust.empty() && !objective.trust[j].empty())
          summary.parameters.back().trust[objective.name] = objective.trust[j];
      }
    }
  }
} // namespace retroforge
