// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/element/kinematics.h>

#include <deal.II/base/quadrature.h>
#include <deal.II/base/tensor.h>
#include <deal.II/fe/fe.h>

#include <vector>

namespace retroforge
{
  /// Values and gradients of scalar shape functions at points of the reference cell, in the order of the
  /// finite element.
  template <int dim>
  class ShapeTable
  {
  public:
    ShapeTable(const dealii::FiniteElement<dim> &element, const std::vector<dealii::Point<dim>> &points);

    unsigned int n_functions() const { return n_functions_; }

    double value(const unsigned int q, const unsigned int a) const { return values_[n_functions_ * q + a]; }

    /// In reference coordinates.
    const dealii::Tensor<1, dim> &gradient(const unsigned int q, const unsigned int a) const
    {
      return gradients_[n_functions_ * q + a];
    }

  private:
    unsigned int                        n_functions_;
    std::vector<double>                 values_;
    std::vector<dealii::Tensor<1, dim>> gradients_;
  };

  /// The shape functions of one place: of positions x, of each component of the velocity, and of pressures.
  template <int dim>
  struct ShapeTables
  {
    ShapeTable<dim> geometry, velocity, pressure;
  };

  /// A pair of finite elements for velocity and pressure on cells that a third one maps, as an integral over
  /// the cell needs it: tables at the points of a quadrature rule.
  template <int dim>
  class ReferenceElement
  {
  public:
    /// @param geometry, velocity, pressure  scalar elements on the same reference cell; of the velocity's
    ///   functions the last may be a bubble, which is the cell's own
    /// @param rule  with positive weights, or the power is not convex in the velocity
    ReferenceElement(const dealii::FiniteElement<dim> &geometry,
                     const dealii::FiniteElement<dim> &velocity,
                     const dealii::FiniteElement<dim> &pressure,
                     const dealii::Quadrature<dim>    &rule,
                     Kinematics                        kinematics);

    unsigned int n_points() const { return weights_.size(); }
    double       weight(const unsigned int q) const { return weights_[q]; }
    Kinematics   kinematics() const { return kinematics_; }
    bool         has_bubble() const { return has_bubble_; }

    /// At the points of the rule.
    const ShapeTables<dim> &at_points() const { return at_points_; }
    /// At the vertices of the cell. A hat bubble's gradients are one-sided there.
    const ShapeTables<dim> &at_vertices() const { return at_vertices_; }

    unsigned int n_positions() const { return at_points_.geometry.n_functions(); }
    /// With the bubble.
    unsigned int n_velocities() const { return at_points_.velocity.n_functions(); }
    unsigned int n_pressures() const { return at_points_.pressure.n_functions(); }

  private:
    std::vector<double> weights_;
    Kinematics          kinematics_;
    bool                has_bubble_;
    ShapeTables<dim>    at_points_, at_vertices_;
  };

  /// dim+1 points of equal weights, exact to degree two: at point a the barycentric coordinate of vertex a is
  /// 1 - dim t and the others are t = (1 - 1/sqrt(dim+2))/(dim+1).  @cite Hammer1956
  template <int dim>
  dealii::Quadrature<dim> second_degree_quadrature();

  /// The mini element, P1 and a hat bubble and P1, with one point in each part of the hat; tetrahedra by the
  /// closed form: element/mini_element.h.
  template <int dim>
  ReferenceElement<dim> mini_reference(unsigned int geometry_degree, Kinematics kinematics);

  /// P2 and P1, by second_degree_quadrature(); tetrahedra by the closed form:
  /// element/taylor_hood.h.
  template <int dim>
  ReferenceElement<dim> taylor_hood_reference(unsigned int geometry_degree, Kinematics kinematics);
} // namespace retroforge
