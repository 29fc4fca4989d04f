// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/material/flow_stress_laws.h>

namespace retroforge
{
  namespace
  {
    /// A number of any sign that is 0 where it is not given.
    NumberInfo coefficient(const std::string &name, const std::string &unit)
    {
      NumberInfo number{name, unit};
      number.otherwise = 0.;
      number.any_sign  = true;
      return number;
    }

    NumberInfo
    positive(const std::string &name, const std::string &unit, const std::optional<double> otherwise)
    {
      NumberInfo number{name, unit};
      number.otherwise = otherwise;
      return number;
    }
  } // namespace

  std::vector<NumberInfo> PowerMetal::info() const
  {
    return {coefficient("n", ""),
            positive("q0", "", 1e-3),
            coefficient("beta", "1/C"),
            coefficient("m1", "1/C"),
            [] {
              NumberInfo T0 = coefficient("T0", "C");
              T0.otherwise  = 20.;
              return T0;
            }()};
  }

  void PowerMetal::reverse_law_at(const Material<double>    &metal,
                                  const PointState<double>  &state,
                                  const MaterialLaw<double> &law_bar,
                                  Material<double>          &bar,
                                  PointState<double>        &state_bar) const
  {
    const std::vector<double> &x       = metal.numbers;
    const double               warming = state.temperature - x[T0], base = state.strain + x[q0];
    const double               by_K   = power(base, x[n]) * std::exp(-x[beta] * warming);
    const double               of_log = law_bar.K * metal.law.K * by_K; // derivative in log(K)
    bar.law.K += law_bar.K * by_K;
    bar.law.m += law_bar.m;
    bar.law.e0 += law_bar.e0;
    bar.numbers[n] += of_log * log_or_zero(base);
    const double base_bar = base > 0. ? of_log * x[n] / base : 0.;
    state_bar.strain += base_bar;
    bar.numbers[q0] += base_bar;
    bar.numbers[beta] -= of_log * warming;
    bar.numbers[m1] += law_bar.m * warming;
    const double warming_bar = law_bar.m * x[m1] - of_log * x[beta];
    state_bar.temperature += warming_bar;
    bar.numbers[T0] -= warming_bar;
  }

  std::vector<NumberInfo> HanselSpittelMetal::info() const
  {
    return {positive("A", "MPa s^m", {}),
            coefficient("m1", "1/C"),
            coefficient("m2", ""),
            coefficient("m3", ""),
            coefficient("m4", ""),
            coefficient("m5", "1/C"),
            coefficient("m6", ""),
            coefficient("m7", ""),
            coefficient("m8", "1/C"),
            coefficient("m9", ""),
            positive("q0", "", 0.02)};
  }

  void HanselSpittelMetal::reverse_law_at(const Material<double>    &metal,
                                          const PointState<double>  &state,
                                          const MaterialLaw<double> &law_bar,
                                          Material<double>          &bar,
                                          PointState<double>        &state_bar) const
  {
    const std::vector<double> &x       = metal.numbers;
    std::vector<double>       &x_bar   = bar.numbers;
    const double               T       = state.temperature;
    const double               q       = std::sqrt(state.strain * state.strain + x[q0] * x[q0]);
    const double               log_1_q = std::log(1. + q);
    // Derivatives in log(sigma) and in m, which K has, too.
    const double of_log = law_bar.K * compute_law(metal, state).K;
    const double of_m   = law_bar.m - 0.5 * std::log(3.) * of_log;
    bar.law.e0 += law_bar.e0;
    x_bar[A] += of_log / x[A];
    x_bar[1] += of_log * T;
    x_bar[2] += of_log * std::log(q);
    x_bar[3] += of_m;
    x_bar[4] += of_log / q;
    x_bar[5] += of_log * T * log_1_q;
    x_bar[6] += of_log * log_1_q;
    x_bar[7] += of_log * q;
    x_bar[8] += of_m * T;
    x_bar[9] += of_log * std::log(T);
    state_bar.temperature += of_log * (x[1] + x[9] / T + x[5] * log_1_q) + of_m * x[8];
    const double q_bar = of_log * (x[2] / q - x[4] / (q * q) + (x[5] * T + x[6]) / (1. + q) + x[7]);
    state_bar.strain += q_bar * state.strain / q;
    x_bar[q0] += q_bar * x[q0] / q;
  }

  std::vector<NumberInfo> TableMetal::info() const
  {
    return {positive("factor", "", 1.)};
  }
} // namespace retroforge
