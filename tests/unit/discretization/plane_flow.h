// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include "../element/quadrature_tools.h"
#include <retroforge/discretization/element_pairs.h>

#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparse_direct.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/sparsity_pattern.h>

#include <functional>

namespace retroforge
{
  inline std::string name_of(const ElementPair pair)
  {
    return pair == ElementPair::mini ? "mini" : "P2-P1";
  }

  inline DiscretizationChoice
  plane_choice(const ElementPair pair, const Kinematics kinematics, const unsigned int geometry_degree = 1)
  {
    return {pair, TriangulationKind::shared, Assembly::quadrature, kinematics, geometry_degree};
  }

  /// Sides of the unit square, each a patch of its own.
  enum Side : unsigned int
  {
    left,
    right,
    lower,
    upper
  };

  /// n x n squares of the unit square, two triangles each; vertices inside are moved by up to `shift` of an
  /// edge.
  /// @param symmetric  sides that are lines of symmetry
  inline SimplexMesh<2>
  unit_square(const unsigned int n, const double shift, const std::vector<Side> &symmetric)
  {
    SimplexMesh<2> mesh;
    RandomNumbers  random;
    for (unsigned int j = 0; j <= n; ++j)
      for (unsigned int i = 0; i <= n; ++i)
      {
        mesh.X.push_back(dealii::Point<2>(double(i) / n, double(j) / n));
        if (i % n != 0 && j % n != 0)
          mesh.X.back() += shift / n * random_vector<2>(random);
      }
    const auto at = [n](const unsigned int i, const unsigned int j) { return j * (n + 1) + i; };
    for (unsigned int j = 0; j < n; ++j)
      for (unsigned int i = 0; i < n; ++i)
      {
        mesh.cells.push_back({{at(i, j), at(i + 1, j), at(i + 1, j + 1)}});
        mesh.cells.push_back({{at(i, j), at(i + 1, j + 1), at(i, j + 1)}});
      }
    for (unsigned int i = 0; i < n; ++i)
    {
      mesh.faces.push_back({{{at(0, i + 1), at(0, i)}}, left});
      mesh.faces.push_back({{{at(n, i), at(n, i + 1)}}, right});
      mesh.faces.push_back({{{at(i, 0), at(i + 1, 0)}}, lower});
      mesh.faces.push_back({{{at(i + 1, n), at(i, n)}}, upper});
    }
    mesh.patches = {{"left", {}}, {"right", {}}, {"lower", {}}, {"upper", {}}};
    for (const Side side : symmetric)
    {
      dealii::Tensor<1, 2> normal;
      normal[side / 2]            = side % 2 == 0 ? -1. : 1.;
      mesh.patches[side].symmetry = Hyperplane<2>{side % 2 == 0 ? normal * 0. : normal, normal};
    }
    return mesh;
  }

  /// A flow of the metal on the spaces of a plane discretisation, with the kernels that it assembles. Bubbles
  /// are unknowns as others, and the pressures follow the velocities.
  class PlaneFlow
  {
  public:
    /// Forces on the velocities of a cell: of function a the entries 2a and 2a+1.
    using Load = std::function<std::vector<double>(CellIndex)>;

    PlaneFlow(SimplexMesh<2> made_mesh, const DiscretizationChoice &choice)
        : mesh(std::move(made_mesh))
        , X(mesh.X)
        , discretization(mesh, choice, MPI_COMM_SELF)
        , W(discretization)
        , pair{discretization.quadrature()}
    {
      for (const auto &line : discretization.symmetry().get_lines())
      {
        constraints.add_line(line.index);
        constraints.add_entries(line.index, line.entries);
      }
    }

    unsigned int n_velocities() const { return 2 * discretization.velocity_nodes()->n_places(); }
    unsigned int n_unknowns() const { return n_velocities() + discretization.pressure_nodes()->n_places(); }

    /// f(node, position) of the nodes of velocities but bubbles.
    template <typename F>
    void for_each_node(const F &f) const
    {
      const auto &nodes = *discretization.condensed_nodes();
      for (NodeIndex k = 0; k < nodes.n(); ++k)
        if (k < mesh.n_nodes())
          f(k, dealii::Point<2>(mesh.X[k]));
        else
        {
          const auto [a, b] = discretization.middles()->ends_of(k);
          f(k, dealii::Point<2>(0.5 * (mesh.X[a] + mesh.X[b])));
        }
    }

    /// Starts from a velocity. What constraints hold stays as it is there.
    void set_velocity(const std::function<dealii::Tensor<1, 2>(const dealii::Point<2> &)> &v)
    {
      for_each_node([&](const NodeIndex k, const dealii::Point<2> &x) { W.V[k] = v(x); });
    }

    /// Holds both components of the velocity of a node.
    void hold(const NodeIndex k)
    {
      const unsigned int place = discretization.velocity_nodes()->place(k);
      for (unsigned int i = 0; i < 2; ++i)
        if (!constraints.is_constrained(2 * place + i))
          constraints.add_line(2 * place + i);
    }

    /// @return iterations
    unsigned int solve(const MaterialLaw<double> &law, const Load &load = {})
    {
      constraints.close();
      dealii::DynamicSparsityPattern pattern(n_unknowns());
      for (const CellIndex c : discretization.visited_cells())
        constraints.add_entries_local_to_global(indices_of(c), pattern);
      dealii::SparsityPattern sparsity;
      sparsity.copy_from(pattern);
      dealii::SparseMatrix<double> matrix(sparsity);
      dealii::Vector<double>       rhs(n_unknowns()), step(n_unknowns());
      double                       first = 0.;
      for (unsigned int iteration = 0; iteration < 60; ++iteration)
      {
        // The first law is the Newtonian one of strain rates about 1.
        assemble(iteration == 0 ? law.newtonian(1.) : law,
                 iteration < 3 ? Linearisation::picard : Linearisation::newton,
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
        constraints.distribute(step);
        add(1., step);
        if (iteration < 3)
          continue;
        const double before = rhs.l2_norm();
        double       length = 1.;
        for (unsigned int halving = 0; halving < 5; ++halving)
        {
          assemble(law, Linearisation::newton, load, nullptr, rhs);
          if (rhs.l2_norm() < before)
            break;
          length *= 0.5;
          add(-length, step);
        }
        if (length * step.l2_norm() < 1e-13 * size())
          return iteration;
      }
      return 60;
    }

    QuadratureGeometry<2, double> geometry_of(const CellIndex c) const
    {
      return pair.positions(discretization, X, c);
    }
    QuadratureValues<2, double> values_of(const CellIndex c) const
    {
      return pair.on_cell(discretization, W, c);
    }

    /// Dissipated [mJ/s].
    double power(const MaterialLaw<double> &law) const
    {
      double sum = 0.;
      for (const CellIndex c : discretization.cells().owned())
        sum += cell_dissipation(geometry_of(c), values_of(c), law);
      return sum;
    }

    /// Of a cell: (function, component) of velocities, then pressures.
    std::vector<dealii::types::global_dof_index> indices_of(const CellIndex c) const
    {
      std::vector<dealii::types::global_dof_index> indices;
      for (unsigned int a = 0; a < pair.element->n_velocities(); ++a)
        for (unsigned int i = 0; i < 2; ++i)
          indices.push_back(2 * discretization.velocity_places(c)[a] + i);
      for (unsigned int b = 0; b < pair.element->n_pressures(); ++b)
        indices.push_back(n_velocities() + discretization.pressure_places(c)[b]);
      return indices;
    }

    /// The cell's tangent in the order of indices_of().
    dealii::FullMatrix<double>
    matrix_of(const CellIndex c, const MaterialLaw<double> &law, const Linearisation linearisation) const
    {
      const auto                 t = cell_tangent(geometry_of(c), values_of(c), law, linearisation);
      const unsigned int         n = 2 * t.A.n_rows();
      dealii::FullMatrix<double> local(n + t.B.n_cols(), n + t.B.n_cols());
      for (unsigned int r = 0; r < n; ++r)
      {
        for (unsigned int s = 0; s < n; ++s)
          local(r, s) = t.A(r / 2, s / 2)[r % 2][s % 2];
        for (unsigned int b = 0; b < t.B.n_cols(); ++b)
          local(r, n + b) = local(n + b, r) = t.B(r / 2, b)[r % 2];
      }
      return local;
    }

    SimplexMesh<2>                    mesh;
    CellVectors<2, double>            X; ///< of the vertices, or of all nodes of the positions [mm]
    Discretization<2>                 discretization;
    FlowField<2, double>              W;
    QuadraturePair<2>                 pair;
    dealii::AffineConstraints<double> constraints; ///< of changes of the unknowns

  private:
    /// All unknowns.
    double size() const
    {
      double sum = 0.;
      for (const auto &v : W.V)
        sum += v.norm_square();
      for (const double p : W.P)
        sum += p * p;
      return std::sqrt(sum);
    }

    void add(const double factor, const dealii::Vector<double> &step)
    {
      for (unsigned int place = 0; place < W.V.size(); ++place)
        for (unsigned int i = 0; i < 2; ++i)
          W.V.at_place(place)[i] += factor * step(2 * place + i);
      for (unsigned int place = 0; place < W.P.size(); ++place)
        W.P.at_place(place) += factor * step(n_velocities() + place);
    }

    void assemble(const MaterialLaw<double>    &law,
                  const Linearisation           linearisation,
                  const Load                   &load,
                  dealii::SparseMatrix<double> *matrix,
                  dealii::Vector<double>       &rhs) const
    {
      rhs = 0.;
      if (matrix)
        *matrix = 0.;
      for (const CellIndex c : discretization.visited_cells())
      {
        const auto             r = flatten(cell_residual(geometry_of(c), values_of(c), law));
        dealii::Vector<double> local(r.begin(), r.end());
        local *= -1.;
        if (load)
        {
          const auto forces = load(c);
          for (unsigned int i = 0; i < forces.size(); ++i)
            local(i) += forces[i];
        }
        if (matrix)
          constraints.distribute_local_to_global(
            matrix_of(c, law, linearisation), local, indices_of(c), *matrix, rhs);
        else
          constraints.distribute_local_to_global(local, indices_of(c), rhs);
      }
    }
  };
} // namespace retroforge
