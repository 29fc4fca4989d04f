// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include "element_test_tools.h"

/// @file
/// The closed forms of an element, whose unknowns are `Values`, against forward automatic differentiation.
namespace retroforge
{
  template <template <typename> class Values>
  inline const unsigned int n_unknowns = sizeof(Values<double>) / sizeof(double);

  template <template <typename> class Values>
  using Unknowns = Sacado::Fad::SFad<double, sizeof(Values<double>) / sizeof(double)>;

  /// Positions of the corners, then K, m, e0.
  using Inputs = Sacado::Fad::SFad<double, 15>;

  /// Unknowns as independent variables.
  template <template <typename> class Values>
  Values<Unknowns<Values>> independent(Values<double> w)
  {
    Values<Unknowns<Values>> x;
    const auto               from = entries(w);
    const auto               to   = entries(x);
    for (unsigned int i = 0; i < from.size(); ++i)
      *to[i] = Unknowns<Values>(from.size(), i, *from[i]);
    return x;
  }

  template <typename Number, template <typename> class Values>
  Values<Number> constant_values(Values<double> w)
  {
    Values<Number> x;
    const auto     from = entries(w);
    const auto     to   = entries(x);
    for (unsigned int i = 0; i < from.size(); ++i)
      *to[i] = Number(*from[i]);
    return x;
  }

  template <typename Number>
  NortonHoff<Number> constant(const NortonHoff<double> &law)
  {
    return {Number(law.K), Number(law.m), Number(law.e0)};
  }

  template <typename Number>
  CellGeometry<Number> constant_geometry(const Four<Vec3> &X)
  {
    Four<Vector3<Number>> x;
    for (unsigned int a = 0; a < 4; ++a)
      for (unsigned int i = 0; i < 3; ++i)
        x[a][i] = Number(X[a][i]);
    return cell_geometry(x);
  }

  template <typename Number>
  std::vector<double> gradient(const Number &f)
  {
    std::vector<double> g(f.size());
    for (int i = 0; i < f.size(); ++i)
      g[i] = f.dx(i);
    return g;
  }

  template <template <typename> class Values>
  struct Case
  {
    Four<Vec3>         X;
    Values<double>     w, lambda;
    NortonHoff<double> law;

    CellGeometry<double> geometry() const { return cell_geometry(X); }

    CellGeometry<Inputs> independent_geometry() const
    {
      Four<Vector3<Inputs>> x;
      for (unsigned int a = 0; a < 4; ++a)
        for (unsigned int i = 0; i < 3; ++i)
          x[a][i] = Inputs(15, 3 * a + i, X[a][i]);
      return cell_geometry(x);
    }

    NortonHoff<Inputs> independent_law() const
    {
      return {Inputs(15, 12, law.K), Inputs(15, 13, law.m), Inputs(15, 14, law.e0)};
    }
  };

  template <template <typename> class Values>
  void check_residual(const Case<Values> &c, Errors &errors)
  {
    using Number = Unknowns<Values>;
    const Number functional =
      cell_functional(constant_geometry<Number>(c.X), independent(c.w), constant<Number>(c.law));
    errors.compare("residual", flatten(cell_residual(c.geometry(), c.w, c.law)), gradient(functional));
  }

  /// Second derivatives of the functional, row by row.
  template <template <typename> class Values>
  std::vector<double> hessian(const Case<Values> &c)
  {
    using Number = Unknowns<Values>;
    std::vector<double> H;
    for (const Number &r :
         flatten(cell_residual(constant_geometry<Number>(c.X), independent(c.w), constant<Number>(c.law))))
      for (unsigned int i = 0; i < n_unknowns<Values>; ++i)
        H.push_back(r.dx(i));
    return H;
  }

  inline void
  compare_inputs(const std::string &what, const CellSensitivity &s, const Inputs &reference, Errors &errors)
  {
    std::vector<double> X(12);
    for (unsigned int i = 0; i < 12; ++i)
      X[i] = reference.dx(i);
    errors.compare(what + " in X", flatten(s.X), X);
    errors.compare(what + " in K", s.law.K, reference.dx(12));
    errors.compare(what + " in m", s.law.m, reference.dx(13));
    errors.compare(what + " in e0", s.law.e0, reference.dx(14));
  }

  template <template <typename> class Values>
  void check_reverse_residual(const Case<Values> &c, Errors &errors)
  {
    const auto residual =
      flatten(cell_residual(c.independent_geometry(), constant_values<Inputs>(c.w), c.independent_law()));
    const std::vector<double> lambda = flatten(c.lambda);
    Inputs                    product(0.);
    for (unsigned int i = 0; i < n_unknowns<Values>; ++i)
      product += lambda[i] * residual[i];
    compare_inputs(
      "lambda·residual", reverse_cell_residual(c.geometry(), c.w, c.lambda, c.law), product, errors);
  }

  template <template <typename> class Values>
  void check_reverse_dissipation(const Case<Values> &c, Errors &errors)
  {
    using Number                 = Unknowns<Values>;
    const double          weight = -0.7;
    Values<double>        w_bar  = c.lambda;
    const CellSensitivity s      = reverse_cell_dissipation(c.geometry(), c.w, c.law, weight, w_bar);
    const Inputs          inputs =
      weight * cell_dissipation(c.independent_geometry(), constant_values<Inputs>(c.w), c.independent_law());
    compare_inputs("dissipation", s, inputs, errors);

    const Number unknowns =
      weight * cell_dissipation(constant_geometry<Number>(c.X), independent(c.w), constant<Number>(c.law));
    std::vector<double>       expected = gradient(unknowns);
    const std::vector<double> before   = flatten(c.lambda);
    for (unsigned int i = 0; i < n_unknowns<Values>; ++i)
      expected[i] += before[i];
    errors.compare("dissipation in the unknowns", flatten(w_bar), expected);
  }
} // namespace retroforge
