// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/trilinos_solver.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <retroforge/billet/billet.h>
#include <retroforge/discretization/element_pairs.h>
#include <retroforge/element/mini_element.templates.h>
#include <retroforge/element/taylor_hood.templates.h>

#include <algorithm>
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

  /// Numbers of the unknowns of a mesh: velocities 3k + i of velocity node k, then pressures. A bubble has
  /// none.
  class Unknowns
  {
  public:
    using Indices = std::vector<dealii::types::global_dof_index>;

    explicit Unknowns(const Discretization<3> &discretization) : discretization_(discretization) {}

    unsigned int size() const { return first_pressure() + discretization_.n_vertices(); }
    unsigned int velocity(const NodeIndex k, const unsigned int i) const { return 3 * k + i; }
    unsigned int pressure(const NodeIndex k) const { return first_pressure() + k; }

    /// Of a cell, in the same order.
    Indices of_cell(const CellIndex c) const
    {
      // On one rank places are numbers of nodes.
      const unsigned int *nodes = discretization_.velocity_places(c);
      const unsigned int  n     = discretization_.n_nodes_per_cell();
      Indices             indices;
      for (unsigned int a = 0; a < n; ++a)
        for (unsigned int i = 0; i < 3; ++i)
          indices.push_back(velocity(nodes[a], i));
      for (unsigned int a = 0; a < 4; ++a)
        indices.push_back(pressure(nodes[a]));
      return indices;
    }

  private:
    unsigned int first_pressure() const { return 3 * discretization_.condensed_nodes()->n(); }

    const Discretization<3> &discretization_;
  };

  /// The cell's equations, unknowns as Unknowns::of_cell.
  struct CellSystem
  {
    dealii::FullMatrix<double> matrix;
    std::vector<double>        rhs;

    explicit CellSystem(const unsigned int n_velocity_nodes)
        : matrix(3 * n_velocity_nodes + 4), rhs(3 * n_velocity_nodes + 4, 0.)
    {
    }
  };

  /// Second derivatives of a cell's functional.
  inline CellTangent
  tangent_of(const CellGeometry<double> &geometry, const CellValues<double> &w, const NortonHoff<double> &law)
  {
    CellTangent t;
    compute_cell_tangent(geometry, w, law, t);
    return t;
  }

  inline TaylorHoodTangent tangent_of(const CellGeometry<double>     &geometry,
                                      const TaylorHoodValues<double> &w,
                                      const NortonHoff<double>       &law)
  {
    TaylorHoodTangent t;
    compute_cell_tangent(geometry, w, law, Linearisation::newton, t);
    return t;
  }

  /// That of blocks A and B, and of what V and P hold.
  template <typename Tangent, typename Values>
  CellSystem system_of_blocks(const Tangent &t, const Values &rhs)
  {
    const unsigned int n = rhs.V.size();
    CellSystem         system(n);
    for (unsigned int a = 0; a < n; ++a)
      for (unsigned int i = 0; i < 3; ++i)
      {
        system.rhs[3 * a + i] = rhs.V[a][i];
        for (unsigned int b = 0; b < n; ++b)
          for (unsigned int j = 0; j < 3; ++j)
            system.matrix(3 * a + i, 3 * b + j) = t.A[a][b][i][j];
        for (unsigned int b = 0; b < 4; ++b)
          system.matrix(3 * a + i, 3 * n + b) = system.matrix(3 * n + b, 3 * a + i) = t.B[a][b][i];
      }
    for (unsigned int a = 0; a < 4; ++a)
      system.rhs[3 * n + a] = rhs.P[a];
    return system;
  }

  inline CellSystem cell_system(const TaylorHoodTangent &t, const TaylorHoodValues<double> &rhs)
  {
    return system_of_blocks(t, rhs);
  }

  /// With the bubble condensed.
  inline CellSystem cell_system(const CellTangent &t, CellValues<double> rhs)
  {
    t.condense(rhs);
    CellSystem system = system_of_blocks(t, rhs);
    for (unsigned int a = 0; a < 4; ++a)
      for (unsigned int b = 0; b < 4; ++b)
        system.matrix(12 + a, 12 + b) = t.C[a][b];
    return system;
  }

  /// The global equations, some of the unknowns held at zero.
  class GlobalSystem
  {
  public:
    GlobalSystem(const TetMesh &mesh, const Unknowns &unknowns, const std::vector<char> &fixed)
        : n_cells_(mesh.n_cells()), unknowns_(unknowns), fixed_(fixed), rhs_(fixed.size(), 0.)
    {
      dealii::DynamicSparsityPattern pattern(fixed.size(), fixed.size());
      for (CellIndex c = 0; c < n_cells_; ++c)
      {
        Unknowns::Indices indices = unknowns_.of_cell(c);
        std::sort(indices.begin(), indices.end());
        for (const auto i : indices)
          pattern.add_entries(i, indices.begin(), indices.end(), true);
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
      for (CellIndex c = 0; c < n_cells_; ++c)
      {
        CellSystem         cell    = cell_system(c);
        const auto         indices = unknowns_.of_cell(c);
        const unsigned int n       = indices.size();
        for (unsigned int r = 0; r < n; ++r)
          for (unsigned int s = 0; s < n; ++s)
            if (fixed_[indices[r]] || fixed_[indices[s]])
              cell.matrix(r, s) = 0.;
        matrix_.add(indices, cell.matrix, false);
        for (unsigned int r = 0; r < n; ++r)
          rhs_[indices[r]] += fixed_[indices[r]] ? 0. : cell.rhs[r];
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
    CellIndex                                               n_cells_;
    const Unknowns                                         &unknowns_;
    const std::vector<char>                                 fixed_;
    std::vector<double>                                     rhs_;
    dealii::TrilinosWrappers::SparseMatrix                  matrix_;
    dealii::TrilinosWrappers::MPI::Vector                   b_, x_;
    dealii::SolverControl                                   control_;
    std::unique_ptr<dealii::TrilinosWrappers::SolverDirect> solver_;
  };

  /// Velocity nodes of a face of the boundary: its corners, then the middles of its edges where there are
  /// any.
  inline std::vector<NodeIndex> velocity_nodes_of_face(const TetMesh           &mesh,
                                                       const Discretization<3> &discretization,
                                                       const unsigned int       face)
  {
    const auto            &corners = mesh.faces[face].nodes;
    std::vector<NodeIndex> nodes(corners.begin(), corners.end());
    if (const MiddleNodes *middles = discretization.middles())
      for (unsigned int i = 0; i < 3; ++i)
        nodes.push_back(middles->between(corners[i], corners[(i + 1) % 3]));
    return nodes;
  }

  /// Holds the velocity on all patches but `free_patch`.
  inline std::vector<char>
  held_velocities(const TetMesh &mesh, const Discretization<3> &discretization, const std::string &free_patch)
  {
    const Unknowns    unknowns(discretization);
    std::vector<char> fixed(unknowns.size(), 0);
    for (unsigned int f = 0; f < mesh.faces.size(); ++f)
      if (mesh.patches[mesh.faces[f].patch].name != free_patch)
        for (const NodeIndex k : velocity_nodes_of_face(mesh, discretization, f))
          for (unsigned int i = 0; i < 3; ++i)
            fixed[unknowns.velocity(k, i)] = 1;
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

  /// Values of a pair's velocity functions, in the order of its unknowns; the bubble comes last.
  inline std::vector<double> velocity_functions(MiniPair, const SubCellPoint &at)
  {
    return {at.lambda[0], at.lambda[1], at.lambda[2], at.lambda[3], at.bubble};
  }

  inline std::vector<double> velocity_functions(TaylorHoodPair, const SubCellPoint &at)
  {
    std::vector<double> values;
    for (const double l : at.lambda)
      values.push_back(l * (2. * l - 1.));
    for (const auto &[a, b] : tet_edge_corners)
      values.push_back(4. * at.lambda[a] * at.lambda[b]);
    return values;
  }

  /// And their gradients.
  inline std::vector<Vec3>
  velocity_gradients(MiniPair, const CellGeometry<double> &geometry, const SubCellPoint &at)
  {
    const auto &g = geometry.g;
    return {g[0], g[1], g[2], g[3], 4. * g[at.sub]};
  }

  inline std::vector<Vec3>
  velocity_gradients(TaylorHoodPair, const CellGeometry<double> &geometry, const SubCellPoint &at)
  {
    const auto       &g = geometry.g;
    std::vector<Vec3> values;
    for (unsigned int a = 0; a < 4; ++a)
      values.push_back((4. * at.lambda[a] - 1.) * g[a]);
    for (const auto &[a, b] : tet_edge_corners)
      values.push_back(4. * (at.lambda[a] * g[b] + at.lambda[b] * g[a]));
    return values;
  }

  /// The vector that multiplies a velocity function.
  inline Vec3 &coefficient(CellValues<double> &w, const unsigned int function)
  {
    return function < 4 ? w.V[function] : w.beta;
  }

  inline Vec3 &coefficient(TaylorHoodValues<double> &w, const unsigned int function)
  {
    return w.V[function];
  }

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
