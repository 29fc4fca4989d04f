// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/element/fe_simplex_hat.h>
#include <retroforge/element/reference_element.h>

#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>

namespace retroforge
{
  template <int dim>
  ShapeTable<dim>::ShapeTable(const dealii::FiniteElement<dim>      &element,
                              const std::vector<dealii::Point<dim>> &points)
      : n_functions_(element.n_dofs_per_cell())
  {
    Assert(element.n_components() == 1, dealii::ExcMessage("a scalar element is expected"));
    const dealii::ReferenceCell cell = element.reference_cell();
    dealii::Triangulation<dim>  reference;
    dealii::GridGenerator::reference_cell(reference, cell);
    dealii::FEValues<dim> values(cell.template get_default_linear_mapping<dim>(),
                                 element,
                                 dealii::Quadrature<dim>(points),
                                 dealii::update_values | dealii::update_gradients);
    values.reinit(reference.begin_active());
    for (unsigned int q = 0; q < points.size(); ++q)
      for (unsigned int a = 0; a < n_functions_; ++a)
      {
        values_.push_back(values.shape_value(a, q));
        gradients_.push_back(values.shape_grad(a, q));
      }
  }

  namespace
  {
    template <int dim>
    ShapeTables<dim> tables(const dealii::FiniteElement<dim>      &geometry,
                            const dealii::FiniteElement<dim>      &velocity,
                            const dealii::FiniteElement<dim>      &pressure,
                            const std::vector<dealii::Point<dim>> &points)
    {
      return {{geometry, points}, {velocity, points}, {pressure, points}};
    }

    template <int dim>
    std::vector<dealii::Point<dim>> vertices(const dealii::ReferenceCell cell)
    {
      std::vector<dealii::Point<dim>> all;
      for (const unsigned int a : cell.vertex_indices())
        all.push_back(cell.vertex<dim>(a));
      return all;
    }
  } // namespace

  template <int dim>
  ReferenceElement<dim>::ReferenceElement(const dealii::FiniteElement<dim> &geometry,
                                          const dealii::FiniteElement<dim> &velocity,
                                          const dealii::FiniteElement<dim> &pressure,
                                          const dealii::Quadrature<dim>    &rule,
                                          const Kinematics                  kinematics)
      : weights_(rule.get_weights())
      , kinematics_(kinematics)
      , has_bubble_(velocity.template n_dofs_per_object<dim>() > 0)
      , at_points_(tables(geometry, velocity, pressure, rule.get_points()))
      , at_vertices_(tables(geometry, velocity, pressure, vertices<dim>(velocity.reference_cell())))
  {
    Assert(geometry.reference_cell() == velocity.reference_cell() &&
             pressure.reference_cell() == velocity.reference_cell(),
           dealii::ExcMessage("elements on different cells"));
    Assert(velocity.template n_dofs_per_object<dim>() <= 1, dealii::ExcMessage("more than one bubble"));
    Assert((kinematics == Kinematics::three_dimensions) == (dim == 3),
           dealii::ExcMessage("kinematics of another dimension"));
  }

  template <int dim>
  dealii::Quadrature<dim> second_degree_quadrature()
  {
    const dealii::ReferenceCell     cell = dealii::ReferenceCells::get_simplex<dim>();
    const double                    t    = (1. - 1. / std::sqrt(dim + 2.)) / (dim + 1.);
    std::vector<dealii::Point<dim>> points;
    for (const auto &own : vertices<dim>(cell))
    {
      dealii::Point<dim> x = (1. - (dim + 1.) * t) * own;
      for (const auto &vertex : vertices<dim>(cell))
        x += t * vertex;
      points.push_back(x);
    }
    return {points, std::vector<double>(dim + 1, cell.volume() / (dim + 1.))};
  }

  template <int dim>
  ReferenceElement<dim> mini_reference(const unsigned int geometry_degree, const Kinematics kinematics)
  {
    return {dealii::FE_SimplexP<dim>(geometry_degree),
            FE_SimplexHat<dim>(),
            dealii::FE_SimplexP<dim>(1),
            hat_quadrature<dim>(),
            kinematics};
  }

  template <int dim>
  ReferenceElement<dim> taylor_hood_reference(const unsigned int geometry_degree, const Kinematics kinematics)
  {
    return {dealii::FE_SimplexP<dim>(geometry_degree),
            dealii::FE_SimplexP<dim>(2),
            dealii::FE_SimplexP<dim>(1),
            second_degree_quadrature<dim>(),
            kinematics};
  }

#define RETROFORGE_INSTANTIATE(dim)                                                          \
  template class ShapeTable<dim>;                                                            \
  template class ReferenceElement<dim>;                                                      \
  template dealii::Quadrature<dim> second_degree_quadrature<dim>();                          \
  template ReferenceElement<dim>   mini_reference(unsigned int geometry_degree, Kinematics); \
  template ReferenceElement<dim>   taylor_hood_reference(unsigned int geometry_degree, Kinematics);
  RETROFORGE_INSTANTIATE(2)
  RETROFORGE_INSTANTIATE(3)
#undef RETROFORGE_INSTANTIATE
} // namespace retroforge
