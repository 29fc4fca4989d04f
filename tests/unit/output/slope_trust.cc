// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// What a run tells of its slopes, by hand. Ten increments of 1 mm, remeshed before increments 0, 3 and 8, of which
// the last was halved:
//   - an objective whose value is sum_i a_i dt_i from a stroke on has shares a_i dt_i over their sum there;
//   - a sum over all has the part 1 of the path, and two remeshings count: the one before the first increment is
//     that of the first mesh. One over the last three increments has 0.3, one remeshing and one cut within; over the
//     last two it begins on the new mesh, and no remeshing is within, but both count for it;
//   - a note is made where few increments make the value and a decision lies within, and not elsewhere;
//   - classes: nothing remeshed; once and twice, sum and few increments; less than remeshing scatters; exact; temperatures.

#include <retroforge/run/slope_trust.h>

#include <cstdio>

using namespace retroforge;

namespace
{
  class SumFrom : public PathObjectiveOf<SumFrom>
  {
  public:
    static constexpr unsigned int n_terms = 1;

    explicit SumFrom(const double begin) : begin_(begin) {}

    std::string name() const override { return "sum"; }
    std::string unit() const override { return "N"; }
    void        reverse_integrals(const EquilibriumView<double> &,
                                  const std::vector<double> &,
                                  EquilibriumBar &) const override
    {
    }

    template <typename Number>
    std::vector<Number> compute_integrals(const EquilibriumView<Number> &) const
    {
      return {Number(0.)};
    }
    template <typename Number>
    std::vector<Number> terms(const PathRow<Number> &row, double) const
    {
      return {row.stroke < begin_ ? Number(0.) : Number(row.integrals[0] * row.dt)};
    }
    template <typename Number>
    Number combine(const std::vector<Number> &sums, double) const
    {
      return sums[0];
    }

  private:
    double begin_;
  };

  std::vector<IncrementDecisions> run()
  {
    std::vector<IncrementDecisions> decisions;
    for (unsigned int i = 0; i < 10; ++i)
      decisions.push_back({double(i), i + 1., i == 0 || i == 3 || i == 8, i == 9 ? 1u : 0u});
    return decisions;
  }

  ValueSpan print(const char *what, const double begin)
  {
    PathRows<double> rows;
    for (unsigned int i = 0; i < 10; ++i)
      rows.push_back(recorded_row<double>({100.}, 0.1, 0.1 * i, i, 1.));
    const std::vector<double> shares = shares_of_increments(SumFrom(begin), rows);
    const ValueSpan           span   = span_of(shares, run());
    std::printf("%s: share of the last %.4f, from %.0f to %.0f mm, part %.2f, remeshings within %u, cuts %u, "
                "remeshed %u\n",
                what,
                shares.back(),
                span.begin,
                span.end,
                span.part,
                span.remeshings,
                span.cuts,
                span.remeshed);
    std::printf(
      "  note: [%s]\n  slope: [%s]\n", note_on(span).c_str(), trust_in_slope(span, 0.02, false).c_str());
    return span;
  }
} // namespace

int main()
{
  const ValueSpan all = print("all", 0.);
  print("last three", 7.);
  print("last two", 8.);
  ValueSpan none = all, once = all, few_once = all;
  none.remeshed = 0;
  once.remeshed = few_once.remeshed = 1;
  few_once.part                     = 0.2;
  std::printf("not remeshed: [%s], once: [%s], once, few: [%s]\n",
              trust_in_slope(none, 1e-5, false).c_str(),
              trust_in_slope(once, 0.0051, false).c_str(),
              trust_in_slope(few_once, 6e-3, false).c_str());
  std::printf("little: [%s], [%s], proportional: [%s]\n",
              trust_in_slope(once, 4e-4, false).c_str(),
              trust_in_slope(few_once, -0.0049, false).c_str(),
              trust_in_slope(few_once, 0.01, true).c_str());
  ValueSpan sunk = none;
  sunk.in_die    = true;
  std::printf("metal in a die: [%s], proportional: [%s]\n",
              trust_in_slope(sunk, 0.01, false).c_str(),
              trust_in_slope(sunk, 0.01, true).c_str());
  std::printf("temperatures: [%s], not remeshed: [%s], of more: [%s]\n",
              trust_in_slope_of_temperature(2, -2.9).c_str(),
              trust_in_slope_of_temperature(0, 0.1).c_str(),
              trust_in_slope_of_temperature(2, 3.1).c_str());
  std::printf("no increments: part %.0f\n", span_of({}, {}).part);
}
