// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/case/restart_rules.h>
#include <retroforge/core/version.h>
#include <retroforge/verification/check_file.h>
#include <retroforge/verification/check_messages.h>
#include <retroforge/verification/derivative_check.h>
#include <retroforge/verification/difference_evaluator.h>

#include <algorithm>
#include <iostream>
#include <utility>

namespace retroforge
{
  namespace
  {
    /// That makes a check's numbers.
    const std::string program = std::string(version) + " " + commit;

    Summary::Check as_summary(const CheckRow &row)
    {
      const char         *verdict = row.is_zero ? "zero" : row.passed ? "passed" : "failed";
      Summary::Check      check{row.objective,
                           row.parameter,
                           row.adjoint,
                           row.tangent,
                           {},
                           row.taylor_orders,
                           verdict,
                           row.failed_by};
      const DifferenceFit free = row.free_fit();
      check.free_slope         = free.slope;
      check.free_uncertainty   = free.uncertainty;
      check.free_jumps         = free.jump;
      check.is_doubtful        = row.is_doubtful();
      for (const DifferenceRow &d : row.steps)
        check.steps.push_back(
          {d.step, d.replayed_central, d.replayed_forward, d.replayed_backward, d.free_central});
      return check;
    }
    void summarise(const std::vector<CheckRow> &rows, const unsigned int remaining, Summary &summary)
    {
      summary.check.clear();
      for (const CheckRow &row : rows)
        summary.check.push_back(as_summary(row));
      summary.check_remaining = remaining;
    }
  } // namespace

  bool DerivativeCheck::verify()
  {
    const double                      begin = timings_.seconds("total");
    std::optional<unsigned int>       before; // directions that were done
    const DifferenceEvaluator         evaluator     = make_difference_evaluator(case_, run_);
    std::vector<ObjectiveSensitivity> sensitivities = sensitivities_;
    if (case_.command.resume)
    {
      // The record may be of a run that was solved less well than its replays are here.
      const auto values = evaluator.replayed(case_.mu, {NodalVectors<double>(case_.X_0.size()), {}});
      for (std::size_t j = 0; j < sensitivities.size(); ++j)
        sensitivities[j].value = values[j];
    }
    const auto rows = check_gradient(
      case_.parameters.check,
      case_.design,
      case_.mu,
      sensitivities,
      case_.size().side,
      evaluator,
      kept(),
      [&](const std::vector<CheckRow> &so_far, const unsigned int done, const unsigned int all) {
        keep(so_far, all - done);
        if (root_ && before)
          print_check_progress(so_far, *before, done, all, timings_.seconds("total") - begin);
        else if (root_)
        {
          print_check_begin(all, done, case_.parameters.check.n_runs(), forging_seconds_);
          if (case_.parameters.check.free && run_.follows_trend())
            print_follows_trend();
        }
        before = before.value_or(done);
      });
    if (root_)
      print(rows, std::cout);
    return std::all_of(rows.begin(), rows.end(), [](const CheckRow &row) { return row.passed; });
  }

  void DerivativeCheck::keep(const std::vector<CheckRow> &rows, const unsigned int remaining)
  {
    summarise(rows, remaining, summary_);
    write_summary();
    if (root_)
      CheckFile{program, case_.echo, run_.state().increments, run_.state().stroke, rows}.write(
        path_of("check.json"));
  }

  std::vector<CheckRow> DerivativeCheck::kept() const
  {
    if (!case_.command.resume)
      return {};
    CheckFile found = CheckFile::read(path_of("check.json"));
    MPI_Barrier(case_.comm); // all have read before it is written again
    const bool is_of_this = found.program == program && found.n_increments == run_.state().increments &&
                            found.stroke == run_.state().stroke &&
                            make_same_check(found.parameters, case_.echo);
    return is_of_this ? std::move(found.rows) : std::vector<CheckRow>();
  }
} // namespace retroforge
