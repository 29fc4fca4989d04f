// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/csv.h>
#include <retroforge/core/version.h>
#include <retroforge/optimization/optimization_results.h>
#include <retroforge/output/json_number.h>
#include <retroforge/output/safe_file.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace retroforge
{
  namespace
  {
    using Json = nlohmann::ordered_json;

    Json as_json(const OptimizationResults &results)
    {
      const Confidence &confidence = *results.confidence;
      Json              data = Json::array(), names = Json::array(), deviations = Json::array();
      for (const Datum &datum : results.criteria.data)
        data.push_back({{"objective", results.objectives[datum.objective]},
                        {"unit", results.units[datum.objective]},
                        {"measured", json_number(datum.value)},
                        {"deviation", json_number(datum.deviation)},
                        {"best", json_number(results.best.values[datum.objective])}});
      for (const unsigned int j : confidence.parameters)
        names.push_back(results.space.parameters()[j].name);
      for (const double deviation : confidence.deviations)
        deviations.push_back(json_number(deviation));
      return {{"data", data},
              {"misfit", json_number(confidence.misfit)},
              {"freedom", confidence.freedom},
              {"parameters", names},
              {"deviations", deviations},
              {"correlations", confidence.correlations},
              {"unseen", confidence.unseen},
              {"converged", results.has_converged()},
              {"disagrees", confidence.disagrees()}};
    }

    Json values_by_name(const std::vector<std::string> &names, const std::vector<double> &values)
    {
      Json json = Json::object();
      for (std::size_t i = 0; i < values.size(); ++i)
        json[names[i]] = json_number(values[i]);
      return json;
    }
  } // namespace

  std::string in_words(const DesignSpace::At at)
  {
    switch (at)
    {
      case DesignSpace::At::fixed:
        return "not varied";
      case DesignSpace::At::lower:
        return "at its lower bound";
      case DesignSpace::At::upper:
        return "at its upper bound";
      default:
        return "";
    }
  }

  std::string in_words(const SearchStop stop)
  {
    switch (stop)
    {
      case SearchStop::gradient:
        return "the gradient has vanished, but for what bounds and limits hold";
      case SearchStop::noise:
        return "no step promises more than the noise";
      case SearchStop::step:
        return "steps have become too short to matter";
      case SearchStop::gains:
        return "eight designs have gained less than Optimisation/least gain";
      case SearchStop::limits:
        return "limits are not met, and no design near by comes closer to them";
      case SearchStop::iterations:
        return "as many steps were tried as Optimisation/iterations allows";
      case SearchStop::simulations:
        return "as many designs were forged as Optimisation/simulations allows";
      default:
        return "it is not finished";
    }
  }

  std::string in_words(const TrialRow::Decision decision, const bool failed)
  {
    switch (decision)
    {
      case TrialRow::Decision::start:
        return "start";
      case TrialRow::Decision::noise:
        return failed ? "failed" : "noise";
      case TrialRow::Decision::accepted:
        return "accepted";
      case TrialRow::Decision::renewed:
        return "new mesh";
      default:
        return failed ? "failed" : "refused";
    }
  }

  double OptimizationResults::by_relaxing(const std::size_t limit) const
  {
    if (!has_converged() || !limits_are_kept())
      return NAN;
    const double multiplier = limit < multipliers.size() ? multipliers[limit] : 0.;
    if (multiplier == 0.)
      return is_within_noise(criteria.limits[limit]) ? NAN : 0.;
    return -multiplier / criteria.limits[limit].size;
  }

  bool OptimizationResults::is_within_noise(const Limit &limit) const
  {
    return noise_of(limit) > std::abs(limit.excess(best.values)) * limit.size;
  }

  double OptimizationResults::missed_by(const std::size_t limit) const
  {
    const Limit &of    = criteria.limits[limit];
    const double value = of.counted(best.values);
    if (of.excess(best.values) <= limit_tolerance)
      return 0.;
    return of.at_least ? of.bound - value : value - of.bound;
  }

  bool OptimizationResults::missed_only_by_noise() const
  {
    for (std::size_t i = 0; i < criteria.limits.size(); ++i)
      if (missed_by(i) > noise_of(criteria.limits[i]))
        return false;
    return !limits_are_kept();
  }

  Neighbours OptimizationResults::neighbours() const
  {
    constexpr double       near = 0.1; // of the scales
    constexpr unsigned int few  = 3;
    const auto             at   = std::find_if(
      rows.begin(), rows.end(), [&](const TrialRow &row) { return row.evaluation.mu == best.mu; });
    if (at == rows.end() || best.gradients.empty())
      return {};
    Neighbours                found{0, std::vector<double>(best.values.size(), 0.)};
    const std::vector<double> x = space.scaled(best.mu);
    for (const TrialRow &row : rows)
    {
      const Evaluation &other = row.evaluation;
      if (other.failed() || row.mesh != at->mesh || other.mu == best.mu)
        continue;
      const std::vector<double> y        = space.scaled(other.mu);
      double                    distance = 0.;
      for (std::size_t j = 0; j < x.size(); ++j)
        distance = std::max(distance, std::abs(y[j] - x[j]));
      if (distance > near)
        continue;
      const std::vector<double> predicted = predicted_values(best, other.mu);
      for (std::size_t o = 0; o < found.off.size(); ++o)
        found.off[o] += std::pow(other.values[o] - predicted[o], 2);
      ++found.n;
    }
    if (found.n < few)
      return {};
    for (double &off : found.off)
      off = std::sqrt(off / found.n);
    return found;
  }

  bool OptimizationResults::keeps_by_luck(const Limit &limit) const
  {
    constexpr double part = 5e-3, of_noise = 3.;
    const Neighbours near   = neighbours();
    const double     margin = -limit.excess(best.values) * limit.size;
    return near.n > 0 && limits_are_kept() && near.off[limit.objective] > margin &&
           near.off[limit.objective] > part * limit.size &&
           near.off[limit.objective] > of_noise * noise_of(limit);
  }

  bool OptimizationResults::misses_there(const Limit &limit) const
  {
    return confirmation && !confirmation->best.failed() &&
           limit.excess_of(confirmation->best.values[limit.objective]) > limit_tolerance;
  }

  bool OptimizationResults::misses_there() const
  {
    return std::any_of(criteria.limits.begin(), criteria.limits.end(), [&](const Limit &limit) {
      return misses_there(limit);
    });
  }

  double OptimizationResults::correction_there(const Limit &limit) const
  {
    const double kept  = std::max(limit_tolerance * limit.size, noise_of(limit));
    const double added = confirmation->best.values[limit.objective] - best.values[limit.objective];
    return added + (limit.at_least ? -kept : kept);
  }

  std::size_t OptimizationResults::n_failed_at_the_end() const
  {
    std::size_t n = 0;
    for (auto row = rows.rbegin(); row != rows.rend() && !row->becomes_the_next(); ++row)
      if (row->decision == TrialRow::Decision::refused)
      {
        if (!row->evaluation.failed())
          return 0;
        ++n;
      }
    return n;
  }

  bool OptimizationResults::ended_among_failures() const
  {
    return (stop == SearchStop::noise || stop == SearchStop::step || stop == SearchStop::gains) &&
           n_failed_at_the_end() > 0;
  }

  bool OptimizationResults::has_converged() const
  {
    return (stop == SearchStop::gradient || stop == SearchStop::noise || stop == SearchStop::step ||
            stop == SearchStop::gains) &&
           !ended_among_failures();
  }

  bool OptimizationResults::found_nothing() const
  {
    const auto was_forged = [](const TrialRow &row) {
      return (row.decision == TrialRow::Decision::accepted || row.decision == TrialRow::Decision::refused) &&
             !row.evaluation.failed();
    };
    return n_failed_at_the_end() > 0 && std::none_of(rows.begin(), rows.end(), was_forged);
  }

  double OptimizationResults::by_meshes() const
  {
    double sum = 0.;
    for (const NewMesh &mesh : meshes)
      sum += criteria.value(mesh.after) - criteria.value(mesh.before);
    return sum;
  }

  void OptimizationResults::write_csv(const std::string &file) const
  {
    std::ostringstream out;
    out << std::setprecision(17) << "trial,decision,merit,radius";
    for (std::size_t o = 0; o < objectives.size(); ++o)
      out << ',' << csv_quoted(objectives[o] + " [" + units[o] + "]");
    for (const DesignParameter &parameter : space.parameters())
      out << ',' << csv_quoted(parameter.name + " [" + parameter.unit + "]");
    out << ",mesh,increments,seconds,failure\n";
    for (std::size_t i = 0; i < rows.size(); ++i)
    {
      const TrialRow   &row        = rows[i];
      const Evaluation &evaluation = row.evaluation;
      out << i << ',' << in_words(row.decision, evaluation.failed()) << ',';
      if (std::isfinite(row.merit))
        out << row.merit;
      out << ',' << row.radius;
      for (std::size_t o = 0; o < objectives.size(); ++o)
      {
        out << ',';
        if (!evaluation.failed())
          out << evaluation.values[o];
      }
      for (const double x : evaluation.mu)
        out << ',' << x;
      out << ',' << row.mesh << ',' << evaluation.increments << ',' << evaluation.seconds << ','
          << (evaluation.failed() ? csv_quoted(evaluation.failure) : "") << '\n';
    }
    write_file(file, out.str());
  }

  void OptimizationResults::write_json(const std::string &file) const
  {
    Json                      parameters = Json::array(), limits = Json::array(), trials = Json::array();
    const std::vector<double> gradient =
      best.gradients.empty() ? std::vector<double>(space.size(), NAN) : [&] {
        const std::vector<double> slopes = criteria.slopes(best.values);
        std::vector<double>       sum(space.size(), 0.);
        for (std::size_t o = 0; o < best.gradients.size(); ++o)
          for (std::size_t j = 0; j < sum.size(); ++j)
            sum[j] += slopes[o] * best.gradients[o][j];
        return sum;
      }();
    for (std::size_t j = 0; j < space.size(); ++j)
      parameters.push_back({{"name", space.parameters()[j].name},
                            {"unit", space.parameters()[j].unit},
                            {"start", json_number(start.mu[j])},
                            {"best", json_number(best.mu[j])},
                            {"lower", json_number(space.lower()[j])},
                            {"upper", json_number(space.upper()[j])},
                            {"scale", json_number(space.scales()[j])},
                            {"at", in_words(space.at(best.mu, j))},
                            {"gradient", json_number(gradient[j])}});
    const Neighbours near = neighbours();
    for (std::size_t i = 0; i < criteria.limits.size(); ++i)
    {
      const Limit &limit = criteria.limits[i];
      limits.push_back({{"objective", objectives[limit.objective]},
                        {"kind", limit.at_least ? "at least" : "at most"},
                        {"bound", json_number(limit.bound)},
                        {"start", json_number(start.values[limit.objective])},
                        {"best", json_number(best.values[limit.objective])},
                        {"correction", json_number(limit.correction)},
                        {"noise", json_number(noise_of(limit))},
                        {"off_near_best", near.n > 0 ? json_number(near.off[limit.objective]) : Json()},
                        {"missed_by", json_number(missed_by(i))},
                        {"by_relaxing", json_number(by_relaxing(i))}});
    }
    Json relations = Json::array();
    for (std::size_t r = 0; r < space.relations().size(); ++r)
      relations.push_back(
        {{"relation", space.relations()[r].text},
         {"active", space.holds_as_equation(best.mu, r)},
         {"excess", json_number(space.relations()[r].excess(best.mu))},
         {"by_moving", r < by_moving_relation.size() ? json_number(by_moving_relation[r]) : Json()}});
    for (const TrialRow &row : rows)
      trials.push_back({{"decision", in_words(row.decision, row.evaluation.failed())},
                        {"merit", json_number(row.merit)},
                        {"radius", json_number(row.radius)},
                        {"mesh", row.mesh},
                        {"values", values_by_name(objectives, row.evaluation.values)},
                        {"failure", row.evaluation.failure},
                        {"increments", row.evaluation.increments},
                        {"seconds", row.evaluation.seconds}});
    Json made = Json::array();
    for (const NewMesh &mesh : meshes)
      made.push_back({{"trial", mesh.row},
                      {"meshed_at", mesh.made_at},
                      {"nodes", mesh.n_nodes},
                      {"quality_before", json_number(mesh.quality_before)},
                      {"quality", json_number(mesh.quality_after)},
                      {"volume_before", json_number(mesh.volume_before)},
                      {"volume", json_number(mesh.volume_after)},
                      {"objective_before", json_number(criteria.value(mesh.before))},
                      {"objective", json_number(criteria.value(mesh.after))},
                      {"values_before", values_by_name(objectives, mesh.before)},
                      {"values", values_by_name(objectives, mesh.after)}});
    Json json = {{"schema", 1},
                 {"command", "optimize"},
                 {"version", version},
                 {"commit", commit},
                 {"objective",
                  {{"name", criteria.objective.name},
                   {"unit", criteria.objective.unit},
                   {"start", json_number(value(start))},
                   {"best", json_number(value(best))},
                   {"noise", json_number(noise.objective)},
                   {"counted_as", counted_as}}},
                 {"limits", limits},
                 {"relations", relations},
                 {"parameters", parameters},
                 {"stop", in_words(stop)},
                 {"finished", stop != SearchStop::running && !goes_on},
                 {"converged", has_converged()},
                 {"limits_kept", limits_are_kept()},
                 {"simulations", n_simulations},
                 {"sweeps", n_sweeps},
                 {"failed", n_failed},
                 {"new_meshes", made},
                 {"trials", trials}};
    for (const auto &[name, of_design] : operations)
      json["operations"].push_back({{"name", name}, {"parameters", of_design}});
    if (const auto &held = space.held())
      json["follows"] = {{"name", held->name},
                         {"unit", held->unit},
                         {"start", json_number(start.values.back())},
                         {"best", json_number(best.values.back())},
                         {"lower", json_number(held->lower)},
                         {"upper", json_number(held->upper)}};
    for (std::size_t o = 0; o < details.size(); ++o)
      if (!details[o].empty())
        json["details"][objectives[o]] = details[o];
    if (!warnings.empty())
      json["warnings"] = warnings;
    if (confidence)
      json["identification"] = as_json(*this);
    if (confirmation)
      json["confirmation"] = {
        {"nodes", confirmation->n_nodes},
        {"increments", confirmation->best.increments},
        {"start", confirmation->start.failed() ? Json() : json_number(value(confirmation->start))},
        {"best", confirmation->best.failed() ? Json() : json_number(value(confirmation->best))},
        {"values_start", values_by_name(objectives, confirmation->start.values)},
        {"values", values_by_name(objectives, confirmation->best.values)},
        {"limits_kept", !misses_there() && !fails_there()},
        {"not_corrected", not_corrected},
        {"failure", confirmation->start.failure + confirmation->best.failure}};
    write_file(file, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  }
} // namespace retroforge
