// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/output/json_number.h>
#include <retroforge/output/safe_file.h>
#include <retroforge/output/summary.h>

#include <nlohmann/json.hpp>

#include <cmath>

namespace retroforge
{
  namespace
  {
    using Json = nlohmann::ordered_json; // keys stay in the order of the schema

    Json json_count(const Summary::Count &count)
    {
      return count ? Json(*count) : Json();
    }

    Json number_map(const std::map<std::string, double> &numbers)
    {
      Json json = Json::object();
      for (const auto &[name, x] : numbers)
        json[name] = json_number(x);
      return json;
    }

    void add_unless_empty(Json &json, const std::string &key, Json value)
    {
      if (!value.empty())
        json[key] = std::move(value);
    }

    Json as_json(const Summary::Check &check);
    Json as_json(const Summary::CheckStep &step);
    Json as_json(const Summary::Objective &objective);
    Json as_json(const Summary::Parameter &parameter);
    Json as_json(const Summary::Restart &restart);
    Json as_json(const double x)
    {
      return json_number(x);
    }

    template <typename T>
    Json list(const std::vector<T> &items)
    {
      Json json = Json::array();
      for (const T &item : items)
        json.push_back(as_json(item));
      return json;
    }

    Json as_json(const Summary::Objective &objective)
    {
      Json json = {
        {"name", objective.name}, {"value", json_number(objective.value)}, {"unit", objective.unit}};
      add_unless_empty(json, "parts", number_map(objective.parts));
      add_unless_empty(json, "details", number_map(objective.details));
      if (std::isfinite(objective.whole))
        json["whole"] = objective.whole;
      add_unless_empty(json, "note", objective.note.empty() ? Json() : Json(objective.note));
      return json;
    }

    Json as_json(const Summary::Parameter &parameter)
    {
      Json json = {{"name", parameter.name},
                   {"value", json_number(parameter.value)},
                   {"unit", parameter.unit},
                   {"scale", json_number(parameter.scale)}};
      add_unless_empty(json, "gradient", number_map(parameter.gradient));
      add_unless_empty(json, "trust", Json(parameter.trust));
      return json;
    }

    Json as_json(const Summary::Restart &restart)
    {
      Json changed = Json::object();
      for (const auto &[path, values] : restart.changed)
        changed[path] = {values.first, values.second};
      return {
        {"increment", restart.increment}, {"stroke", json_number(restart.stroke)}, {"changed", changed}};
    }

    Json as_json(const Summary::CheckStep &step)
    {
      return {{"step", json_number(step.step)},
              {"replayed_central", json_number(step.replayed_central)},
              {"replayed_forward", json_number(step.replayed_forward)},
              {"replayed_backward", json_number(step.replayed_backward)},
              {"free_central", json_number(step.free_central)}};
    }

    Json as_json(const Summary::Check &check)
    {
      Json json = {{"objective", check.objective},
                   {"parameter", check.parameter},
                   {"adjoint", json_number(check.adjoint)},
                   {"tangent", json_number(check.tangent)}};
      add_unless_empty(json, "steps", list(check.steps));
      add_unless_empty(json, "taylor_orders", list(check.taylor_orders));
      if (std::isfinite(check.free_slope))
        json["free"] = {{"slope", json_number(check.free_slope)},
                        {"uncertainty", json_number(check.free_uncertainty)},
                        {"jumps", json_number(check.free_jumps)},
                        {"doubtful", check.is_doubtful}};
      json["verdict"] = check.verdict;
      if (!check.failed_by.empty())
        json["failed_by"] = check.failed_by;
      return json;
    }
  } // namespace

  std::string Summary::to_json() const
  {
    Json json     = {{"schema", schema},
                     {"command", command},
                     {"version", version},
                     {"commit", commit},
                     {"ranks", json_count(ranks)},
                     {"blas", blas},
                     {"mesh", {{"nodes", json_count(n_nodes)}, {"cells", json_count(n_cells)}}}};
    json["whole"] = {{"copies", json_number(whole.copies)}, {"force_factor", json_number(whole.force)}};
    add_unless_empty(json, "objectives", list(objectives));
    add_unless_empty(json, "parameters", list(parameters));
    json["increments"]            = json_count(increments);
    json["cuts"]                  = json_count(cuts);
    json["remeshings"]            = json_count(remeshings);
    json["newton_iterations"]     = json_count(newton_iterations);
    json["krylov_iterations"]     = json_count(krylov_iterations);
    json["linear_solves_forward"] = json_count(linear_solves_forward);
    json["linear_solves_adjoint"] = json_count(linear_solves_adjoint);
    json["volume_initial"]        = json_number(volume_initial);
    json["volume_final"]          = json_number(volume_final);
    json["volume_repaired"]       = json_number(volume_repaired);
    json["volume_of_shape"]       = json_number(volume_of_shape);
    if (std::isfinite(balance.over_run))
      json["power_balance"] = {{"over_run", json_number(balance.over_run)},
                               {"95_percent_below", json_number(balance.most_below)},
                               {"largest", json_number(balance.largest)},
                               {"stroke", json_number(balance.stroke)}};
    if (std::isfinite(heat.warming))
    {
      json["heat"] = {{"warms", heat.warms},
                      {"conducts", heat.conducts},
                      {"mean_warming", json_number(heat.warming)},
                      {"seconds", json_number(heat.seconds)},
                      {"chilled_depth", json_number(heat.chilled)},
                      {"chilled_elements", json_number(heat.elements)}};
      if (std::isfinite(heat.mean_temperature))
        json["heat"]["mean_temperature"] = json_number(heat.mean_temperature);
      for (const Heat::Wait &wait : heat.waits)
        json["heat"]["waits"].push_back(
          {{"transfer", json_number(wait.transfer)}, {"dwell", json_number(wait.dwell)}});
    }
    if (!deepest.die.empty())
      json["deepest"] = {
        {"depth", json_number(deepest.depth)},
        {"over_element_size", json_number(deepest.relative)},
        {"die", deepest.die},
        {"stroke", json_number(deepest.stroke)},
        {"place",
         {json_number(deepest.place[0]), json_number(deepest.place[1]), json_number(deepest.place[2])}}};
    if (spanned.spanning > 0)
      json["edges_across_corners"] = {
        {"touching", spanned.touching},
        {"spanning", spanned.spanning},
        {"bulge_over_length", json_number(spanned.bulge)},
        {"die", spanned.die},
        {"stroke", json_number(spanned.stroke)},
        {"place",
         {json_number(spanned.place[0]), json_number(spanned.place[1]), json_number(spanned.place[2])}}};
    add_unless_empty(json, "restarts", list(restarts));
    add_unless_empty(json, "warnings", Json(warnings));
    add_unless_empty(json, "wall_seconds", number_map(wall_seconds));
    json["record_bytes"] = json_count(record_bytes);
    add_unless_empty(json, "check", list(check));
    if (check_remaining)
      json["check_remaining"] = *check_remaining;
    // names that are not UTF-8 get a replacement character: no reason to lose the results of a run
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  }

  void Summary::write(const std::string &file) const
  {
    write_file(file, to_json());
  }
} // namespace retroforge
