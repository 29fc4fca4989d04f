// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include "quadrature_tools.h"
#include <retroforge/element/fe_simplex_hat.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_fe.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparse_direct.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/sparsity_pattern.h>

#include <functional>
#include <map>

namespace retroforge
{
  /// A pair of elements in the plane, as deal.II knows it.
  struct PlanePair
  {
    std::string                               name;
    std::shared_ptr<dealii::FiniteElement<2>> velocity;
    dealii::Quadrature<2>                     rule;
    dealii::Quadrature<2>                     fine_rule; ///< of errors and body forces
  };

  inline PlanePair mini_pair()
  {
    return {"mini",
            std::make_shared<FE_SimplexHat<2>>(),
            hat_quadrature<2>(),
            iterated_on_hat(dealii::QGaussSimplex<2>(3))};
  }

  inline PlanePair quadratic_pair()
  {
    return {"P2-P1",
            std::make_shared<dealii::FE_SimplexP<2>>(2),
            second_degree_quadrature<2>(),
            dealii::QGaussSimplex<2>(4)};
  }

  /// n x n squares of the unit square, each cut in two; vertices inside are moved by up to `shift` of an
  /// edge.
  inline void make_square(dealii::Triangulation<2> &triangulation, const unsigned int n, const double shift)
  {
    dealii::GridGenerator::subdivided_hyper_rectangle_with_simplices(
      triangulation, {n, n}, dealii::Point<2>(0., 0.), dealii::Point<2>(1., 1.));
    std::map<unsigned int, dealii::Point<2> *> vertices;
    for (const auto &cell : triangulation.active_cell_iterators())
      for (const unsigned int a : cell->vertex_indices())
        vertices[cell->vertex_index(a)] = &cell->vertex(a);
    RandomNumbers random;
    for (const auto &[k, x] : vertices)
    {
      const auto move   = shift / n * random_vector<2>(random);
      const bool inside = std::min((*x)[0], (*x)[1]) > 1e-9 && std::max((*x)[0], (*x)[1]) < 1. - 1e-9;
      if (inside)
        *x += move;
    }
  }

  /// A flow on a triangulation with the kernels by quadrature. Bubbles are unknowns as others.
  class PlaneFlow
  {
  public:
    using Cell = dealii::DoFHandler<2>::active_cell_iterator;
    /// Forces on the unknowns of a cell.
    using Load = std::function<dealii::Vector<double>(const Cell &)>;

    PlaneFlow(const dealii::Triangulation<2> &triangulation,
              const PlanePair                &pair,
              const Kinematics                kinematics)
        : fe(*pair.velocity, 2, dealii::FE_SimplexP<2>(1), 1)
        , reference(dealii::FE_SimplexP<2>(1),
                    *pair.velocity,
                    dealii::FE_SimplexP<2>(1),
                    pair.rule,
                    kinematics)
        , dofs(triangulation)
    {
      dofs.distribute_dofs(fe);
      solution.reinit(dofs.n_dofs());
      held_.assign(dofs.n_dofs(), {});
    }

    /// v·n = value(x) at velocity nodes where `here`; n a unit vector.
    void hold(const std::function<bool(const dealii::Point<2> &)>   &here,
              const dealii::Tensor<1, 2>                            &n,
              const std::function<double(const dealii::Point<2> &)> &value)
    {
      for_each_node([&](const dealii::Point<2> &x, const std::array<unsigned int, 2> &node) {
        if (!here(x))
          return;
        for (const auto &held : held_[node[0]])
          if (std::abs(held.n * n) > 1. - 1e-12)
            return;
        held_[node[0]].push_back({n, value(x), node});
      });
    }

    /// f(position, unknowns of the two components) of each velocity node, more than once.
    template <typename F>
    void for_each_node(const F &f) const
    {
      const auto &points = fe.base_element(0).get_unit_support_points();
      const auto  n      = points.size() - (reference.has_bubble() ? 1 : 0);
      for (const auto &cell : dofs.active_cell_iterators())
      {
        const auto indices = indices_of(cell);
        for (unsigned int a = 0; a < n; ++a)
          f(mapping.transform_unit_to_real_cell(cell, points[a]),
            std::array<unsigned int, 2>{
              {indices[fe.component_to_system_index(0, a)], indices[fe.component_to_system_index(1, a)]}});
      }
    }

    /// Lines of deal.II's constraints: of one direction that is held, the component that it has most of
    /// follows from the other; of two, both are given.
    void finish_constraints()
    {
      for (const auto &held : held_)
      {
        if (held.empty())
          continue;
        AssertThrow(held.size() <= 2, dealii::ExcMessage("three directions of a node are held"));
        const auto &[n, value, node] = held[0];
        if (held.size() == 1)
        {
          const unsigned int i = std::abs(n[0]) > std::abs(n[1]) ? 0 : 1;
          constraints.add_line(node[i]);
          if (n[1 - i] != 0.)
            constraints.add_entry(node[i], node[1 - i], -n[1 - i] / n[i]);
          constraints.set_inhomogeneity(node[i], value / n[i]);
          continue;
        }
        dealii::Tensor<2, 2> both;
        both[0]      = n;
        both[1]      = held[1].n;
        const auto v = invert(both) * dealii::Tensor<1, 2>({value, held[1].value});
        for (unsigned int i = 0; i < 2; ++i)
        {
          constraints.add_line(node[i]);
          constraints.set_inhomogeneity(node[i], v[i]);
        }
      }
      constraints.close();
    }

    /// @return iterations
    unsigned int solve(const MaterialLaw<double> &law, const Load &load = {})
    {
      dealii::AffineConstraints<double> homogeneous;
      homogeneous.copy_from(constraints);
      for (const auto &line : constraints.get_lines())
        homogeneous.set_inhomogeneity(line.index, 0.);
      dealii::DynamicSparsityPattern pattern(dofs.n_dofs());
      dealii::DoFTools::make_sparsity_pattern(dofs, pattern, homogeneous);
      dealii::SparsityPattern sparsity;
      sparsity.copy_from(pattern);
      dealii::SparseMatrix<double> matrix(sparsity);
      dealii::Vector<double>       rhs(dofs.n_dofs()), step(dofs.n_dofs());

      constraints.distribute(solution);
      double first = 0.;
      for (unsigned int iteration = 0; iteration < 60; ++iteration)
      {
        // The first law is the Newtonian one of strain rates about 1.
        assemble(iteration == 0 ? law.newtonian(1.) : law,
                 iteration < 3 ? Linearisation::picard : Linearisation::newton,
                 homogeneous,
                 load,
                 &matrix,
                 rhs);
        if (iteration == 0)
          first = rhs.l2_norm();
        else if (rhs.l2_norm() < 1e-13 * first)
          return iteration;
        dealii::SparseDirectUMFPACK direct;
        direct.initialize(matrix);
        direct.vmult(step, rhs);
        homogeneous.distribute(step);
        solution += step;
        if (iteration < 3)
          continue;
        const double before = rhs.l2_norm();
        for (unsigned int halving = 0; halving < 5; ++halving)
        {
          assemble(law, Linearisation::newton, homogeneous, load, nullptr, rhs);
          if (rhs.l2_norm() < before)
            break;
          step *= 0.5;
          solution -= step;
        }
        if (step.l2_norm() < 1e-13 * solution.l2_norm())
          return iteration;
      }
      return 60;
    }

    /// Dissipated [mJ/s].
    double power(const MaterialLaw<double> &law) const
    {
      double sum = 0.;
      for (const auto &cell : dofs.active_cell_iterators())
        sum += cell_dissipation(geometry_of(cell), values_of(cell), law);
      return sum;
    }

    QuadratureGeometry<2, double> geometry_of(const Cell &cell) const
    {
      QuadratureGeometry<2, double> geometry{&reference, {}};
      for (const unsigned int a : cell->vertex_indices())
        geometry.X.emplace_back(cell->vertex(a));
      return geometry;
    }

    QuadratureValues<2, double> values_of(const Cell &cell) const
    {
      QuadratureValues<2, double> w(reference);
      const auto                  indices = indices_of(cell);
      for (unsigned int i = 0; i < indices.size(); ++i)
      {
        const auto [component, a]                    = fe.system_to_component_index(i);
        (component < 2 ? w.V[a][component] : w.P[a]) = solution(indices[i]);
      }
      return w;
    }

    std::vector<unsigned int> indices_of(const Cell &cell) const
    {
      std::vector<unsigned int> indices(fe.n_dofs_per_cell());
      cell->get_dof_indices(indices);
      return indices;
    }

    /// The cell's tangent in the order of its unknowns.
    dealii::FullMatrix<double>
    matrix_of(const Cell &cell, const MaterialLaw<double> &law, const Linearisation linearisation) const
    {
      const auto                 t = cell_tangent(geometry_of(cell), values_of(cell), law, linearisation);
      const unsigned int         n = fe.n_dofs_per_cell();
      dealii::FullMatrix<double> local(n, n);
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n; ++j)
        {
          const auto [k, a] = fe.system_to_component_index(i);
          const auto [l, b] = fe.system_to_component_index(j);
          local(i, j) = k < 2 && l < 2 ? t.A(a, b)[k][l] : k < 2 ? t.B(a, b)[k] : l < 2 ? t.B(b, a)[l] : 0.;
        }
      return local;
    }

    dealii::FESystem<2>               fe;
    dealii::MappingFE<2>              mapping{dealii::FE_SimplexP<2>(1)};
    ReferenceElement<2>               reference;
    dealii::DoFHandler<2>             dofs;
    dealii::AffineConstraints<double> constraints;
    dealii::Vector<double>            solution;

  private:
    struct Held
    {
      dealii::Tensor<1, 2>        n;
      double                      value;
      std::array<unsigned int, 2> node;
    };

    void assemble(const MaterialLaw<double>               &law,
                  const Linearisation                      linearisation,
                  const dealii::AffineConstraints<double> &homogeneous,
                  const Load                              &load,
                  dealii::SparseMatrix<double>            *matrix,
                  dealii::Vector<double>                  &rhs) const
    {
      rhs = 0.;
      if (matrix)
        *matrix = 0.;
      for (const auto &cell : dofs.active_cell_iterators())
      {
        dealii::Vector<double> local(fe.n_dofs_per_cell());
        if (load)
          local = load(cell);
        const auto r = cell_residual(geometry_of(cell), values_of(cell), law);
        for (unsigned int i = 0; i < local.size(); ++i)
        {
          const auto [component, a] = fe.system_to_component_index(i);
          local(i) -= component < 2 ? r.V[a][component] : r.P[a];
        }
        if (matrix)
          homogeneous.distribute_local_to_global(
            matrix_of(cell, law, linearisation), local, indices_of(cell), *matrix, rhs);
        else
          homogeneous.distribute_local_to_global(local, indices_of(cell), rhs);
      }
    }

    std::vector<std::vector<Held>> held_; ///< by the first unknown of each node
  };
} // namespace retroforge
