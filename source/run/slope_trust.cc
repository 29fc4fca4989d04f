// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/text.h>
#include <retroforge/run/slope_trust.h>

#include <deal.II/base/exceptions.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  namespace
  {
    /// What remeshing scatters values by, from design to design, is felt in slopes of a smaller effect.
    constexpr double least_effect = 5e-3;

    /// The same in temperatures, whose zero means nothing [K].
    constexpr double least_warming = 3.;

    constexpr const char *little = "little beside remeshing's scatter: scan";

    /// The most that single slopes of a class of values were off, rms over nearby designs.
    const char *measured(const ValueSpan &span)
    {
      if (span.in_die)
        return "metal was in a die, see the warning: scan";
      if (span.remeshed > 1)
        return span.is_short() ? "off by up to 70 %: scan" : "within 15 %";
      return span.is_short() ? "within 20 %" : "within 5 %";
    }

    std::string counted(const unsigned int n, const std::string &what)
    {
      return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
    }
  } // namespace

  std::vector<double> shares_of_increments(const PathObjective &objective, const PathRows<double> &rows)
  {
    const PathRows<double> bar = objective.reverse_value(rows);
    AssertDimension(bar.size(), rows.size());
    std::vector<double> shares(rows.size(), 0.);
    double              sum = 0.;
    for (std::size_t i = 0; i < rows.size(); ++i)
    {
      for (std::size_t k = 0; k < rows[i].integrals.size(); ++k)
        shares[i] += std::abs(bar[i].integrals[k] * rows[i].integrals[k]);
      sum += shares[i];
    }
    for (double &share : shares)
      share = sum > 0. ? share / sum : 0.;
    return shares;
  }

  ValueSpan span_of(const std::vector<double> &shares, const std::vector<IncrementDecisions> &run)
  {
    AssertDimension(shares.size(), run.size());
    constexpr double least = 0.01;
    ValueSpan        span;
    if (shares.empty())
      return span;
    const double threshold = least * *std::max_element(shares.begin(), shares.end());
    std::size_t  first = run.size(), last = 0;
    double       path = 0., sum = 0., density = 0.;
    for (std::size_t i = 0; i < run.size(); ++i)
    {
      const double step = run[i].end - run[i].begin;
      path += step;
      sum += shares[i];
      density += shares[i] * shares[i] / step;
      if (shares[i] > 0. && shares[i] >= threshold)
      {
        first = std::min(first, i);
        last  = i;
      }
    }
    if (first > last)
      return span;
    span.begin = run[first].begin;
    span.end   = run[last].end;
    span.part  = sum * sum / (density * path);
    for (std::size_t i = 1; i <= last; ++i)
      span.remeshed += run[i].remeshed;
    for (std::size_t i = first; i <= last; ++i)
    {
      span.remeshings += i > first && run[i].remeshed;
      span.cuts += run[i].cuts > 0;
    }
    return span;
  }

  std::string note_on(const ValueSpan &span)
  {
    if (!span.is_short() || span.remeshings + span.cuts == 0)
      return "";
    std::string within = span.remeshings > 0 ? counted(span.remeshings, "remeshing") : "";
    if (span.cuts > 0)
      within += (within.empty() ? "" : " and ") + counted(span.cuts, "increment") + " cut short";
    return "it is made of the forces between the strokes " + as_text(span.begin) + " and " +
           as_text(span.end) + " mm, where " + within +
           (span.remeshings + span.cuts == 1 ? " lies" : " lie") +
           ": forces of single increments jump there from one design to the next. Do not trust a single "
           "slope of it: scan tells; a mean effort over more of the stroke, or the energy, holds better";
  }

  std::string trust_in_slope(const ValueSpan &span, const double effect, const bool is_proportional)
  {
    if (is_proportional)
      return "exact";
    return span.remeshed > 0 && std::abs(effect) < least_effect ? little : measured(span);
  }

  std::string trust_in_slope_of_final_state(const unsigned int remeshed)
  {
    return remeshed > 0 ? "not judged across " + counted(remeshed, "remeshing") + ": scan" : "";
  }

  std::string trust_in_slope_of_temperature(const unsigned int remeshed, const double effect)
  {
    return remeshed > 0 && std::abs(effect) < least_warming ? little : "";
  }
} // namespace retroforge
