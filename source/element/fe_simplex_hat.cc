// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/scalar_polynomials_base.h>

#include <retroforge/element/fe_simplex_hat.h>

#include <algorithm>
#include <array>

namespace retroforge
{
  namespace
  {
    using dealii::Point;
    using dealii::Tensor;

    template <int dim>
    std::array<double, dim + 1> barycentric(const Point<dim> &x)
    {
      std::array<double, dim + 1> lambda;
      lambda[0] = 1.;
      for (unsigned int i = 0; i < dim; ++i)
      {
        lambda[0] -= x[i];
        lambda[i + 1] = x[i];
      }
      return lambda;
    }

    template <int dim>
    Tensor<1, dim> barycentric_gradient(const unsigned int a)
    {
      Tensor<1, dim> g;
      for (unsigned int i = 0; i < dim; ++i)
        g[i] = a == 0 ? -1. : a == i + 1 ? 1. : 0.;
      return g;
    }

    /// Where b is a multiple of the smallest coordinate: the simplex opposite of that vertex.
    template <int dim>
    unsigned int smallest(const std::array<double, dim + 1> &lambda)
    {
      return std::min_element(lambda.begin(), lambda.end()) - lambda.begin();
    }

    /// lambda_0 … lambda_dim and (dim+1) min lambda_a: piecewise linear, no derivatives beyond the first.
    template <int dim>
    class HatPolynomials : public dealii::ScalarPolynomialsBase<dim>
    {
    public:
      HatPolynomials() : dealii::ScalarPolynomialsBase<dim>(1, dim + 2) {}

      void evaluate(const Point<dim>            &x,
                    std::vector<double>         &values,
                    std::vector<Tensor<1, dim>> &gradients,
                    std::vector<Tensor<2, dim>> &second,
                    std::vector<Tensor<3, dim>> &third,
                    std::vector<Tensor<4, dim>> &fourth) const override
      {
        for (unsigned int i = 0; i < values.size(); ++i)
          values[i] = compute_value(i, x);
        for (unsigned int i = 0; i < gradients.size(); ++i)
          gradients[i] = compute_grad(i, x);
        std::fill(second.begin(), second.end(), Tensor<2, dim>());
        std::fill(third.begin(), third.end(), Tensor<3, dim>());
        std::fill(fourth.begin(), fourth.end(), Tensor<4, dim>());
      }

      double compute_value(const unsigned int i, const Point<dim> &x) const override
      {
        const auto lambda = barycentric<dim>(x);
        return i <= dim ? lambda[i] : (dim + 1.) * lambda[smallest<dim>(lambda)];
      }

      Tensor<1, dim> compute_grad(const unsigned int i, const Point<dim> &x) const override
      {
        return i <= dim ? barycentric_gradient<dim>(i)
                        : (dim + 1.) * barycentric_gradient<dim>(smallest<dim>(barycentric<dim>(x)));
      }

      Tensor<1, dim> compute_1st_derivative(const unsigned int i, const Point<dim> &x) const override
      {
        return compute_grad(i, x);
      }

      Tensor<2, dim> compute_grad_grad(const unsigned int, const Point<dim> &) const override { return {}; }
      Tensor<2, dim> compute_2nd_derivative(const unsigned int, const Point<dim> &) const override
      {
        return {};
      }
      Tensor<3, dim> compute_3rd_derivative(const unsigned int, const Point<dim> &) const override
      {
        return {};
      }
      Tensor<4, dim> compute_4th_derivative(const unsigned int, const Point<dim> &) const override
      {
        return {};
      }

      std::string name() const override { return "hat bubble"; }

      std::unique_ptr<dealii::ScalarPolynomialsBase<dim>> clone() const override
      {
        return std::make_unique<HatPolynomials>(*this);
      }
    };

    template <int dim>
    dealii::FiniteElementData<dim> data()
    {
      std::vector<unsigned int> dofs_per_object(dim + 1, 0);
      dofs_per_object[0] = dofs_per_object[dim] = 1;
      return {dofs_per_object,
              dealii::ReferenceCells::get_simplex<dim>(),
              1,
              1,
              dealii::FiniteElementData<dim>::H1};
    }

    template <int dim>
    Point<dim> vertex(const unsigned int a)
    {
      Point<dim> x;
      if (a > 0)
        x[a - 1] = 1.;
      return x;
    }

    template <int dim>
    Point<dim> barycentre()
    {
      Point<dim> x;
      for (unsigned int i = 0; i < dim; ++i)
        x[i] = 1. / (dim + 1.);
      return x;
    }
  } // namespace

  template <int dim>
  FE_SimplexHat<dim>::FE_SimplexHat()
      : dealii::FE_Poly<dim>(HatPolynomials<dim>(),
                             data<dim>(),
                             std::vector<bool>(dim + 2, false),
                             std::vector<dealii::ComponentMask>(dim + 2, dealii::ComponentMask(1, true)))
  {
    for (unsigned int a = 0; a <= dim; ++a)
      this->unit_support_points.push_back(vertex<dim>(a));
    this->unit_support_points.push_back(barycentre<dim>());
    this->unit_face_support_points.resize(1);
    for (unsigned int a = 0; a < dim; ++a)
      this->unit_face_support_points[0].push_back(vertex<dim - 1>(a));
  }

  template <int dim>
  std::unique_ptr<dealii::FiniteElement<dim>> FE_SimplexHat<dim>::clone() const
  {
    return std::make_unique<FE_SimplexHat>(*this);
  }

  template <int dim>
  std::string FE_SimplexHat<dim>::get_name() const
  {
    return "FE_SimplexHat<" + std::to_string(dim) + ">(1)";
  }

  template <int dim>
  std::pair<dealii::Table<2, bool>, std::vector<unsigned int>> FE_SimplexHat<dim>::get_constant_modes() const
  {
    dealii::Table<2, bool> modes(1, dim + 2);
    for (unsigned int i = 0; i < dim + 2; ++i)
      modes(0, i) = i <= dim;
    return {modes, {0}};
  }

  template <int dim>
  void FE_SimplexHat<dim>::convert_generalized_support_point_values_to_dof_values(
    const std::vector<dealii::Vector<double>> &values,
    std::vector<double>                       &dofs) const
  {
    double mean = 0.;
    for (unsigned int a = 0; a <= dim; ++a)
    {
      dofs[a] = values[a](0);
      mean += dofs[a] / (dim + 1.);
    }
    dofs[dim + 1] = values[dim + 1](0) - mean;
  }

  template <int dim>
  dealii::Quadrature<dim> hat_quadrature()
  {
    return iterated_on_hat<dim>(
      dealii::Quadrature<dim>(std::vector<Point<dim>>{barycentre<dim>()},
                              std::vector<double>{dealii::ReferenceCells::get_simplex<dim>().volume()}));
  }

  template <int dim>
  dealii::Quadrature<dim> iterated_on_hat(const dealii::Quadrature<dim> &rule)
  {
    std::vector<Point<dim>> points;
    std::vector<double>     weights;
    for (unsigned int a = 0; a <= dim; ++a)
      for (unsigned int q = 0; q < rule.size(); ++q)
      {
        const auto lambda = barycentric<dim>(rule.point(q));
        Point<dim> x;
        for (unsigned int b = 0; b <= dim; ++b)
          x += lambda[b] * (b == a ? barycentre<dim>() : vertex<dim>(b));
        points.push_back(x);
        weights.push_back(rule.weight(q) / (dim + 1.));
      }
    return {points, weights};
  }

#define RETROFORGE_INSTANTIATE(dim)                       \
  template class FE_SimplexHat<dim>;                      \
  template dealii::Quadrature<dim> hat_quadrature<dim>(); \
  template dealii::Quadrature<dim> iterated_on_hat(const dealii::Quadrature<dim> &);
  RETROFORGE_INSTANTIATE(2)
  RETROFORGE_INSTANTIATE(3)
#undef RETROFORGE_INSTANTIATE
} // namespace retroforge
