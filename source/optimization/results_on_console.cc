// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/text.h>
#include <retroforge/optimization/design_text.h>
#include <retroforge/optimization/optimization_results.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <ostream>
#include <sstream>

namespace retroforge
{
  namespace
  {
    void print_confidence(const OptimizationResults &results, std::ostream &out)
    {
      const Confidence &confidence = *results.confidence;
      out << "\n  " << std::left << std::setw(28) << "data" << std::right << std::setw(14) << "measured"
          << std::setw(14) << "deviation" << std::setw(14) << "best" << '\n';
      for (const Datum &datum : results.criteria.data)
        out << "  " << std::left << std::setw(28) << results.objectives[datum.objective] << std::right
            << std::setw(14) << datum.value << std::setw(14) << datum.deviation << std::setw(14)
            << results.best.values[datum.objective] << ' ' << results.units[datum.objective] << '\n';
      out << "  sum of squares in deviations: " << std::setprecision(4) << confidence.misfit;
      if (confidence.freedom > 0)
        out << ", about " << confidence.freedom << " where model and deviations are right\n";
      else
        out << "; with no more data than parameters it says nothing of the model\n";
      if (!confidence.unseen.empty())
      {
        out << "  the data do not see this change of the parameters:";
        for (std::size_t a = 0; a < confidence.unseen.size(); ++a)
          out << (a == 0 ? " " : ", ") << results.space.parameters()[confidence.parameters[a]].name << ' '
              << std::showpos << confidence.unseen[a] * results.space.scales()[confidence.parameters[a]]
              << std::noshowpos;
        out << '\n';
        return;
      }
      if (!results.has_converged())
      {
        out
          << "  no intervals: the search has not come to an end by itself, and these are not the parameters "
             "that agree best\n";
        return;
      }
      if (confidence.disagrees())
        out << "  note: data and model do not agree within the deviations, and intervals are not to be "
               "trusted\n";
      for (std::size_t a = 0; a < confidence.deviations.size(); ++a)
      {
        const unsigned int j = confidence.parameters[a];
        out << "  " << results.space.parameters()[j].name << " = " << std::setprecision(6)
            << results.best.mu[j] << " +- " << std::setprecision(3)
            << Confidence::half_width_95 * confidence.deviations[a] << ' '
            << results.space.parameters()[j].unit << " (95 %)\n";
      }
      for (std::size_t a = 0; a < confidence.deviations.size(); ++a)
        for (std::size_t b = 0; b < a; ++b)
          out << "  correlation of " << results.space.parameters()[confidence.parameters[b]].name << " and "
              << results.space.parameters()[confidence.parameters[a]].name << ": " << std::setprecision(3)
              << confidence.correlations[a][b] << '\n';
    }
  } // namespace

  void OptimizationResults::print(const NewMesh &mesh, std::ostream &out) const
  {
    out << std::setprecision(3) << "  mesh made anew, of " << mesh.n_nodes << " nodes: worst cell "
        << mesh.quality_before << " -> " << mesh.quality_after << ", volume " << std::setprecision(6)
        << mesh.volume_before << " -> " << mesh.volume_after << " mm^3, " << criteria.objective.name << ' '
        << std::setprecision(7) << criteria.value(mesh.before) << " -> " << criteria.value(mesh.after)
        << (criteria.objective.unit.empty() ? "" : " ") << criteria.objective.unit << std::endl;
  }

  void OptimizationResults::print_warning(std::ostream &out) const
  {
    if (!limits_are_kept())
      out << "\n  NOT FEASIBLE: no design that was forged keeps all limits; this one comes closest\n";
    else if (misses_there())
      out << "\n  NOT KEPT ON THE FINER MESH: the best design keeps its limits on the mesh of the search "
             "alone\n";
    if (fails_there())
      out << "\n  NOT FORGED ON THE FINER MESH: the best design cannot be trusted; there it fails:\n    "
          << confirmation->best.failure << '\n';
    for (std::size_t i = 0; i < criteria.limits.size(); ++i)
      if (const double missed = missed_by(i); missed > 0.)
      {
        const Limit      &limit = criteria.limits[i];
        const std::string unit  = after_number(units[limit.objective]);
        out << std::setprecision(7) << "    " << objectives[limit.objective] << ": "
            << best.values[limit.objective] << unit;
        if (limit.correction != 0.)
          out << std::showpos << ' ' << limit.correction << std::noshowpos << unit << " for the finer mesh";
        out << ", " << (limit.at_least ? "at least " : "at most ") << limit.bound << unit << ": "
            << std::setprecision(4) << missed << unit;
        if (limit.bound != 0.)
          out << std::setprecision(3) << " (" << 100. * missed / std::abs(limit.bound) << " %)";
        out << (limit.at_least ? " too little\n" : " too much\n");
      }
    if (found_nothing())
      out << "\n  NOTHING FOUND: no design around the start could be forged, " << n_failed_at_the_end()
          << " tried; the last one failed:\n    " << rows.back().evaluation.failure << '\n';
  }

  void OptimizationResults::print_limits(std::ostream &out) const
  {
    if (!criteria.limits.empty())
      out << "\n  " << std::left << std::setw(28) << "limit" << std::right << std::setw(14) << "bound"
          << std::setw(14) << "start" << std::setw(14) << "best"
          << "  objective by relaxing it by 1\n";
    for (std::size_t i = 0; i < criteria.limits.size(); ++i)
    {
      const Limit &limit = criteria.limits[i];
      out << "  " << std::left << std::setw(28)
          << objectives[limit.objective] + (limit.at_least ? " at least" : " at most") << std::right
          << std::setprecision(7) << std::setw(14) << limit.bound << std::setw(14)
          << start.values[limit.objective] << std::setw(14) << best.values[limit.objective] << "  "
          << (missed_by(i) > 0.            ? "not kept"
              : !limits_are_kept()         ? "unknown, as another limit is not kept"
              : !has_converged()           ? "unknown, as the search did not come to its end"
              : by_relaxing(i) == 0.       ? "not felt"
              : std::isnan(by_relaxing(i)) ? "unknown, as it is nearer than its noise"
                                           : as_text(by_relaxing(i)))
          << '\n';
    }
    for (const Limit &limit : criteria.limits)
      if (limit.correction != 0.)
        out << "  " << objectives[limit.objective] << " counts with " << std::setprecision(4) << std::showpos
            << limit.correction << std::noshowpos << after_number(units[limit.objective])
            << ", which a finer mesh and the noise add to it\n";
    for (const Limit &limit : criteria.limits)
      if (is_within_noise(limit))
        out << "  noise of " << objectives[limit.objective] << ": " << std::setprecision(3) << noise_of(limit)
            << after_number(units[limit.objective]) << "; the best design is nearer to the limit than that\n";
    for (const Limit &limit : criteria.limits)
      if (keeps_by_luck(limit))
      {
        const Neighbours near = neighbours();
        out << "  " << near.n << " designs near the best one are " << std::setprecision(3)
            << near.off[limit.objective] << after_number(units[limit.objective])
            << " beside what its slopes of " << objectives[limit.objective]
            << " foretell, more than it keeps the limit by: it may keep it by luck\n";
      }
    out << std::setprecision(7);
  }

  void OptimizationResults::print(std::ostream &out) const
  {
    const std::string unit = criteria.objective.unit.empty() ? "" : " " + criteria.objective.unit;
    print_warning(out);
    out << std::setprecision(7) << "\n  " << criteria.objective.name << ": " << value(start) << unit << " -> "
        << value(best) << unit;
    if (value(start) != 0.)
      out << std::setprecision(4) << " (" << std::showpos << 100. * (value(best) / value(start) - 1.)
          << std::noshowpos << " %)";
    if (!counted_as.empty())
      out << "\n  all values are " << counted_as;
    if (!meshes.empty())
      out << std::setprecision(3)
          << "\n  start and best are forged on meshes of their own: the mesh was made anew "
          << (meshes.size() == 1 ? "once" : std::to_string(meshes.size()) + " times")
          << ", which\n  changed the objective by " << std::showpos << by_meshes() << std::noshowpos << unit
          << (meshes.size() == 1 ? "" : " in all") << "; the rest is by the design";
    out << "\n  stopped: " << in_words(stop);
    if (ended_among_failures())
      out << "; the last " << n_failed_at_the_end() << " failed: it is at the edge of what can be forged";
    out << "\n  " << n_simulations << " forgings; " << n_failed << " of " << rows.size()
        << " designs failed; " << n_sweeps << " swept back\n";
    if (noise.objective > 0.)
      out << std::setprecision(3) << "  noise of the objective: " << noise.objective << unit << '\n';
    out << "\n  " << std::left << std::setw(28) << "parameter" << std::right << std::setw(14) << "start"
        << std::setw(14) << "best" << '\n';
    for (std::size_t j = 0; j < space.size(); ++j)
      out << "  " << std::left << std::setw(28) << space.parameters()[j].name << std::right
          << std::setprecision(7) << std::setw(14) << start.mu[j] << std::setw(14) << best.mu[j] << ' '
          << std::left << std::setw(8) << space.parameters()[j].unit << std::right << ' '
          << in_words(space.at(best.mu, j)) << '\n';
    if (const auto &held = space.held())
      out << "  " << std::left << std::setw(28) << held->name << std::right << std::setprecision(7)
          << std::setw(14) << start.values.back() << std::setw(14) << best.values.back() << ' ' << std::left
          << std::setw(8) << held->unit << std::right << " follows from the volume\n";
    print_limits(out);
    for (std::size_t o = 0; o < details.size(); ++o)
      for (const auto &[what, detail] : details[o])
        out << "  " << what << " of " << objectives[o] << " at the best design: " << detail << '\n';
    for (const std::string &warning : warnings)
      out << "  warning: the best design: " << warning << '\n';
    for (std::size_t r = 0; r < by_moving_relation.size(); ++r)
      out << (r == 0 ? "\n" : "") << "  " << space.relations()[r].text << ": "
          << (space.holds_as_equation(best.mu, r)
                ? "felt, objective by moving its bound by 1: " + as_text(by_moving_relation[r])
                : "not felt")
          << '\n';
    const auto accepted = std::find_if(rows.rbegin(), rows.rend(), [](const TrialRow &row) {
      return row.decision == TrialRow::Decision::accepted || row.decision == TrialRow::Decision::renewed;
    });
    if (stop != SearchStop::running && not_corrected.empty() && accepted != rows.rend() &&
        accepted->evaluation.mu != best.mu)
      out << "  the search ended at another design, of " << value(accepted->evaluation) << unit
          << (value(accepted->evaluation) < value(best) ? "; the one that keeps the limits best is shown\n"
                                                        : "; the least is shown\n");
    if (confidence)
      print_confidence(*this, out);
    if (confirmation)
    {
      const auto told = [&](const Evaluation &there) {
        if (there.failed()) // it has no values
          return "failed (" + there.failure + ")";
        std::ostringstream text;
        text << std::setprecision(7) << value(there) << unit;
        return text.str();
      };
      out << "\n  on a mesh of " << confirmation->n_nodes << " nodes";
      if (!fails_there())
        out << ", in " << confirmation->best.increments << " increments";
      out << ": " << told(confirmation->start) << " -> " << told(confirmation->best) << '\n';
      if (!confirmation->best.failed())
        for (const Limit &limit : criteria.limits)
          out << "    " << objectives[limit.objective] << ' ' << confirmation->best.values[limit.objective]
              << ", " << (limit.at_least ? "at least " : "at most ") << limit.bound
              << (misses_there(limit) ? ": not kept there\n" : ": kept\n");
      if (!not_corrected.empty())
        out << "    the search did not go on for that: " << not_corrected << '\n';
    }
  }
} // namespace retroforge
