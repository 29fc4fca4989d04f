// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The laws of flow stress that parameter files name. Proved:
// - `power' and `Hansel-Spittel' give the stresses of their formulas, written again here, at several strains,
//   rates and temperatures; `table' those of its file at its knots;
// - between knots the table stays between the stresses around, its slopes are continuous at the knots, and
//   beyond its edge it is constant;
// - the reverse of each law, by every number, by strain and temperature, is its difference quotient;
// - numbers are given by name, with those of the law where none is given; a wrong name, a missing number, a
//   missing temperature, one in K, and files that are no table are refused with one message each.

#include <retroforge/core/error.h>
#include <retroforge/material/flow_stress_laws.h>
#include <retroforge/material/material_parameters.h>

#include "../element/element_test_tools.h"

#include <fstream>
#include <functional>
#include <iostream>

using namespace retroforge;

namespace
{
  constexpr double sqrt3 = 1.7320508075688772;

  const char *yes(const bool condition)
  {
    return condition ? "yes" : "NO";
  }

  /// Flow stress of a law at a rate, without e0.
  double stress(const MaterialLaw<double> &law, const double e)
  {
    return std::pow(sqrt3, law.m + 1.) * law.K * std::pow(e, law.m);
  }

  MaterialParameters power()
  {
    MaterialParameters p;
    p.type        = "power";
    p.law         = {40., 0.12, 1e-3};
    p.numbers     = {{"n", 0.21}, {"q0", 0.02}, {"beta", 0.003}, {"m1", 1e-4}, {"T0", 1000.}};
    p.temperature = "1050";
    return p;
  }

  MaterialParameters hansel_spittel()
  {
    MaterialParameters p;
    p.type        = "Hansel-Spittel";
    p.numbers     = {{"A", 1500.},
                     {"m1", -0.0025},
                     {"m2", 0.1},
                     {"m3", -0.04},
                     {"m4", -0.005},
                     {"m5", -3e-4},
                     {"m6", 0.01},
                     {"m7", -0.3},
                     {"m8", 1.7e-4},
                     {"m9", 0.05},
                     {"q0", 0.02}};
    p.temperature = "1100";
    return p;
  }

  double table_stress(const double q, const double e, const double T)
  {
    return 200. * (1. + std::sqrt(q)) * std::exp(-0.002 * T) * std::pow(e, 0.05 + 1e-4 * T);
  }

  MaterialParameters table()
  {
    std::ofstream out("curves.csv");
    out.precision(17);
    out << "temperature,strain,strain rate,flow stress\n";
    for (const double T : {900., 1000., 1200.})
      for (const double q : {0., 0.1, 0.3, 1.})
        for (const double e : {0.1, 1., 10.})
          out << T << ',' << q << ',' << e << ',' << table_stress(q, e, T) << '\n';
    MaterialParameters p;
    p.type        = "table";
    p.table       = "curves.csv";
    p.temperature = "1000";
    return p;
  }

  void check_formulas(Errors &errors)
  {
    const Material<double> steel = hansel_spittel().metal(1.), power_metal = power().metal(1.),
                           by_table = table().metal(1.);
    for (const double T : {950., 1000., 1180.})
      for (const double q : {0.1, 0.3, 1.})
        for (const double e : {0.2, 7.})
        {
          const double p     = std::hypot(q, 0.02);
          const double sigma = 1500. * std::exp(-0.0025 * T) * std::pow(T, 0.05) * std::pow(p, 0.1) *
                               std::exp(-0.005 / p) * std::pow(1. + p, -3e-4 * T + 0.01) *
                               std::exp(-0.3 * p) * std::pow(e, -0.04 + 1.7e-4 * T);
          errors.compare("Hansel-Spittel", stress(steel.at({q, T}), e) / sigma, 1.);
          const double m = 0.12 + 1e-4 * (T - 1000.);
          const double K = 40. * std::pow(q + 0.02, 0.21) * std::exp(-0.003 * (T - 1000.));
          errors.compare(
            "power", stress(power_metal.at({q, T}), e), std::pow(sqrt3, m + 1.) * K * std::pow(e, m));
        }
    for (const double T : {900., 1000., 1200.})
      for (const double q : {0., 0.1, 0.3, 1.})
        errors.compare("table at its knots", stress(by_table.at({q, T}), 3.), table_stress(q, 3., T));
  }

  void check_interpolation()
  {
    const Material<double> metal = table().metal(1.);
    const auto             at = [&](const double q, const double T) { return stress(metal.at({q, T}), 1.); };
    bool                   between = true;
    for (double q = 0.1; q < 0.3; q += 0.01)
      for (double T = 1000.; T < 1200.; T += 10.)
        between =
          between && at(q, T) >= at(0.1, 1200.) * (1. - 1e-12) && at(q, T) <= at(0.3, 1000.) * (1. + 1e-12);
    const double h        = 1e-7;
    const double before   = (at(0.3, 1050.) - at(0.3 - h, 1050.)) / h,
                 after    = (at(0.3 + h, 1050.) - at(0.3, 1050.)) / h;
    const double before_T = (at(0.2, 1000.) - at(0.2, 1000. - h)) / h,
                 after_T  = (at(0.2, 1000. + h) - at(0.2, 1000.)) / h;
    std::cout << "table: between knots stresses are between those around: " << yes(between)
              << "; slopes are continuous: "
              << yes(std::abs(after / before - 1.) < 1e-4 && std::abs(after_T / before_T - 1.) < 1e-4)
              << "; beyond the edge they are those at it: " << yes(at(2., 1300.) == at(1., 1200.)) << "\n";
  }

  /// The reverse of a law in closed form against that of dual numbers, which sorts have that bring none.
  void check_closed_form(const std::string &name, const Material<double> &metal, Errors &errors)
  {
    const MaterialType &type = material_type(metal.type);
    for (const PointState<double> &state : {PointState<double>{0.37, 1040.}, PointState<double>{0., 880.}})
    {
      const auto derivatives = [&](const auto &reverse) {
        Material<double> bar;
        bar.numbers.resize(metal.numbers.size(), 0.);
        PointState<double> state_bar;
        reverse({0.7, -3., 0.2}, bar, state_bar);
        std::vector<double> all;
        for_each_number([&](const double x) { all.push_back(x); }, bar.law);
        for_each_number([&](const double x) { all.push_back(x); }, bar.numbers);
        for_each_number([&](const double x) { all.push_back(x); }, state_bar);
        return all;
      };
      const auto closed = derivatives([&](const MaterialLaw<double> &law_bar, auto &bar, auto &state_bar) {
        type.reverse_law_at(metal, state, law_bar, bar, state_bar);
      });
      const auto dual   = derivatives([&](const MaterialLaw<double> &law_bar, auto &bar, auto &state_bar) {
        type.MaterialType::reverse_law_at(metal, state, law_bar, bar, state_bar);
      });
      for (std::size_t i = 0; i < closed.size(); ++i)
        errors.compare(name + ", closed form against dual numbers", closed[i], dual[i]);
    }
  }

  /// The reverse of a law by all numbers and the state, against central differences.
  void check_reverse(const std::string &name, const Material<double> &metal, Errors &errors)
  {
    const PointState<double>  state{0.37, 1040.};
    const MaterialLaw<double> weights{0.7, -3., 0.2};
    Material<double>          bar;
    PointState<double>        state_bar;
    reverse_at(metal, state, weights, bar, state_bar);
    const auto value = [&](const Material<double> &changed, const PointState<double> &at) {
      double                    sum = 0.;
      const MaterialLaw<double> law = changed.at(at);
      for_each_number([&](const double x, const double w) { sum += w * x; }, law, weights);
      return sum;
    };
    std::vector<double> by_reverse, by_difference;
    for_each_number([&](const double x) { by_reverse.push_back(x); }, bar.law);
    for_each_number([&](const double x) { by_reverse.push_back(x); }, bar.numbers);
    for_each_number([&](const double x) { by_reverse.push_back(x); }, state_bar);
    const auto differ = [&](double &x, const std::function<double()> &of) {
      const double at = x, h = 1e-5 * std::max(std::abs(at), 1e-3);
      x               = at + h;
      const double up = of();
      x               = at - h;
      by_difference.push_back((up - of()) / (2. * h));
      x = at;
    };
    Material<double>   changed = metal;
    PointState<double> there   = state;
    const auto         of      = [&]() { return value(changed, there); };
    for_each_number([&](double &x) { differ(x, of); }, changed.law);
    for_each_number([&](double &x) { differ(x, of); }, changed.numbers);
    for_each_number([&](double &x) { differ(x, of); }, there);
    for (std::size_t i = 0; i < by_reverse.size(); ++i)
      errors.compare(name,
                     by_reverse[i] / std::max(1e-3, std::abs(by_difference[i])),
                     by_difference[i] / std::max(1e-3, std::abs(by_difference[i])));
  }

  void refuse(const MaterialParameters &parameters)
  {
    try
    {
      parameters.metal(1.);
      std::cout << "NOT REFUSED\n";
    }
    catch (const Error &error)
    {
      std::cout << error.what() << "\n";
    }
  }

  void refuse_table(const std::string &rows,
                    const std::string &head = "strain,strain rate,temperature,flow stress")
  {
    std::ofstream("bad.csv") << head << '\n' << rows;
    MaterialParameters p = table();
    p.table              = "bad.csv";
    refuse(p);
  }

  void check_messages()
  {
    MaterialParameters p = power();
    p.numbers["bta"]     = 0.1;
    refuse(p);
    p             = power();
    p.temperature = "";
    refuse(p);
    p.numbers = {{"n", 0.2}};
    std::cout << "a power law of the strain alone needs no temperature: " << p.metal(1.).initial.temperature
              << " C\n";
    for (const char *T : {"-300", "warm", "2273"})
    {
      p.temperature = T;
      refuse(p);
    }
    p = hansel_spittel();
    p.numbers.erase("A");
    refuse(p);
    p.numbers["A"]  = 1500.;
    p.numbers["m8"] = -1e-3;
    refuse(p);
    p             = hansel_spittel();
    p.temperature = "0";
    refuse(p);
    p.type  = "Norton-Hoff";
    p.table = "curves.csv";
    p.numbers.clear();
    refuse(p);
    p       = table();
    p.table = "";
    refuse(p);
    refuse_table("0,1,20,100\n0,10,20,120\n0.5,1,20,130\n");
    refuse_table("0,1,20,100e6\n0,10,20,120e6\n");
    refuse_table("0,1,20,100\n0,10,20,90\n");
    refuse_table("0,1,20,100\n");
    refuse_table("0,1,20,100\n0,1,20,100\n");
    refuse_table("0,0,20,100\n");
    refuse_table("0,1,20,hard\n");
    refuse_table("-0.1,1,20,100\n");
    refuse_table("0,1,-280,100\n");
    refuse_table("0,1,20,100\n", "strain,rate,temperature,flow stress");
    refuse_table("");
  }
} // namespace

int main()
{
  Errors formulas;
  check_formulas(formulas);
  formulas.print(1e-12);
  check_interpolation();
  Errors reverse;
  check_reverse("power, reverse", power().metal(1.), reverse);
  check_reverse("Hansel-Spittel, reverse", hansel_spittel().metal(1.), reverse);
  check_reverse("table, reverse", table().metal(1.), reverse);
  reverse.print(1e-6);
  Errors closed;
  check_closed_form("power", power().metal(1.), closed);
  Material<double> soft        = power().metal(1.); // no stress before the first strain
  soft.numbers[PowerMetal::q0] = 0.;
  check_closed_form("power without q0", soft, closed);
  check_closed_form("Hansel-Spittel", hansel_spittel().metal(1.), closed);
  closed.print(1e-12);
  check_messages();
}
