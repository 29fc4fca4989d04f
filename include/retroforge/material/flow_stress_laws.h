// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/material/material.h>

/// @file
/// Sorts of metal that harden and soften. Each gives at a strain q and a temperature T a power law of the
/// strain rate e [1/s],
///   sigma_0 = sqrt(3)^(m+1) K e^m  [MPa],
/// with K and m of its own, and leaves e0 to the law.
namespace retroforge
{
  /// Returns the K of a flow stress  sigma e^m.
  template <typename Number>
  Number consistency_of(const Number &sigma, const Number &m)
  {
    return sigma * power(Number(3.), Number(-0.5 * (m + 1.)));
  }

  /// K (q + q0)^n exp(-beta (T - T0)),  m + m1 (T - T0):  the sort `power`. In place of K and
  /// m of @cite Laroussi2003, Eq. (19).
  class PowerMetal : public MaterialTypeOf<PowerMetal>
  {
  public:
    static constexpr unsigned int n = 0, q0 = 1, beta = 2, m1 = 3, T0 = 4; ///< among Material::numbers

    std::vector<NumberInfo> info() const override;
    bool                    depends_on_temperature(const Material<double> &metal) const override
    {
      return metal.numbers[beta] != 0. || metal.numbers[m1] != 0.;
    }

    template <typename Number>
    MaterialLaw<Number> compute_law(const Material<Number> &metal, const PointState<Number> &state) const
    {
      using std::exp;
      const std::vector<Number> &x       = metal.numbers;
      const Number               warming = state.temperature - x[T0];
      MaterialLaw<Number>        law     = metal.law;
      law.K *= power(Number(state.strain + x[q0]), x[n]) * exp(-x[beta] * warming);
      law.m += x[m1] * warming;
      return law;
    }

    void reverse_law_at(const Material<double>    &metal,
                        const PointState<double>  &state,
                        const MaterialLaw<double> &law_bar,
                        Material<double>          &bar,
                        PointState<double>        &state_bar) const override;
  };

  /// A e^(m1 T) T^m9 q^m2 e^(m4/q) (1+q)^(m5 T + m6) e^(m7 q) e^(m3 + m8 T):  the sort `Hansel-Spittel`, with
  /// q -> sqrt(q^2 + q0^2), by which stresses are finite where metal begins to flow. @cite HenselSpittel1978
  class HanselSpittelMetal : public MaterialTypeOf<HanselSpittelMetal>
  {
  public:
    static constexpr unsigned int A = 0, q0 = 10; ///< among Material::numbers; m_i is number i

    std::vector<NumberInfo> info() const override;
    bool                    depends_on_temperature(const Material<double> &) const override { return true; }
    bool                    reads_consistency() const override { return false; }

    template <typename Number>
    MaterialLaw<Number> compute_law(const Material<Number> &metal, const PointState<Number> &state) const
    {
      using std::exp;
      using std::log;
      using std::sqrt;
      const std::vector<Number> &x     = metal.numbers;
      const Number              &T     = state.temperature;
      const Number               q     = sqrt(state.strain * state.strain + x[q0] * x[q0]);
      const Number               m     = x[3] + x[8] * T;
      const Number               sigma = x[A] * exp(x[1] * T + x[9] * log(T) + x[2] * log(q) + x[4] / q +
                                      (x[5] * T + x[6]) * log(1. + q) + x[7] * q);
      return {consistency_of(sigma, m), m, metal.law.e0};
    }

    void reverse_law_at(const Material<double>    &metal,
                        const PointState<double>  &state,
                        const MaterialLaw<double> &law_bar,
                        Material<double>          &bar,
                        PointState<double>        &state_bar) const override;
  };

  /// Stresses from a table, times a number:  the sort `table` (material/flow_table.h).
  class TableMetal : public MaterialTypeOf<TableMetal>
  {
  public:
    static constexpr unsigned int factor = 0; ///< among Material::numbers

    std::vector<NumberInfo> info() const override;
    bool                    depends_on_temperature(const Material<double> &metal) const override
    {
      return metal.table->least_temperature() < metal.table->largest_temperature();
    }
    bool reads_table() const override { return true; }
    bool reads_consistency() const override { return false; }

    template <typename Number>
    MaterialLaw<Number> compute_law(const Material<Number> &metal, const PointState<Number> &state) const
    {
      using std::exp;
      const auto [log_sigma, m] = metal.table->at(state.strain, state.temperature);
      return {consistency_of(Number(metal.numbers[factor] * exp(log_sigma)), m), m, metal.law.e0};
    }
  };
} // namespace retroforge
