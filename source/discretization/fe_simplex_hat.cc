// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/scalar_polynomials_base.h>

#include <retroforge/discretization/fe_simplex_hat.h>

#include <algorithm>
#include <array>

namespace retroforge
{
  namespace
  {
    using dealii::Point;
    using dealii::Tensor;

    std::array<double, 4> barycentric(const Point<3> &x)
    {
      return {{1. - x[0] - x[1] - x[2], x[0], x[1], x[2]}};
    }

    Tensor<1, 3> barycentric_gradient(const unsigned int a)
    {
      Tensor<1, 3> g;
      for (unsigned int i = 0; i < 3; ++i)
        g[i] = a == 0 ? -1. : a == i + 1 ? 1. : 0.;
      return g;
    }

    /// Where b is four times the smallest coordinate: the tetrahedron opposite of that vertex.
    unsigned int smallest(const std::array<double, 4> &lambda)
    {
      return std::min_element(lambda.begin(), lambda.end()) - lambda.begin();
    }

    /// lambda_0 … lambda_3 and 4 min lambda_a: piecewise linear, no derivatives beyond the first.
    class HatPolynomials : public dealii::ScalarPolynomialsBase<3>
    {
    public:
      HatPolynomials() : dealii::ScalarPolynomialsBase<3>(1, 5) {}

      void evaluate(const Point<3>            &x,
                    std::vector<double>       &values,
                    std::vector<Tensor<1, 3>> &gradients,
                    std::vector<Tensor<2, 3>> &second,
                    std::vector<Tensor<3, 3>> &third,
                    std::vector<Tensor<4, 3>> &fourth) const override
      {
        for (unsigned int i = 0; i < values.size(); ++i)
          values[i] = compute_value(i, x);
        for (unsigned int i = 0; i < gradients.size(); ++i)
          gradients[i] = compute_grad(i, x);
        std::fill(second.begin(), second.end(), Tensor<2, 3>());
        std::fill(third.begin(), third.end(), Tensor<3, 3>());
        std::fill(fourth.begin(), fourth.end(), Tensor<4, 3>());
      }

      double compute_value(const unsigned int i, const Point<3> &x) const override
      {
        const auto lambda = barycentric(x);
        return i < 4 ? lambda[i] : 4. * lambda[smallest(lambda)];
      }

      Tensor<1, 3> compute_grad(const unsigned int i, const Point<3> &x) const override
      {
        return i < 4 ? barycentric_gradient(i) : 4. * barycentric_gradient(smallest(barycentric(x)));
      }

      Tensor<1, 3> compute_1st_derivative(const unsigned int i, const Point<3> &x) const override
      {
        return compute_grad(i, x);
      }

      Tensor<2, 3> compute_grad_grad(const unsigned int, const Point<3> &) const override { return {}; }
      Tensor<2, 3> compute_2nd_derivative(const unsigned int, const Point<3> &) const override { return {}; }
      Tensor<3, 3> compute_3rd_derivative(const unsigned int, const Point<3> &) const override { return {}; }
      Tensor<4, 3> compute_4th_derivative(const unsigned int, const Point<3> &) const override { return {}; }

      std::string name() const override { return "hat bubble"; }

      std::unique_ptr<dealii::ScalarPolynomialsBase<3>> clone() const override
      {
        return std::make_unique<HatPolynomials>(*this);
      }
    };

    dealii::FiniteElementData<3> data()
    {
      return {{1, 0, 0, 1}, dealii::ReferenceCells::Tetrahedron, 1, 1, dealii::FiniteElementData<3>::H1};
    }

    Point<3> vertex(const unsigned int a)
    {
      Point<3> x;
      if (a > 0)
        x[a - 1] = 1.;
      return x;
    }

    const Point<3> barycentre(0.25, 0.25, 0.25);
  } // namespace

  FE_SimplexHat::FE_SimplexHat()
      : dealii::FE_Poly<3>(HatPolynomials(),
                           data(),
                           std::vector<bool>(5, false),
                           std::vector<dealii::ComponentMask>(5, dealii::ComponentMask(1, true)))
  {
    for (unsigned int a = 0; a < 4; ++a)
      unit_support_points.push_back(vertex(a));
    unit_support_points.push_back(barycentre);
    unit_face_support_points.resize(1);
    for (const Point<2> &x : {Point<2>(0., 0.), Point<2>(1., 0.), Point<2>(0., 1.)})
      unit_face_support_points[0].push_back(x);
  }

  std::unique_ptr<dealii::FiniteElement<3>> FE_SimplexHat::clone() const
  {
    return std::make_unique<FE_SimplexHat>(*this);
  }

  std::string FE_SimplexHat::get_name() const
  {
    return "FE_SimplexHat<3>(1)";
  }

  std::pair<dealii::Table<2, bool>, std::vector<unsigned int>> FE_SimplexHat::get_constant_modes() const
  {
    dealii::Table<2, bool> modes(1, 5);
    for (unsigned int i = 0; i < 5; ++i)
      modes(0, i) = i < 4;
    return {modes, {0}};
  }

  void FE_SimplexHat::convert_generalized_support_point_values_to_dof_values(
    const std::vector<dealii::Vector<double>> &values,
    std::vector<double>                       &dofs) const
  {
    double mean = 0.;
    for (unsigned int a = 0; a < 4; ++a)
    {
      dofs[a] = values[a](0);
      mean += 0.25 * dofs[a];
    }
    dofs[4] = values[4](0) - mean;
  }

  dealii::Quadrature<3> hat_quadrature()
  {
    std::vector<Point<3>> points;
    for (unsigned int a = 0; a < 4; ++a)
    {
      Point<3> x = 0.25 * barycentre;
      for (unsigned int b = 0; b < 4; ++b)
        if (b != a)
          x += 0.25 * vertex(b);
      points.push_back(x);
    }
    return {points, std::vector<double>(4, 1. / 24.)};
  }
} // namespace retroforge
