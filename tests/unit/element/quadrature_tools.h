// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include "element_test_tools.h"
#include <retroforge/core/numbers.h>
#include <retroforge/element/quadrature_cell.templates.h>

namespace retroforge
{
  /// What a kernel by quadrature is a function of, or anything dual to that, or a direction in it.
  template <int dim, typename Number>
  struct CellInput
  {
    CellVectors<dim, Number>      X;
    QuadratureValues<dim, Number> w;
    MaterialLaw<Number>           law;

    template <typename F>
    void visit(const F &f)
    {
      for (auto *vectors : {&X, &w.V})
        for (auto &v : *vectors)
          for (unsigned int i = 0; i < dim; ++i)
            f(v[i]);
      for (Number &p : w.P)
        f(p);
      for_each_number(f, law);
    }

    std::vector<Number> numbers() const
    {
      std::vector<Number> all;
      CellInput(*this).visit([&](const Number &x) { all.push_back(x); });
      return all;
    }
  };

  inline double dot(const std::vector<double> &a, const std::vector<double> &b)
  {
    AssertThrow(a.size() == b.size(), dealii::ExcInternalError());
    double sum = 0.;
    for (std::size_t i = 0; i < a.size(); ++i)
      sum += a[i] * b[i];
    return sum;
  }

  template <int dim>
  std::vector<double> flatten(const CellVectors<dim, double> &vectors)
  {
    std::vector<double> all;
    for (const auto &v : vectors)
      all.insert(all.end(), v.begin_raw(), v.end_raw());
    return all;
  }

  template <int dim, typename Number>
  std::vector<Number> flatten(const QuadratureValues<dim, Number> &w)
  {
    std::vector<Number> all;
    for (const auto &v : w.V)
      for (unsigned int i = 0; i < dim; ++i)
        all.push_back(v[i]);
    all.insert(all.end(), w.P.begin(), w.P.end());
    return all;
  }

  template <int dim>
  dealii::Tensor<1, dim> random_vector(RandomNumbers &random)
  {
    dealii::Tensor<1, dim> v;
    for (unsigned int i = 0; i < dim; ++i)
      v[i] = random.scalar();
    return v;
  }

  /// Vertices of a positively oriented simplex that is no sliver, away from the axis x = 0.
  template <int dim>
  CellVectors<dim, double> random_simplex(RandomNumbers &random)
  {
    CellVectors<dim, double> X(dim + 1);
    double                   volume;
    do
    {
      dealii::Tensor<2, dim> edges;
      for (auto &x : X)
        x = random_vector<dim>(random);
      for (unsigned int i = 0; i < dim; ++i)
        edges[i] = X[i + 1] - X[0];
      volume = determinant(edges);
    } while (volume < 0.8);
    for (auto &x : X)
      x[0] += 1.5;
    return X;
  }

  /// Positions of the nodes of a straight cell's geometry of degree 1 or 2.
  template <int dim>
  CellVectors<dim, double> straight(const ReferenceElement<dim> &element, CellVectors<dim, double> vertices)
  {
    constexpr unsigned int edges[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
    for (unsigned int e = 0; vertices.size() < element.n_positions(); ++e)
      vertices.push_back(0.5 * (vertices[edges[e][0]] + vertices[edges[e][1]]));
    return vertices;
  }
} // namespace retroforge
