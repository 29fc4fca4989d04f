// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/text.h>
#include <retroforge/output/console.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

namespace retroforge
{
  std::string note_on_load(const unsigned int n_ranks, const double load, const unsigned int n_cores)
  {
    if (n_ranks == 1 || n_ranks + load <= n_cores + 0.5)
      return "";
    return "  note: " + std::to_string(n_ranks) + " ranks share " + std::to_string(n_cores) +
           " cores with a load of " + as_text(load) +
           " and wait for each other: fewer ranks, or one, may be faster\n";
  }

  void print_part(const WholePart &whole)
  {
    if (std::isnan(whole.copies))
      std::printf(
        "  forces, energies and volumes are of the model: its symmetry planes bound no whole part\n");
    else if (!whole.is_model())
      std::printf("  the model is 1/%.6g of the part: forces, energies and volumes below are of the model\n",
                  whole.copies);
  }

  void print_head(const WholePart &whole)
  {
    print_part(whole);
    std::printf("  inc   stroke      force        energy        volume   quality   depth newton krylov   "
                "time left\n");
    std::fflush(stdout);
  }

  void print_increment(const HistoryRow &row, const double seconds_left)
  {
    char left[32] = "-";
    if (!std::isnan(seconds_left))
      std::snprintf(left, sizeof left, "%.0f s", seconds_left);
    std::printf("%5u %8.4f %12.5g %13.7g %13.7g %8.4f %7.3f %6u %6u %10s\n",
                row.increment,
                row.stroke,
                row.force,
                row.energy,
                row.volume,
                row.min_quality,
                row.depth,
                row.newton,
                row.krylov,
                left);
    std::fflush(stdout);
  }

  void
  print_gradient(const ObjectiveSensitivity &objective, const Design &design, const std::vector<double> &mu)
  {
    std::vector<std::size_t> order(mu.size());
    std::iota(order.begin(), order.end(), 0);
    const std::string unit   = objective.unit == "none" ? "" : " " + objective.unit;
    const auto        effect = [&](const std::size_t j) {
      return 0.01 * design.parameters()[j].scale * objective.gradient[j];
    };
    std::stable_sort(order.begin(), order.end(), [&](const std::size_t a, const std::size_t b) {
      return std::abs(effect(a)) > std::abs(effect(b));
    });
    const bool tells_trust = std::any_of(objective.trust.begin(),
                                         objective.trust.end(),
                                         [](const std::string &words) { return !words.empty(); });
    std::printf("\n  gradient of %s = %.10g%s\n  %-24s %14s   %18s   for +1 %%%s\n",
                objective.name.c_str(),
                objective.value,
                unit.c_str(),
                "parameter",
                "value",
                "derivative",
                tells_trust ? "; how far it holds" : "");
    for (const std::size_t j : order)
    {
      const DesignParameter &parameter = design.parameters()[j];
      std::printf("  %-24s %14.8g   %18.12g   %+.4g%s",
                  parameter.name.c_str(),
                  mu[j],
                  objective.gradient[j],
                  effect(j),
                  unit.c_str());
      if (std::abs(parameter.scale - std::abs(mu[j])) > 1e-6 * parameter.scale) // of a length, or of 100 K
        std::printf(" (of %.4g %s)", parameter.scale, parameter.unit == "C" ? "K" : parameter.unit.c_str());
      const std::string words = tells_trust ? objective.trust[j] : "";
      std::printf("%s%s\n", words.empty() ? "" : "; ", words.c_str());
    }
  }

  namespace
  {
    /// "energy 20 mJ (deformation 15, friction 5); of the whole part 80 mJ"
    /// What heat did, and what of it was left out.
    void print_heat(const Summary::Heat &heat)
    {
      if (!std::isfinite(heat.warming))
        return;
      const char *work =
        heat.warms ? "the work warmed the metal by" : "heat is left out: the work would warm the metal by";
      std::printf("  %s %.3g K on the mean", work, heat.warming);
      if (std::isfinite(heat.mean_temperature))
        std::printf(", which ends at %.5g C", heat.mean_temperature);
      if (heat.conducts && heat.chilled == 0.)
        std::printf("; no heat went to dies");
      else if (heat.conducts)
        std::printf("; in %.3g s dies chilled a skin of %.2g mm, %.2g elements",
                    heat.seconds,
                    heat.chilled,
                    heat.elements);
      else
        std::printf("%s in %.3g s dies chill a skin of %.2g mm",
                    heat.warms ? "; left out:" : ", and",
                    heat.seconds,
                    heat.chilled);
      std::printf("\n");
    }

    void print_objective(const Summary::Objective &objective, const bool is_model)
    {
      const std::string unit = objective.unit == "none" ? "" : " " + objective.unit;
      std::printf("  %s %.12g%s", objective.name.c_str(), objective.value, unit.c_str());
      const char *separator = " (";
      for (const auto *numbers : {&objective.parts, &objective.details})
        for (const auto &[name, value] : *numbers)
        {
          std::printf("%s%s %.6g", separator, name.c_str(), value);
          separator = ", ";
        }
      std::printf("%s", *separator == ',' ? ")" : "");
      if (!is_model && std::isfinite(objective.whole))
        std::printf("; of the whole part %.12g%s", objective.whole, unit.c_str());
      std::printf("\n");
      if (!objective.note.empty())
        std::printf("    note: %s\n", objective.note.c_str());
    }
  } // namespace

  void print_results(const Summary &summary, const std::string &directory)
  {
    std::printf("\n");
    for (const Summary::Objective &objective : summary.objectives)
      print_objective(objective, summary.whole.is_model());
    if (summary.volume_repaired > 0.)
      std::printf(
        "  the surface crossed itself, or cells at it stayed flat, in places thinner than an element: "
        "%.3g mm^3 were taken away there, and put back elsewhere\n",
        summary.volume_repaired);
    print_heat(summary.heat);
    for (const std::string &warning : summary.warnings)
      std::printf("  warning: %s\n", warning.c_str());
    const auto total = summary.wall_seconds.find("total");
    std::printf("  volume change %.3g, %.1f s\n  results in %s\n",
                summary.volume_change(),
                total == summary.wall_seconds.end() ? 0. : total->second,
                directory.c_str());
  }
} // namespace retroforge
