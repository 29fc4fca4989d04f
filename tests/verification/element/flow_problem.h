// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/trilinos_solver.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <retroforge/billet/billet.h>
#include <retroforge/discretization/element_pairs.h>
#include <retroforge/element/mini_element.templates.h>

#include <functional>
#include <memory>
#include <string>

/// Flows under a body force, with velocities given on the boundary: what the program itself never solves, put
/// together from its element kernels.
namespace retroforge
{
  /// A unit cube of metal, its mesh unstructured.
  inline TetMesh unit_cube(const double element_size)
  {
    BilletParameters parameters;
    parameters.base_centre  = Vec3();
    parameters.size         = Vec3({1., 1., 1.});
    parameters.element_size = element_size;
    return make_billet(parameters, MPI_COMM_SELF);
  }

  /// Mean edge of a regular tetrahedron of the cells' mean volume.
  inline double mean_edge(const TetMesh &mesh)
  {
    return std::cbrt(8.485 / mesh.n_cells());
  }

  /// The cell's equations with the bubble condensed; unknowns 4a+i (velocity) and 4a+3 (pressure) of node a.
  struct CellSystem
  {
    double matrix[16][16];
    double rhs[16];
  };

  inline CellSystem condensed_system(const CellTangent &t, CellValues<double> rhs)
  {
    CellSystem system;
    t.condense(rhs);
    for (unsigned int a = 0; a < 4; ++a)
    {
      for (unsigned int i = 0; i < 3; ++i)
        system.rhs[4 * a + i] = rhs.V[a][i];
      system.rhs[4 * a + 3] = rhs.P[a];
      for (unsigned int b = 0; b < 4; ++b)
      {
        for (unsigned int i = 0; i < 3; ++i)
        {
          for (unsigned int j = 0; j < 3; ++j)
            system.matrix[4 * a + i][4 * b + j] = t.A[a][b][i][j];
          system.matrix[4 * a + i][4 * b + 3] = t.B[a][b][i];
          system.matrix[4 * b + 3][4 * a + i] = t.B[a][b][i];
        }
        system.matrix[4 * a + 3][4 * b + 3] = t.C[a][b];
      }
    }
    return system;
  }

  /// The global equations, unknowns in node order, some of them held at zero.
  class NodalSystem
  {
  public:
    NodalSystem(const TetMesh &mesh, const std::vector<char> &fixed)
        : mesh_(mesh), fixed_(fixed), rhs_(fixed.size(), 0.)
    {
      dealii::DynamicSparsityPattern pattern(fixed.size(), fixed.size());
      for (const auto &nodes : mesh.cells)
      {
        const auto indices = unknowns(nodes);
        for (const auto i : indices)
          pattern.add_entries(i, indices.begin(), indices.end());
      }
      const dealii::IndexSet all = dealii::complete_index_set(fixed.size());
      matrix_.reinit(all, all, pattern, MPI_COMM_SELF);
      b_.reinit(all, MPI_COMM_SELF);
      x_.reinit(all, MPI_COMM_SELF);
    }

    void assemble(const std::function<CellSystem(CellIndex)> &cell_system)
    {
      matrix_ = 0.;
      std::fill(rhs_.begin(), rhs_.end(), 0.);
      for (CellIndex c = 0; c < mesh_.n_cells(); ++c)
      {
        CellSystem cell    = cell_system(c);
        const auto indices = unknowns(mesh_.cells[c]);
        for (unsigned int r = 0; r < 16; ++r)
          for (unsigned int s = 0; s < 16; ++s)
            if (fixed_[indices[r]] || fixed_[indices[s]])
              cell.matrix[r][s] = 0.;
        for (unsigned int r = 0; r < 16; ++r)
        {
          matrix_.add(indices[r], 16, indices.data(), cell.matrix[r], false);
          rhs_[indices[r]] += fixed_[indices[r]] ? 0. : cell.rhs[r];
        }
      }
      for (dealii::types::global_dof_index i = 0; i < fixed_.size(); ++i)
        if (fixed_[i])
          matrix_.add(i, i, 1.);
      matrix_.compress(dealii::VectorOperation::add);
      solver_ = std::make_unique<dealii::TrilinosWrappers::SolverDirect>(
        control_, dealii::TrilinosWrappers::SolverDirect::AdditionalData(false, "Amesos_Mumps"));
      solver_->initialize(matrix_);
    }

    std::vector<double> solve(const std::vector<double> &rhs)
    {
      for (unsigned int i = 0; i < rhs.size(); ++i)
        b_.trilinos_vector()[0][i] = fixed_[i] ? 0. : rhs[i];
      solver_->solve(x_, b_);
      return std::vector<double>(x_.trilinos_vector()[0], x_.trilinos_vector()[0] + rhs.size());
    }

    /// For the right-hand side assembled with the matrix.
    std::vector<double> solve() { return solve(rhs_); }

  private:
    using Indices = std::array<dealii::types::global_dof_index, 16>;

    static Indices unknowns(const std::array<NodeIndex, 4> &nodes)
    {
      Indices indices;
      for (unsigned int a = 0; a < 4; ++a)
        for (unsigned int i = 0; i < 4; ++i)
          indices[4 * a + i] = 4 * nodes[a] + i;
      return indices;
    }

    const TetMesh                                          &mesh_;
    const std::vector<char>                                 fixed_;
    std::vector<double>                                     rhs_;
    dealii::TrilinosWrappers::SparseMatrix                  matrix_;
    dealii::TrilinosWrappers::MPI::Vector                   b_, x_;
    dealii::SolverControl                                   control_;
    std::unique_ptr<dealii::TrilinosWrappers::SolverDirect> solver_;
  };

  /// Holds the velocity on all patches but `free_patch`.
  inline std::vector<char> held_velocities(const TetMesh &mesh, const std::string &free_patch)
  {
    std::vector<char> fixed(4 * mesh.n_nodes(), 0);
    for (const BoundaryFace &face : mesh.faces)
      if (mesh.patches[face.patch].name != free_patch)
        for (const NodeIndex k : face.nodes)
          std::fill_n(fixed.begin() + 4 * k, 3, 1);
    return fixed;
  }

  /// Points of one sub-tetrahedron after the other, exact for polynomials of degree 5 on each of them.
  struct SubCellPoint
  {
    Four<double> lambda; ///< barycentric coordinates in the cell
    double       bubble; ///< value of the hat
    unsigned int sub;    ///< the sub-tetrahedron it is on
    double       weight; ///< fraction of the cell's volume

    Vec3 position(const Four<Vec3> &X) const
    {
      return lambda[0] * X[0] + lambda[1] * X[1] + lambda[2] * X[2] + lambda[3] * X[3];
    }
  };

  inline std::vector<SubCellPoint> sub_cell_points()
  {
    const dealii::QGaussSimplex<3> rule(3);
    std::vector<SubCellPoint>      points;
    for (unsigned int a = 0; a < 4; ++a)
      for (unsigned int q = 0; q < rule.size(); ++q)
      {
        const auto        &x  = rule.point(q);
        const Four<double> mu = {{1. - x[0] - x[1] - x[2], x[0], x[1], x[2]}};
        SubCellPoint       point{{}, mu[a], a, 1.5 * rule.weight(q)};
        for (unsigned int c = 0; c < 4; ++c)
          point.lambda[c] = (c == a ? 0. : mu[c]) + 0.25 * mu[a];
        points.push_back(point);
      }
    return points;
  }
} // namespace retroforge
