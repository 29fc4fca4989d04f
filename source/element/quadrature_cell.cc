// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/numbers.h>
#include <retroforge/element/quadrature_cell.templates.h>

namespace retroforge
{
  namespace
  {
    constexpr unsigned int n_law_numbers = sizeof(MaterialLaw<double>) / sizeof(double);

    template <int dim>
    constexpr unsigned int n_state_numbers = sizeof(PointFlow<dim, double>) / sizeof(double);

    /// Carries the derivatives in a point's state, then in the numbers of the law.
    template <int dim>
    using PointDual = Sacado::Fad::SFad<double, n_state_numbers<dim> + n_law_numbers>;

    template <int dim, typename Number, typename F>
    void visit(PointFlow<dim, Number> &state, const F &f)
    {
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
        {
          f(state.J[i][j]);
          f(state.H[i][j]);
        }
      f(state.r);
      f(state.v_r);
      f(state.p);
    }

    template <int dim>
    PointFlow<dim, PointDual<dim>> independent(PointFlow<dim, double> state)
    {
      std::array<double, n_state_numbers<dim>> values;
      PointFlow<dim, PointDual<dim>>           x;
      unsigned int                             n = 0;
      visit(state, [&](const double &value) { values[n++] = value; });
      n = 0;
      visit(x, [&](PointDual<dim> &number) {
        number = PointDual<dim>(n_state_numbers<dim> + n_law_numbers, n, values[n]);
        ++n;
      });
      return x;
    }

    template <int dim>
    MaterialLaw<PointDual<dim>> independent_law(const MaterialLaw<double> &law)
    {
      MaterialLaw<PointDual<dim>> x;
      unsigned int                n = n_state_numbers<dim>;
      for_each_number(
        [&](PointDual<dim> &number, const double &value) {
          number = PointDual<dim>(n_state_numbers<dim> + n_law_numbers, n++, value);
        },
        x,
        law);
      return x;
    }

    template <int dim>
    void add_positions_pullback(const ReferenceElement<dim>  &element,
                                const unsigned int            q,
                                const PointFlow<dim, double> &state_bar,
                                CellVectors<dim, double>     &X_bar)
    {
      const ShapeTable<dim> &shapes = element.at_points().geometry;
      for (unsigned int c = 0; c < X_bar.size(); ++c)
      {
        X_bar[c] += state_bar.J * shapes.gradient(q, c);
        X_bar[c][0] += state_bar.r * shapes.value(q, c);
      }
    }

    /// Derivatives of  sum_q W_q f(map, state, law, q),  f of dual numbers.
    template <int dim, typename F>
    QuadratureSensitivity<dim> reverse_sum_over_points(const QuadratureGeometry<dim, double> &geometry,
                                                       const QuadratureValues<dim, double>   &w,
                                                       const MaterialLaw<double>             &law,
                                                       const F                               &f,
                                                       QuadratureValues<dim, double>         &w_bar)
    {
      const ReferenceElement<dim>      &element = *geometry.element;
      const MaterialLaw<PointDual<dim>> x_law   = independent_law<dim>(law);
      QuadratureSensitivity<dim>        bar{CellVectors<dim, double>(element.n_positions()), {}};
      for (unsigned int q = 0; q < element.n_points(); ++q)
      {
        const PointFlow<dim, PointDual<dim>> x = independent(state_at(geometry, w, q));
        const PointMap<dim, PointDual<dim>>  map(x, element.kinematics());
        const PointDual<dim>                 value = element.weight(q) * map.volume * f(map, x, x_law, q);
        PointFlow<dim, double>               state_bar;
        unsigned int                         n = 0;
        visit(state_bar, [&](double &number) { number = value.dx(n++); });
        for_each_number([&](double &number) { number += value.dx(n++); }, bar.law);
        add_positions_pullback(element, q, state_bar, bar.X);
        add_unknowns_pullback(element, q, state_bar, w_bar);
      }
      return bar;
    }
  } // namespace

  template <int dim>
  QuadratureSensitivity<dim> reverse_cell_residual(const QuadratureGeometry<dim, double> &geometry,
                                                   const QuadratureValues<dim, double>   &w,
                                                   const QuadratureValues<dim, double>   &lambda,
                                                   const MaterialLaw<double>             &law,
                                                   QuadratureValues<dim, double>         &w_bar)
  {
    const auto product =
      [&](const auto &map, const auto &state, const auto &x_law, const unsigned int q) -> PointDual<dim> {
      const PointFlow<dim, double>           of_lambda = state_at(geometry, lambda, q);
      dealii::Tensor<2, dim, PointDual<dim>> H;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          H[i][j] = of_lambda.H[i][j];
      const auto eps = strain_rate(map, state), eta = strain_rate(map, H, PointDual<dim>(of_lambda.v_r));
      return double_contraction(point_stress(eps, x_law), eta) - state.p * trace(eta) -
             of_lambda.p * trace(eps);
    };
    return reverse_sum_over_points(geometry, w, law, product, w_bar);
  }

  template <int dim>
  QuadratureSensitivity<dim> reverse_cell_residual(const QuadratureGeometry<dim, double> &geometry,
                                                   const QuadratureValues<dim, double>   &w,
                                                   const QuadratureValues<dim, double>   &lambda,
                                                   const MaterialLaw<double>             &law)
  {
    QuadratureValues<dim, double> w_bar(*geometry.element);
    return reverse_cell_residual(geometry, w, lambda, law, w_bar);
  }

  template <int dim>
  QuadratureSensitivity<dim> reverse_cell_dissipation(const QuadratureGeometry<dim, double> &geometry,
                                                      const QuadratureValues<dim, double>   &w,
                                                      const MaterialLaw<double>             &law,
                                                      const double                           weight,
                                                      QuadratureValues<dim, double>         &w_bar)
  {
    const auto dissipation =
      [&](const auto &map, const auto &state, const auto &x_law, unsigned int) -> PointDual<dim> {
      return weight * point_dissipation(strain_rate(map, state), x_law);
    };
    return reverse_sum_over_points(geometry, w, law, dissipation, w_bar);
  }

  // The mean's denominator moves, too:  d(sum W e / sum W) = sum d(W (e - mean)) / sum W  at a fixed mean.
  template <int dim>
  void reverse_cell_strain_rate(const QuadratureGeometry<dim, double> &geometry,
                                const QuadratureValues<dim, double>   &w,
                                const double                           weight,
                                QuadratureValues<dim, double>         &w_bar,
                                CellVectors<dim, double>              &X_bar)
  {
    const double mean = cell_strain_rate(geometry, w), factor = weight / cell_volume(geometry);
    const auto   difference =
      [&](const auto &map, const auto &state, const auto &, unsigned int) -> PointDual<dim> {
      return factor * (equivalent(strain_rate(map, state)) - mean);
    };
    const auto bar = reverse_sum_over_points(geometry, w, MaterialLaw<double>(), difference, w_bar);
    for (unsigned int c = 0; c < X_bar.size(); ++c)
      X_bar[c] += bar.X[c];
  }

  // The mean's denominator moves, too, as that of the strain rate's.
  template <int dim>
  QuadratureSensitivity<dim> reverse_cell_deviatoric_stress(const QuadratureGeometry<dim, double> &geometry,
                                                            const QuadratureValues<dim, double>   &w,
                                                            const MaterialLaw<double>             &law,
                                                            Symmetric<double>                      s_bar,
                                                            QuadratureValues<dim, double>         &w_bar)
  {
    remove_trace(s_bar);
    const double              volume = cell_volume(geometry);
    const double              mean   = double_contraction(cell_deviatoric_stress(geometry, w, law), s_bar);
    Symmetric<PointDual<dim>> bar;
    for (unsigned int k = 0; k < 6; ++k)
      bar[k] = s_bar[k];
    const auto difference =
      [&](const auto &map, const auto &state, const auto &x_law, unsigned int) -> PointDual<dim> {
      const auto     eps  = strain_rate(map, state);
      PointDual<dim> less = -mean;
      if (value_of(double_contraction(eps, eps)) != 0.)
        less += double_contraction(point_stress(eps, x_law), bar);
      return less / volume;
    };
    return reverse_sum_over_points(geometry, w, law, difference, w_bar);
  }

  template <int dim>
  std::array<Symmetric<double>, dim + 1> corner_strain_rates(const QuadratureGeometry<dim, double> &geometry,
                                                             const QuadratureValues<dim, double>   &w)
  {
    const ReferenceElement<dim>           &element = *geometry.element;
    const unsigned int                     n       = element.n_velocities() - (element.has_bubble() ? 1 : 0);
    std::array<Symmetric<double>, dim + 1> eps;
    for (unsigned int a = 0; a <= dim; ++a)
    {
      PointFlow<dim, double> state;
      add_positions(element.at_vertices().geometry, a, geometry.X, state);
      add_velocities(element.at_vertices().velocity, a, n, w.V, state);
      eps[a] = strain_rate(PointMap<dim, double>(state, element.kinematics()), state);
    }
    return eps;
  }

#define RETROFORGE_INSTANTIATE_VALUES(dim, Number)                                                       \
  template Number                        cell_volume(const QuadratureGeometry<dim, Number> &);           \
  template Number                        cell_functional(const QuadratureGeometry<dim, Number> &,        \
                                                         const QuadratureValues<dim, Number> &,          \
                                                         const MaterialLaw<Number> &);                   \
  template QuadratureValues<dim, Number> cell_residual(const QuadratureGeometry<dim, Number> &,          \
                                                       const QuadratureValues<dim, Number> &,            \
                                                       const MaterialLaw<Number> &);                     \
  template Number                        cell_dissipation(const QuadratureGeometry<dim, Number> &,       \
                                                          const QuadratureValues<dim, Number> &,         \
                                                          const MaterialLaw<Number> &);                  \
  template Number                        cell_strain_rate(const QuadratureGeometry<dim, Number> &,       \
                                                          const QuadratureValues<dim, Number> &);        \
  template Symmetric<Number>             cell_deviatoric_stress(const QuadratureGeometry<dim, Number> &, \
                                                                const QuadratureValues<dim, Number> &,   \
                                                                const MaterialLaw<Number> &);
#define RETROFORGE_INSTANTIATE(dim)                                                                     \
  RETROFORGE_INSTANTIATE_VALUES(dim, double)                                                            \
  RETROFORGE_INSTANTIATE_VALUES(dim, Dual)                                                              \
  template QuadratureSensitivity<dim> reverse_cell_residual(const QuadratureGeometry<dim, double> &,    \
                                                            const QuadratureValues<dim, double> &,      \
                                                            const QuadratureValues<dim, double> &,      \
                                                            const MaterialLaw<double> &);               \
  template QuadratureSensitivity<dim> reverse_cell_residual(const QuadratureGeometry<dim, double> &,    \
                                                            const QuadratureValues<dim, double> &,      \
                                                            const QuadratureValues<dim, double> &,      \
                                                            const MaterialLaw<double> &,                \
                                                            QuadratureValues<dim, double> &);           \
  template QuadratureSensitivity<dim> reverse_cell_dissipation(const QuadratureGeometry<dim, double> &, \
                                                               const QuadratureValues<dim, double> &,   \
                                                               const MaterialLaw<double> &,             \
                                                               double,                                  \
                                                               QuadratureValues<dim, double> &);        \
  template void                       reverse_cell_strain_rate(const QuadratureGeometry<dim, double> &, \
                                                               const QuadratureValues<dim, double> &,   \
                                                               double,                                  \
                                                               QuadratureValues<dim, double> &,         \
                                                               CellVectors<dim, double> &);             \
  template QuadratureSensitivity<dim> reverse_cell_deviatoric_stress(                                   \
    const QuadratureGeometry<dim, double> &,                                                            \
    const QuadratureValues<dim, double> &,                                                              \
    const MaterialLaw<double> &,                                                                        \
    Symmetric<double>,                                                                                  \
    QuadratureValues<dim, double> &);                                                                   \
  template std::array<Symmetric<double>, dim + 1> corner_strain_rates(                                  \
    const QuadratureGeometry<dim, double> &, const QuadratureValues<dim, double> &);
  RETROFORGE_INSTANTIATE(2)
  RETROFORGE_INSTANTIATE(3)
#undef RETROFORGE_INSTANTIATE
#undef RETROFORGE_INSTANTIATE_VALUES
} // namespace retroforge
