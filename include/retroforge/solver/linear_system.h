// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/timer.h>
#include <retroforge/solver/stage.h>

#include <deal.II/lac/trilinos_block_sparse_matrix.h>
#include <deal.II/lac/trilinos_parallel_block_vector.h>

#include <memory>

namespace retroforge
{
  struct LinearSolverParameters
  {
    std::string  method         = "auto";
    unsigned int multigrid_from = 2500;
    unsigned int max_iterations = 600;
    unsigned int restart        = 120;

    void add_parameters(dealii::ParameterHandler &prm);
  };

  /// The axes a node's velocity is solved in: first the directions that are fixed, then those in which dies
  /// push.
  struct NodeFrame
  {
    dealii::Tensor<2, 3> axes; ///< orthonormal rows
    unsigned int         n_fixed  = 0;
    bool                 identity = true;

    Vec3 to_frame(const Vec3 &v) const { return identity ? v : axes * v; }
    Vec3 to_space(const Vec3 &v) const { return identity ? v : v * axes; }
  };

  /// Frames of all nodes: symmetry planes fix their normals, a die's normal becomes an axis of its own, so
  /// that the penalty stands on one diagonal entry whatever the die's orientation.
  std::vector<NodeFrame> make_frames(const Scene &scene, const ContactSet<double> &contact);

  /// Preconditioner of the velocity block, and of the Schur complement.
  class Preconditioner;

  /// The Newton matrix of a stage with bubbles condensed, in node frames and scaled:
  ///   [A B; B^T C] d = rhs.   It is symmetric: forward and transposed solve are one.
  ///
  /// Scaling: pressures by viscosity/edge, and each velocity component by (viscous/total diagonal)^(1/2),
  /// which takes penalty and friction off the residual's norm. A preconditioner is kept while it works.
  class LinearSystem
  {
  public:
    LinearSystem(const Scene &scene, const LinearSolverParameters &parameters, Timings &timings);
    ~LinearSystem();

    /// Matrix of `stage` at W; velocities fixed by symmetry are eliminated.
    void assemble(const Stage<double> &stage,
                  const Field<double> &W,
                  const ActiveSet     &active,
                  Linearisation        linearisation = Linearisation::newton);

    /// Solution of the uncondensed system for the right-hand side rhs (owned entries), to `tolerance`
    /// relative to the scaled right-hand side. Returns the number of Krylov iterations (0 for a direct
    /// solve). All ranks get all of it.
    /// @param guesses  fields, like the solutions of earlier systems, the best combination of which is the
    /// start
    unsigned int solve(const Field<double>              &rhs,
                       double                            tolerance,
                       Field<double>                    &solution,
                       const std::vector<Field<double>> &guesses = {});

    /// Forget the preconditioner: the next solve makes a new one.
    void reset();

    /// The scaled norm in which solves and Newton converge: of a residual's momentum rows, and of its
    /// continuity rows.
    std::pair<double, double> residual_norm(const Field<double> &r) const;

    const std::vector<NodeFrame> &frames() const { return frames_; }

    unsigned int n_solves = 0, n_iterations = 0;

  private:
    struct Block; // raw access to the rows of one block

    void make_pattern();
    void add_cell(CellIndex c, unsigned int visited, const TangentPack &tangent, unsigned int lane);
    /// Where a node stands in the row of an owned node, given by its local number.
    unsigned int position_of(unsigned int local_row, NodeIndex column) const;
    void         add_contact(const Stage<double> &stage, const Field<double> &W, const ActiveSet &active);
    void         scale_and_fix();
    void         make_preconditioner();
    void         load(const Field<double> &rhs, dealii::TrilinosWrappers::MPI::BlockVector &b) const;
    void         unload(const dealii::TrilinosWrappers::MPI::BlockVector &x, Field<double> &solution) const;
    void         load_guess(const Field<double> &guess, dealii::TrilinosWrappers::MPI::BlockVector &x) const;
    /// Sets x_ to the combination of the guesses with the least residual, and returns its norm.
    double       start_from(const std::vector<Field<double>> &guesses);
    unsigned int solve_iteratively(double tolerance, const std::vector<Field<double>> &guesses);
    /// Solves the rows of penalised components exactly, the others held: an error there that the norm hardly
    /// sees would decide which nodes a die pushes, because a contact force is the penalty times a small
    /// difference.
    void polish_penalised();
    /// d = A_II^(-1) r_I for the rows I of this rank, as well as a few steps of conjugate gradients can.
    void solve_rows(const std::vector<unsigned int> &rows, const double *r, std::vector<double> &d) const;
    void solve_directly();
    bool direct() const { return parameters_.method == "direct"; }

    const Scene                  &scene_;
    const LinearSolverParameters &parameters_;
    Timings                      &timings_;

    std::vector<NodeFrame>                 frames_;
    std::vector<double>                    scale_; ///< of each velocity component in its frame
    double                                 pressure_scale_ = 1.;
    std::vector<double>                    viscous_diagonal_;
    bool                                   edges_press_ = false; ///< penalties couple nodes
    std::vector<BubbleElimination<double>> eliminations_;        ///< of the visited cells
    std::vector<CellIndex>                 visited_index_;       ///< cell -> position in visited_cells

    std::vector<unsigned int> diagonal_; ///< where an owned node stands in its own row
    /// Of each visited cell: where node b stands in the row of node a (invalid_index when a is not owned).
    std::vector<std::array<std::array<unsigned int, 4>, 4>> positions_;

    dealii::TrilinosWrappers::BlockSparseMatrix matrix_;
    dealii::TrilinosWrappers::SparseMatrix      schur_;
    std::unique_ptr<Block>                      A_, B_, Bt_, C_, S_;
    dealii::TrilinosWrappers::MPI::BlockVector  rhs_, x_;
    std::unique_ptr<Preconditioner>             preconditioner_;
    double                                      first_rate_ = 0.; ///< iterations per decade when it was fresh
  };
} // namespace retroforge
