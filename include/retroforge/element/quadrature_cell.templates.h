// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/element/quadrature_cell.h>

#include <deal.II/base/numbers.h>

namespace retroforge
{
  /// Positions and unknowns at a point of a cell, or derivatives in them.
  template <int dim, typename Number>
  struct PointFlow
  {
    dealii::Tensor<2, dim, Number> J;                ///< dx/dxi [mm]
    dealii::Tensor<2, dim, Number> H;                ///< dv/dxi [mm/s]
    Number                         r   = Number(0.); ///< distance from the axis [mm]
    Number                         v_r = Number(0.); ///< velocity away from it [mm/s]
    Number                         p   = Number(0.); ///< [MPa]
  };

  /// Adds what positions contribute to the state at point q.
  template <int dim, typename Number>
  void add_positions(const ShapeTable<dim>          &shapes,
                     const unsigned int              q,
                     const CellVectors<dim, Number> &X,
                     PointFlow<dim, Number>         &state)
  {
    for (unsigned int c = 0; c < X.size(); ++c)
    {
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          state.J[i][j] += X[c][i] * shapes.gradient(q, c)[j];
      state.r += X[c][0] * shapes.value(q, c);
    }
  }

  /// And velocities of the first functions.
  template <int dim, typename Number>
  void add_velocities(const ShapeTable<dim>          &shapes,
                      const unsigned int              q,
                      const unsigned int              n_functions,
                      const CellVectors<dim, Number> &V,
                      PointFlow<dim, Number>         &state)
  {
    for (unsigned int a = 0; a < n_functions; ++a)
    {
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          state.H[i][j] += V[a][i] * shapes.gradient(q, a)[j];
      state.v_r += V[a][0] * shapes.value(q, a);
    }
  }

  template <int dim, typename Number>
  PointFlow<dim, Number> state_at(const QuadratureGeometry<dim, Number> &geometry,
                                  const QuadratureValues<dim, Number>   &w,
                                  const unsigned int                     q)
  {
    const ShapeTables<dim> &tables = geometry.element->at_points();
    AssertDimension(geometry.X.size(), geometry.element->n_positions());
    Assert(w.V.empty() || w.V.size() == geometry.element->n_velocities(),
           dealii::ExcDimensionMismatch(w.V.size(), geometry.element->n_velocities()));
    Assert(w.P.empty() || w.P.size() == geometry.element->n_pressures(),
           dealii::ExcDimensionMismatch(w.P.size(), geometry.element->n_pressures()));
    PointFlow<dim, Number> state;
    add_positions(tables.geometry, q, geometry.X, state);
    add_velocities(tables.velocity, q, w.V.size(), w.V, state);
    for (unsigned int b = 0; b < w.P.size(); ++b)
      state.p += w.P[b] * tables.pressure.value(q, b);
    return state;
  }

  /// The transpose of state_at in the unknowns.
  template <int dim, typename Number>
  void add_unknowns_pullback(const ReferenceElement<dim>   &element,
                             const unsigned int             q,
                             const PointFlow<dim, Number>  &state_bar,
                             QuadratureValues<dim, Number> &w_bar)
  {
    const ShapeTables<dim> &tables = element.at_points();
    AssertDimension(w_bar.V.size(), element.n_velocities());
    AssertDimension(w_bar.P.size(), element.n_pressures());
    for (unsigned int a = 0; a < w_bar.V.size(); ++a)
    {
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          w_bar.V[a][i] += state_bar.H[i][j] * tables.velocity.gradient(q, a)[j];
      w_bar.V[a][0] += state_bar.v_r * tables.velocity.value(q, a);
    }
    for (unsigned int b = 0; b < w_bar.P.size(); ++b)
      w_bar.P[b] += state_bar.p * tables.pressure.value(q, b);
  }

  /// The map from reference cell to space at a point.
  template <int dim, typename Number>
  struct PointMap
  {
    dealii::Tensor<2, dim, Number> inverse; ///< dxi/dx [1/mm]
    Number                         volume;  ///< of the surroundings, over the weight of the rule [mm^3]
    Number                         r;
    bool                           has_axis;

    PointMap(const PointFlow<dim, Number> &state, const Kinematics kinematics)
        : r(state.r), has_axis(kinematics == Kinematics::axisymmetric)
    {
      const auto &J = state.J;
      // Rows of the inverse are cross products of columns, over the determinant.
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
        {
          if constexpr (dim == 2)
            inverse[i][j] = (i == j ? 1. : -1.) * J[1 - j][1 - i];
          else
          {
            const unsigned int k = (j + 1) % 3, l = (j + 2) % 3, m = (i + 1) % 3, n = (i + 2) % 3;
            inverse[i][j] = J[k][m] * J[l][n] - J[l][m] * J[k][n];
          }
        }
      Number determinant(0.);
      for (unsigned int j = 0; j < dim; ++j)
        determinant += inverse[0][j] * J[j][0];
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          inverse[i][j] /= determinant;
      volume = determinant;
      if (has_axis)
        volume *= 2. * dealii::numbers::PI * r;
    }
  };

  /// eps = sym(H J^-1), v_r/r around the axis; there, where it is the axis, what it is across it.
  template <int dim, typename Number>
  Symmetric<Number>
  strain_rate(const PointMap<dim, Number> &map, const dealii::Tensor<2, dim, Number> &H, const Number &v_r)
  {
    dealii::Tensor<2, dim, Number> L;
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        for (unsigned int k = 0; k < dim; ++k)
          L[i][j] += H[i][k] * map.inverse[k][j];
    Symmetric<Number> eps;
    eps.fill(Number(0.));
    for (unsigned int i = 0; i < dim; ++i)
      eps[i] = L[i][i];
    eps[5] = 0.5 * (L[0][1] + L[1][0]);
    if constexpr (dim == 3)
    {
      eps[3] = 0.5 * (L[1][2] + L[2][1]);
      eps[4] = 0.5 * (L[0][2] + L[2][0]);
    }
    if (map.has_axis)
      eps[2] = value_of(map.r) != 0. ? Number(v_r / map.r) : L[0][0];
    return eps;
  }

  template <int dim, typename Number>
  Symmetric<Number> strain_rate(const PointMap<dim, Number> &map, const PointFlow<dim, Number> &state)
  {
    return strain_rate(map, state.H, state.v_r);
  }

  /// The transpose of strain_rate: adds to state_bar the derivatives in H and v_r of  S:eps.
  template <int dim, typename Number>
  void add_strain_rate_pullback(const PointMap<dim, Number> &map,
                                const Symmetric<Number>     &S,
                                PointFlow<dim, Number>      &state_bar)
  {
    constexpr unsigned int component[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int k = 0; k < dim; ++k)
        for (unsigned int j = 0; j < dim; ++j)
          state_bar.H[i][k] += S[component[i][j]] * map.inverse[k][j];
    if (map.has_axis)
      state_bar.v_r += S[2] / map.r;
  }

  /// Sum over the points of W_q f(map, state).
  template <int dim, typename Number, typename F>
  Number sum_over_points(const QuadratureGeometry<dim, Number> &geometry,
                         const QuadratureValues<dim, Number>   &w,
                         const F                               &f)
  {
    Number total(0.);
    for (unsigned int q = 0; q < geometry.element->n_points(); ++q)
    {
      const PointFlow<dim, Number> state = state_at(geometry, w, q);
      const PointMap<dim, Number>  map(state, geometry.element->kinematics());
      total += geometry.element->weight(q) * map.volume * f(map, state);
    }
    return total;
  }

  template <int dim, typename Number>
  Number cell_volume(const QuadratureGeometry<dim, Number> &geometry)
  {
    return sum_over_points(
      geometry, QuadratureValues<dim, Number>(), [](const auto &, const auto &) { return Number(1.); });
  }

  template <int dim, typename Number>
  Number cell_functional(const QuadratureGeometry<dim, Number> &geometry,
                         const QuadratureValues<dim, Number>   &w,
                         const MaterialLaw<Number>             &law)
  {
    return sum_over_points(geometry, w, [&](const auto &map, const auto &state) {
      const Symmetric<Number> eps  = strain_rate(map, state);
      const Number            eps2 = double_contraction(eps, eps);
      return Number(law(eps2) * law.potential_ratio(eps2) - state.p * trace(eps));
    });
  }

  /// s:eps
  template <typename Number>
  Number point_dissipation(const Symmetric<Number> &eps, const MaterialLaw<Number> &law)
  {
    const Number eps2 = double_contraction(eps, eps);
    return law(eps2) * eps2;
  }

  template <int dim, typename Number>
  Number cell_dissipation(const QuadratureGeometry<dim, Number> &geometry,
                          const QuadratureValues<dim, Number>   &w,
                          const MaterialLaw<Number>             &law)
  {
    return sum_over_points(geometry, w, [&](const auto &map, const auto &state) {
      return point_dissipation(strain_rate(map, state), law);
    });
  }

  template <int dim, typename Number>
  Number cell_strain_rate(const QuadratureGeometry<dim, Number> &geometry,
                          const QuadratureValues<dim, Number>   &w)
  {
    const Number integral = sum_over_points(
      geometry, w, [](const auto &map, const auto &state) { return equivalent(strain_rate(map, state)); });
    return integral / cell_volume(geometry);
  }

  /// factor * eps
  template <typename Number>
  Symmetric<Number> scaled(const Symmetric<Number> &eps, const Number &factor)
  {
    Symmetric<Number> s;
    for (unsigned int k = 0; k < 6; ++k)
      s[k] = factor * eps[k];
    return s;
  }

  /// s(eps) [MPa]
  template <typename Number>
  Symmetric<Number> point_stress(const Symmetric<Number> &eps, const MaterialLaw<Number> &law)
  {
    return scaled(eps, Number(law(double_contraction(eps, eps))));
  }

  template <int dim, typename Number>
  Symmetric<Number> cell_deviatoric_stress(const QuadratureGeometry<dim, Number> &geometry,
                                           const QuadratureValues<dim, Number>   &w,
                                           const MaterialLaw<Number>             &law)
  {
    const ReferenceElement<dim> &element = *geometry.element;
    const Number                 volume  = cell_volume(geometry);
    Symmetric<Number>            mean;
    mean.fill(Number(0.));
    for (unsigned int q = 0; q < element.n_points(); ++q)
    {
      const PointFlow<dim, Number> state = state_at(geometry, w, q);
      const PointMap<dim, Number>  map(state, element.kinematics());
      const Symmetric<Number>      eps = strain_rate(map, state);
      if (value_of(double_contraction(eps, eps)) == 0.) // the factor of a law without e0 is infinite there
        continue;
      const Symmetric<Number> s = point_stress(eps, law);
      for (unsigned int k = 0; k < 6; ++k)
        mean[k] += element.weight(q) * map.volume / volume * s[k];
    }
    remove_trace(mean);
    return mean;
  }

  template <int dim, typename Number>
  QuadratureValues<dim, Number> cell_residual(const QuadratureGeometry<dim, Number> &geometry,
                                              const QuadratureValues<dim, Number>   &w,
                                              const MaterialLaw<Number>             &law)
  {
    const ReferenceElement<dim>  &element = *geometry.element;
    QuadratureValues<dim, Number> r(element);
    for (unsigned int q = 0; q < element.n_points(); ++q)
    {
      const PointFlow<dim, Number> state = state_at(geometry, w, q);
      const PointMap<dim, Number>  map(state, element.kinematics());
      const Number                 weight = element.weight(q) * map.volume;
      const Symmetric<Number>      eps    = strain_rate(map, state);
      Symmetric<Number>            S      = point_stress(eps, law);
      for (unsigned int k = 0; k < 3; ++k)
        S[k] -= state.p;
      PointFlow<dim, Number> bar;
      add_strain_rate_pullback(map, scaled(S, weight), bar);
      bar.p = -weight * trace(eps);
      add_unknowns_pullback(element, q, bar, r);
    }
    return r;
  }
} // namespace retroforge
