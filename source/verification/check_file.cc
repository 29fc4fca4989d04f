// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/output/json_number.h>
#include <retroforge/output/safe_file.h>
#include <retroforge/verification/check_file.h>

#include <nlohmann/json.hpp>

namespace retroforge
{
  namespace
  {
    using Json = nlohmann::json;

    double as_number(const Json &json)
    {
      return json.is_null() ? NAN : json.get<double>();
    }

    Json numbers(const std::vector<double> &values)
    {
      Json json = Json::array();
      for (const double x : values)
        json.push_back(json_number<Json>(x));
      return json;
    }

    Json as_json(const CheckRow &row)
    {
      Json steps = Json::array();
      for (const DifferenceRow &d : row.steps)
        steps.push_back(
          numbers({d.step, d.replayed_central, d.replayed_forward, d.replayed_backward, d.free_central}));
      const DifferenceFit free = row.free_fit();
      return {{"objective", row.objective},
              {"parameter", row.parameter},
              {"unit", row.unit},
              {"adjoint", json_number<Json>(row.adjoint)},
              {"tangent", json_number<Json>(row.tangent)},
              {"steps", steps},
              {"taylor_orders", numbers(row.taylor_orders)},
              {"passed", row.passed},
              {"magnitude", json_number<Json>(row.magnitude)},
              {"least_difference", json_number<Json>(row.least_difference)},
              {"is_zero", row.is_zero},
              {"failed_by", row.failed_by},
              {"free", numbers({free.slope, free.uncertainty, free.jump})}};
    }

    CheckRow as_row(const Json &json)
    {
      CheckRow row{json.at("objective"),
                   json.at("parameter"),
                   json.at("unit"),
                   as_number(json.at("adjoint")),
                   as_number(json.at("tangent")),
                   {},
                   {},
                   json.at("passed"),
                   as_number(json.at("magnitude")),
                   as_number(json.at("least_difference")),
                   json.at("is_zero"),
                   json.value("failed_by", "")};
      for (const Json &d : json.at("steps"))
        row.steps.push_back({as_number(d.at(0)),
                             as_number(d.at(1)),
                             as_number(d.at(2)),
                             as_number(d.at(3)),
                             as_number(d.at(4))});
      for (const Json &order : json.at("taylor_orders"))
        row.taylor_orders.push_back(as_number(order));
      return row;
    }
  } // namespace

  void CheckFile::write(const std::string &file) const
  {
    Json all = Json::array();
    for (const CheckRow &row : rows)
      all.push_back(as_json(row));
    const Json json = {{"program", program},
                       {"parameters", parameters},
                       {"n_increments", n_increments},
                       {"stroke", json_number<Json>(stroke)},
                       {"rows", all}};
    write_file(file, json.dump(1) + "\n");
  }

  CheckFile CheckFile::read(const std::string &file)
  {
    try
    {
      const Json json = Json::parse(read_file(file));
      CheckFile  found{
        json.at("program"), json.at("parameters"), json.at("n_increments"), as_number(json.at("stroke")), {}};
      for (const Json &row : json.at("rows"))
        found.rows.push_back(as_row(row));
      return found;
    }
    catch (const Json::exception &)
    {
    }
    catch (const Error &)
    {
    }
    return {"", "", 0, 0., {}};
  }
} // namespace retroforge
