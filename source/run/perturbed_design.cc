// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/run/perturbed_design.h>

#include <utility>

namespace retroforge
{
  namespace
  {
    double moved(const double x, const double shift)
    {
      return x + shift;
    }

    Dual moved(Dual x, const double direction)
    {
      x.fastAccessDx(0) += direction;
      return x;
    }

    template <typename Number>
    Vector3<Number> moved(const Vector3<Number> &x, const Vec3 &shift)
    {
      Vector3<Number> y;
      for (unsigned int i = 0; i < 3; ++i)
        y[i] = moved(x[i], shift[i]);
      return y;
    }
  } // namespace

  template <typename Number>
  Process<Number>
  process_at(const Case &forging_case, const std::vector<Number> &mu, const ShapePerturbation &shift)
  {
    Process<Number> process = forging_case.design.process(mu);
    for (std::size_t d = 0; d < shift.dies.size(); ++d)
    {
      if (shift.dies[d].empty())
        continue;
      NodalVectors<Number> vertices = std::move(process.dies[d].vertices);
      if (vertices.empty())
        for (const Vec3 &x : forging_case.model.dies[d].surface()->vertices())
          vertices.push_back(Vector3<Number>(x));
      for (std::size_t k = 0; k < vertices.size(); ++k)
        vertices[k] = moved(vertices[k], shift.dies[d][k]);
      process.dies[d].vertices = std::move(vertices);
    }
    return process;
  }

  template <typename Number>
  NodalVectors<Number>
  positions_at(const Case &forging_case, const std::vector<Number> &mu, const ShapePerturbation &shift)
  {
    NodalVectors<Number> X = forging_case.design.positions(mu);
    for (std::size_t k = 0; k < X.size(); ++k)
      X[k] = moved(X[k], shift.X_0[k]);
    return X;
  }

  std::vector<double> directional_derivatives(const Case                &forging_case,
                                              const ForwardRun          &run,
                                              const std::vector<double> &mu_dot,
                                              const ShapePerturbation   &shift_dot)
  {
    std::vector<Dual> mu;
    for (std::size_t j = 0; j < forging_case.mu.size(); ++j)
      mu.push_back(moved(Dual(forging_case.mu[j]), mu_dot[j]));
    std::vector<double> derivatives;
    for (const Dual &value : forging_case.combine(
           run.tangent(process_at(forging_case, mu, shift_dot), positions_at(forging_case, mu, shift_dot))))
      derivatives.push_back(value.dx(0));
    return derivatives;
  }

  template Process<double>
  process_at(const Case &forging_case, const std::vector<double> &mu, const ShapePerturbation &shift);
  template Process<Dual>
  process_at(const Case &forging_case, const std::vector<Dual> &mu, const ShapePerturbation &shift);
  template NodalVectors<double>
  positions_at(const Case &forging_case, const std::vector<double> &mu, const ShapePerturbation &shift);
  template NodalVectors<Dual>
  positions_at(const Case &forging_case, const std::vector<Dual> &mu, const ShapePerturbation &shift);
} // namespace retroforge
