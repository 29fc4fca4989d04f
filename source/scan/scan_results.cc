// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/csv.h>
#include <retroforge/core/version.h>
#include <retroforge/output/json_number.h>
#include <retroforge/output/safe_file.h>
#include <retroforge/scan/scan_results.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <iomanip>
#include <ostream>
#include <sstream>
#include <utility>

namespace retroforge
{
  namespace
  {
    using Json = nlohmann::ordered_json;

    Json as_json(const LineStatistics &s)
    {
      return {{"values", s.n_values},
              {"slopes", s.n_slopes},
              {"mean_value", json_number(s.mean_value)},
              {"noise_rms", json_number(s.noise_rms)},
              {"noise_max", json_number(s.noise_max)},
              {"mean_slope", json_number(s.mean_slope)},
              {"mean_fit_slope", json_number(s.mean_fit_slope)},
              {"bias", json_number(s.bias)},
              {"roughness_rms", json_number(s.roughness_rms)},
              {"roughness_max", json_number(s.roughness_max)}};
    }

    /// An empty cell for no number.
    void write_cell(std::ostream &out, const double x)
    {
      out << ',';
      if (std::isfinite(x))
        out << x;
    }

    void print_number(std::ostream &out, const int width, const double x)
    {
      out << std::setw(width);
      if (std::isfinite(x))
        out << x;
      else
        out << '-';
    }
  } // namespace

  ScanResults::ScanResults(std::vector<ScanLine> lines, const unsigned int degree)
      : lines_(std::move(lines)), degree_(degree)
  {
    for (const ScanLine &line : lines_)
    {
      objectives_.emplace_back();
      for (const ScanPoint &point : line.points)
        if (objectives_.back().empty())
          for (const auto &objective : point.objectives)
            objectives_.back().push_back({objective.name, objective.unit, {}, {}, {}});
      for (std::size_t o = 0; o < objectives_.back().size(); ++o)
      {
        LineObjective &judged = objectives_.back()[o];
        for (const ScanPoint &point : line.points)
        {
          const bool has_objectives = point.objectives.size() == objectives_.back().size();
          judged.line.x.push_back(point.value);
          judged.line.y.push_back(has_objectives ? point.objectives[o].value : NAN);
          judged.line.slopes.push_back(has_objectives ? point.objectives[o].slope : NAN);
        }
        judged.fit        = judged.line.fit(degree);
        judged.statistics = LineStatistics(judged.line, judged.fit);
      }
    }
  }

  unsigned int ScanResults::n_failed() const
  {
    unsigned int n = 0;
    for (const ScanLine &line : lines_)
      for (const ScanPoint &point : line.points)
        n += point.objectives.empty() ? 1 : 0;
    return n;
  }

  void ScanResults::write_csv(const std::string &file) const
  {
    const std::vector<LineObjective> *named = nullptr; // objectives are the same on all lines that have some
    for (const auto &of_line : objectives_)
      if (!of_line.empty())
        named = &of_line;
    std::ostringstream out;
    out << std::setprecision(17) << "parameter,value";
    if (named != nullptr)
      for (const LineObjective &judged : *named)
        out << ',' << judged.name << " [" << judged.unit << "]," << judged.name << ": gradient,"
            << judged.name << ": fit," << judged.name << ": slope of the fit";
    out << ",increments,failure\n";
    for (std::size_t l = 0; l < lines_.size(); ++l)
      for (std::size_t i = 0; i < lines_[l].points.size(); ++i)
      {
        const ScanPoint &point = lines_[l].points[i];
        out << csv_quoted(point.parameter) << ',' << point.value;
        for (std::size_t o = 0; named != nullptr && o < named->size(); ++o)
        {
          const LineObjective *judged = o < objectives_[l].size() ? &objectives_[l][o] : nullptr;
          write_cell(out, judged != nullptr ? judged->line.y[i] : NAN);
          write_cell(out, judged != nullptr ? judged->line.slopes[i] : NAN);
          write_cell(out, judged != nullptr && judged->fit ? judged->fit->value(point.value) : NAN);
          write_cell(out, judged != nullptr && judged->fit ? judged->fit->slope(point.value) : NAN);
        }
        write_cell(out, point.objectives.empty() ? NAN : double(point.increments));
        out << ',' << (point.failure.empty() ? "" : csv_quoted(point.failure)) << '\n';
      }
    write_file(file, out.str());
  }

  void ScanResults::write_json(const std::string &file) const
  {
    Json lines = Json::array(), failed = Json::array();
    for (std::size_t l = 0; l < lines_.size(); ++l)
    {
      const ScanLine &line       = lines_[l];
      Json            objectives = Json::array();
      for (const LineObjective &judged : objectives_[l])
      {
        Json objective = {{"name", judged.name}, {"unit", judged.unit}};
        objective.update(as_json(judged.statistics));
        objectives.push_back(objective);
      }
      lines.push_back({{"parameter", line.parameter},
                       {"unit", line.unit},
                       {"nominal", line.nominal},
                       {"from", line.points.front().value},
                       {"to", line.points.back().value},
                       {"points", line.points.size()},
                       {"objectives", objectives}});
      for (const ScanPoint &point : line.points)
        if (point.objectives.empty())
          failed.push_back({{"parameter", point.parameter},
                            {"value", point.value},
                            {"directory", point.directory},
                            {"reason", point.failure}});
    }
    const Json json = {{"schema", 1},
                       {"command", "scan"},
                       {"version", version},
                       {"commit", commit},
                       {"fit_degree", degree_},
                       {"scans", lines},
                       {"failed", failed}};
    write_file(file, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  }

  void ScanResults::print(std::ostream &out) const
  {
    for (std::size_t l = 0; l < lines_.size(); ++l)
    {
      const ScanLine &line = lines_[l];
      out << std::setprecision(6) << "\n  " << line.parameter << " from " << line.points.front().value
          << " to " << line.points.back().value << (line.unit.empty() ? "" : " " + line.unit)
          << ", fit of degree " << degree_ << "\n  " << std::left << std::setw(24) << "objective"
          << std::right << std::setw(14) << "mean" << std::setw(14) << "slope" << std::setw(13) << "noise"
          << std::setw(13) << "largest" << std::setw(13) << "bias" << std::setw(13) << "roughness"
          << std::setw(13) << "largest" << '\n';
      for (const LineObjective &judged : objectives_[l])
      {
        const LineStatistics &s = judged.statistics;
        out << "  " << std::left << std::setw(24) << judged.name << std::right << std::setprecision(7);
        print_number(out, 14, s.mean_value);
        print_number(out, 14, s.mean_fit_slope);
        out << std::setprecision(3);
        for (const double ratio : {s.noise_rms, s.noise_max, s.bias, s.roughness_rms, s.roughness_max})
        {
          print_number(out, 11, 100. * ratio);
          out << " %";
        }
        out << '\n';
      }
      const char *before = "  without the points that failed, at ";
      for (const ScanPoint &point : line.points)
        if (point.objectives.empty())
          out << std::exchange(before, ", ") << std::setprecision(9) << point.value;
      out << (*before == ',' ? "\n" : "") << std::setprecision(6);
    }
  }
} // namespace retroforge
