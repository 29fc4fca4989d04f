// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/version.h>
#include <retroforge/scan/scan_point.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>

namespace retroforge
{
  namespace
  {
    double number(const nlohmann::json &value)
    {
      return value.is_number() ? value.get<double>() : NAN;
    }

    /// d OBJECTIVE / d PARAMETER.
    double slope_of(const nlohmann::json &summary, const std::string &parameter, const std::string &objective)
    {
      if (summary.contains("parameters"))
        for (const auto &entry : summary["parameters"])
          if (entry.at("name") == parameter && entry.contains("gradient") &&
              entry["gradient"].contains(objective))
            return number(entry["gradient"][objective]);
      return NAN;
    }
  } // namespace

  bool ScanPoint::read_summary(const std::string &command)
  {
    objectives.clear();
    std::ifstream in(directory + "/summary.json");
    if (!in)
      return false;
    try
    {
      const auto summary = nlohmann::json::parse(in);
      if (summary.at("command") != command || summary.at("version") != version ||
          summary.at("commit") != commit)
        return false;
      increments = summary.at("increments");
      for (const auto &objective : summary.at("objectives"))
      {
        const std::string name = objective.at("name");
        objectives.push_back(
          {name, objective.at("unit"), number(objective.at("value")), slope_of(summary, parameter, name)});
      }
    }
    catch (const nlohmann::json::exception &)
    {
      objectives.clear();
    }
    return !objectives.empty();
  }

  void ScanPoint::read_failure(const std::string &log, const int status, const int signal)
  {
    const std::string prefix = "retroforge: ";
    std::ifstream     in(log);
    failure.clear();
    for (std::string line; std::getline(in, line);)
      if (line.rfind(prefix, 0) == 0)
        failure = legible(line.substr(prefix.size()));
    if (failure.empty())
      failure = signal != 0   ? "ended by signal " + std::to_string(signal)
                : status != 0 ? "ended with status " + std::to_string(status)
                              : "left no results";
  }
} // namespace retroforge
