// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/numbers.h>
#include <retroforge/element/bubble_search.h>
#include <retroforge/element/quadrature_cell.templates.h>

namespace retroforge
{
  namespace
  {
    /// ds_k/deps_l of the components.
    using StressDerivative = std::array<Symmetric<double>, 6>;

    StressDerivative stress_derivative(const Symmetric<double>   &eps,
                                       const MaterialLaw<double> &law,
                                       const Linearisation        linearisation)
    {
      StressDerivative C = {};
      if (linearisation == Linearisation::picard)
      {
        for (unsigned int k = 0; k < 6; ++k)
          C[k][k] = law(double_contraction(eps, eps));
        return C;
      }
      using Number = Sacado::Fad::SFad<double, 6>;
      Symmetric<Number> x;
      for (unsigned int k = 0; k < 6; ++k)
        x[k] = Number(6, k, eps[k]);
      const Symmetric<Number> s = point_stress(x, converted<Number>(law));
      for (unsigned int k = 0; k < 6; ++k)
        for (unsigned int l = 0; l < 6; ++l)
          C[k][l] = s[k].dx(l);
      return C;
    }

    /// The strain rates of a point where one component of one velocity function is 1.
    template <int dim>
    Symmetric<double> unit_strain_rate(const PointMap<dim, double> &map,
                                       const ShapeTable<dim>       &shapes,
                                       const unsigned int           q,
                                       const unsigned int           a,
                                       const unsigned int           i)
    {
      dealii::Tensor<2, dim> H;
      H[i] = shapes.gradient(q, a);
      return strain_rate(map, H, i == 0 ? shapes.value(q, a) : 0.);
    }

    Symmetric<double> applied(const StressDerivative &C, const Symmetric<double> &eps)
    {
      Symmetric<double> s = {};
      for (unsigned int k = 0; k < 6; ++k)
        for (unsigned int l = 0; l < 6; ++l)
          s[k] += C[k][l] * eps[l];
      return s;
    }

    /// Adds to tangent what the functions from the first on have of a point.
    template <int dim>
    void add_point(const QuadratureGeometry<dim, double> &geometry,
                   const QuadratureValues<dim, double>   &w,
                   const MaterialLaw<double>             &law,
                   const Linearisation                    linearisation,
                   const unsigned int                     q,
                   const unsigned int                     first,
                   QuadratureTangent<dim>                &tangent)
    {
      const ReferenceElement<dim>   &element = *geometry.element;
      const ShapeTables<dim>        &tables  = element.at_points();
      const PointFlow<dim, double>   state   = state_at(geometry, w, q);
      const PointMap<dim, double>    map(state, element.kinematics());
      const double                   weight = element.weight(q) * map.volume;
      const Symmetric<double>        eps    = strain_rate(map, state);
      const StressDerivative         C      = stress_derivative(eps, law, linearisation);
      std::vector<Symmetric<double>> unit;
      for (unsigned int a = first; a < element.n_velocities(); ++a)
        for (unsigned int i = 0; i < dim; ++i)
          unit.push_back(unit_strain_rate(map, tables.velocity, q, a, i));
      for (unsigned int s = 0; s < unit.size(); ++s)
      {
        const Symmetric<double> stress = applied(C, unit[s]);
        for (unsigned int r = 0; r < unit.size(); ++r)
          tangent.A(first + r / dim, first + s / dim)[r % dim][s % dim] +=
            weight * double_contraction(unit[r], stress);
        for (unsigned int b = 0; b < element.n_pressures(); ++b)
          tangent.B(first + s / dim, b)[s % dim] -= weight * trace(unit[s]) * tables.pressure.value(q, b);
      }
      tangent.volume += weight;
      tangent.viscosity += 0.5 * weight * law(double_contraction(eps, eps));
    }

    template <int dim>
    QuadratureTangent<dim> tangent_of_functions(const QuadratureGeometry<dim, double> &geometry,
                                                const QuadratureValues<dim, double>   &w,
                                                const MaterialLaw<double>             &law,
                                                const Linearisation                    linearisation,
                                                const unsigned int                     first)
    {
      const ReferenceElement<dim> &element = *geometry.element;
      const unsigned int           n = element.n_velocities(), m = element.n_pressures();
      QuadratureTangent<dim>       tangent{{n, n}, {n, m}, dealii::FullMatrix<double>(m, m), 0., 0.};
      for (unsigned int q = 0; q < element.n_points(); ++q)
        add_point(geometry, w, law, linearisation, q, first, tangent);
      tangent.viscosity /= tangent.volume;
      return tangent;
    }
  } // namespace

  template <int dim>
  QuadratureTangent<dim> cell_tangent(const QuadratureGeometry<dim, double> &geometry,
                                      const QuadratureValues<dim, double>   &w,
                                      const MaterialLaw<double>             &law,
                                      const Linearisation                    linearisation)
  {
    return tangent_of_functions(geometry, w, law, linearisation, 0);
  }

  template <int dim>
  EliminatedBubble<dim> eliminate_bubble(QuadratureTangent<dim> &tangent)
  {
    const unsigned int    n = tangent.A.n_rows() - 1, m = tangent.B.n_cols();
    EliminatedBubble<dim> bubble;
    bubble.M = invert(tangent.A(n, n));
    for (unsigned int a = 0; a < n; ++a)
      bubble.Vb.push_back(tangent.A(a, n));
    for (unsigned int b = 0; b < m; ++b)
      bubble.Pb.push_back(tangent.B(n, b));
    QuadratureTangent<dim> rest{{n, n}, {n, m}, tangent.C, tangent.viscosity, tangent.volume};
    for (unsigned int a = 0; a < n; ++a)
    {
      const dealii::Tensor<2, dim> VbM = bubble.Vb[a] * bubble.M;
      for (unsigned int b = 0; b < n; ++b)
        rest.A(a, b) = tangent.A(a, b) - VbM * transpose(bubble.Vb[b]);
      for (unsigned int b = 0; b < m; ++b)
        rest.B(a, b) = tangent.B(a, b) - VbM * bubble.Pb[b];
    }
    for (unsigned int a = 0; a < m; ++a)
      for (unsigned int b = 0; b < m; ++b)
        rest.C(a, b) -= bubble.Pb[a] * (bubble.M * bubble.Pb[b]);
    tangent = std::move(rest);
    return bubble;
  }

  template <int dim>
  dealii::Tensor<1, dim> solve_bubble(const QuadratureGeometry<dim, double> &geometry,
                                      const QuadratureValues<dim, double>   &w,
                                      const MaterialLaw<double>             &law)
  {
    const unsigned int            bubble = w.V.size() - 1;
    QuadratureValues<dim, double> at     = w;
    at.V.pop_back();
    BubbleSearch<dim> search(w.V[bubble], at.V);
    at.V.emplace_back();
    while (!search.done())
    {
      at.V[bubble]                          = search.trial();
      const dealii::Tensor<1, dim> residual = cell_residual(geometry, at, law).V[bubble];
      const auto tangent = tangent_of_functions(geometry, at, law, Linearisation::newton, bubble);
      const dealii::Tensor<1, dim> step = -(invert(tangent.A(bubble, bubble)) * residual);
      BubbleState<dim, double>     state;
      state.value = cell_functional(geometry, at, law);
      for (unsigned int i = 0; i < dim; ++i)
      {
        state.residual[i]    = residual[i];
        state.newton_step[i] = step[i];
      }
      search.take(state);
    }
    return search.beta();
  }

#define RETROFORGE_INSTANTIATE(dim)                                                     \
  template QuadratureTangent<dim> cell_tangent(const QuadratureGeometry<dim, double> &, \
                                               const QuadratureValues<dim, double> &,   \
                                               const MaterialLaw<double> &,             \
                                               Linearisation);                          \
  template EliminatedBubble<dim>  eliminate_bubble(QuadratureTangent<dim> &);           \
  template dealii::Tensor<1, dim> solve_bubble(const QuadratureGeometry<dim, double> &, \
                                               const QuadratureValues<dim, double> &,   \
                                               const MaterialLaw<double> &);
  RETROFORGE_INSTANTIATE(2)
  RETROFORGE_INSTANTIATE(3)
#undef RETROFORGE_INSTANTIATE
} // namespace retroforge
