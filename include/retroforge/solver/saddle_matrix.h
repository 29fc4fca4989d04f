// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/solver/cell_tangent_assembler.h>
#include <retroforge/solver/node_frames.h>

namespace retroforge
{
  /// A saddle point system  [A B; D C] x = b  of velocities and pressures, as solvers see it.
  struct SaddleSystem
  {
    la::BlockSparseMatrix       matrix;
    la::SparseMatrix            schur; ///< positive, and much like D A^(-1) B - C
    std::unique_ptr<NodeMatrix> A, B, D, C, S;
    bool symmetric = true; ///< D = B^T, and A and C are symmetric: friction has a potential
    /// Rows of A in which a penalty dwarfs all else, by local number, ascending.
    std::vector<unsigned int> penalised;
    bool                      penalties_couple = false; ///< some of these rows share entries
    /// Products of vectors of A's local rows and columns that count as added to A, entry by entry, though they
    /// are kept apart: row_j x column_j. What holds a workpiece is felt by all of it.
    std::vector<std::pair<la::Vector, la::Vector>> held;
    /// Rigid translations as vectors of A's local rows, one after the other; zero in penalised rows.
    std::vector<double> translations;
    /// Interpolation from linear velocities to those of A, without penalised rows. P is null where A's
    /// velocities are linear.
    la::SparseMatrix            interpolation;
    std::unique_ptr<NodeMatrix> P;
  };

  /// The Newton matrix of a stage with bubbles condensed, in node frames and scaled: the fields of the
  /// program on one side, the unknowns of a SaddleSystem on the other. It is symmetric where the laws derive
  /// from potentials, as that of the metal does. Where friction follows the normal force, momentum is tested
  /// along other directions than the velocities' axes (NodeFrame), so that each penalty stands in one row and
  /// one column all the same; then unknowns of the transposed system are tested momentum.
  ///
  /// Scaling: pressures by viscosity/edge, and each velocity component by (viscous/total diagonal)^(1/2),
  /// which takes penalty and friction off the residual's norm.
  class SaddleMatrix
  {
  public:
    explicit SaddleMatrix(const Scene &scene);

    /// Matrix of `stage` at W; velocities fixed by symmetry are eliminated.
    void assemble(const Equilibrium<double> &stage,
                  const Field<double>       &W,
                  const ActiveChoice        &active,
                  Linearisation              linearisation);

    const SaddleSystem &system() const { return system_; }

    /// A vector of the system, zero.
    la::BlockVector vector() const;

    /// The system's right-hand side for that of the uncondensed one (owned entries).
    void load(const Field<double> &rhs, Transposition transposition, la::BlockVector &b) const;
    /// Velocities and pressures as unknowns.
    void load_guess(const Field<double> &guess, Transposition transposition, la::BlockVector &x) const;
    /// The solution of the uncondensed system from that of the condensed one: what this rank works with
    /// and ghosts.
    void unload(const la::BlockVector &x,
                const Field<double>   &rhs,
                Transposition          transposition,
                Field<double>         &solution) const;

    /// The scaled norm of a residual's momentum rows, and of its continuity rows.
    std::pair<double, double> residual_norm(const Field<double> &r) const;

  private:
    /// Contribution of contact to the entries of a pair of velocity nodes, in their frames.
    struct ContactEntries
    {
      unsigned int         row, column; ///< places of nodes
      dealii::Tensor<2, 3> tangent;
    };

    void make_patterns();
    void make_interpolation_pattern(const MiddleNodes &middles);
    /// Returns the diagonal of A's local rows, from cells alone.
    std::vector<double> viscous_diagonal() const;
    /// Computes the entries of owned rows, and sets SaddleSystem::penalties_couple.
    std::vector<ContactEntries>
    contact_entries(const Equilibrium<double> &stage, const Field<double> &W, const ActiveSet &active);
    /// Chooses the tests of owned nodes, and has contact's rows along them.
    void test_contact(std::vector<ContactEntries> &contact);
    void choose_scales(const std::vector<double> &viscous, const std::vector<ContactEntries> &contact);
    /// The sums over cells, in frames and scaled.
    void write_cell_tangents();
    void add_contact(const std::vector<ContactEntries> &contact) const;
    /// Fixed components have scale zero in their rows and columns, and their diagonals afterwards.
    void put_diagonals_of_fixed(const std::vector<double> &viscous) const;
    /// Penalised rows and translations.
    void describe_rows();
    /// The hold's share of the matrix.
    void describe_hold(const Equilibrium<double> &stage);
    void fill_interpolation();
    /// Cells with a bubble to eliminate, among the visited ones.
    unsigned int n_eliminated() const;
    /// Assert that the matrix is assembled, and that what it is to work on belongs to it.
    void check_field(const Field<double> &field) const;
    void check_vector(const la::BlockVector &x) const;
    /// A right-hand side whose bubbles are eliminated; right on owned nodes.
    Field<double> condensed(const Field<double> &rhs) const;

    const Scene                          &scene_;
    const NodeNumbering                  &velocities_, &pressures_; ///< nodes of matrices
    SaddleSystem                          system_;
    std::vector<NodeFrame>                frames_;        ///< frames of the velocity nodes, by place
    NodeVector<3, double>                 scale_;         ///< scale of each velocity component in its frame
    NodeVector<3, double>                 unknown_scale_; ///< the same, zero where it is fixed
    double                                pressure_scale_ = 1.;
    std::unique_ptr<CellTangentAssembler> cell_tangents_;
    std::vector<unsigned int> column_places_; ///< places of the nodes of A's columns, as A numbers them
    std::vector<unsigned int> diagonal_;      ///< position of an owned node in its own row
  };
} // namespace retroforge
