// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/element/mini_element.h>
#include <retroforge/linear_algebra/node_matrix.h>
#include <retroforge/solver/node_frames.h>

#include <cstdint>

namespace retroforge
{
  /// A saddle point system  [A B; D C] x = b  of velocities and pressures, as solvers see it.
  struct SaddleSystem
  {
    la::BlockSparseMatrix       matrix;
    la::SparseMatrix            schur; ///< positive, and much like D A^(-1) B - C
    std::unique_ptr<NodeMatrix> A, B, D, C, S;
    bool                        symmetric = true; ///< D = B^T, and A and C are symmetric
    /// Rows of A in which a penalty dwarfs all else, by local number, ascending.
    std::vector<unsigned int> penalised;
    bool                      penalties_couple = false; ///< some of these rows share entries
    /// Rigid translations as vectors of A's local rows, one after the other; zero in penalised rows.
    std::vector<double> translations;
    /// From linear velocities to those of A; not of penalised rows. P is null where A's are linear.
    la::SparseMatrix            interpolation;
    std::unique_ptr<NodeMatrix> P;
  };

  /// The Newton matrix of a stage with bubbles condensed, in node frames and scaled: the fields of the
  /// program on one side, the unknowns of a SaddleSystem on the other. The laws derive from potentials: it is
  /// symmetric.
  ///
  /// Scaling: pressures by viscosity/edge, and each velocity component by (viscous/total diagonal)^(1/2),
  /// which takes penalty and friction off the residual's norm.
  class SaddleMatrix
  {
  public:
    explicit SaddleMatrix(const Scene &scene);

    /// Matrix of `stage` at W; velocities fixed by symmetry are eliminated.
    void assemble(const Stage<double> &stage,
                  const Field<double> &W,
                  const ActiveSet     &active,
                  Linearisation        linearisation);

    const SaddleSystem &system() const { return system_; }

    /// A vector of the system, zero.
    la::BlockVector vector() const;

    /// The system's right-hand side for that of the uncondensed one (owned entries).
    void load(const Field<double> &rhs, la::BlockVector &b) const;
    /// Velocities and pressures as unknowns.
    void load_guess(const Field<double> &guess, la::BlockVector &x) const;
    /// The solution of the uncondensed system from that of the condensed one: what this rank works with
    /// (FieldExchange).
    void unload(const la::BlockVector &x, const Field<double> &rhs, Field<double> &solution) const;

    /// The scaled norm of a residual's momentum rows, and of its continuity rows.
    std::pair<double, double> residual_norm(const Field<double> &r) const;

  private:
    /// Where a column node stands in the row of another.
    using Place = std::uint16_t;

    void make_patterns();
    void make_interpolation_pattern(const MeshEdges &edges);
    void make_positions();
    /// Sums over cells; sets pressure_scale_.
    void add_cells(const Stage<double> &stage, const Field<double> &W, Linearisation linearisation);
    template <typename Tangents>
    void add_cell(unsigned int visited, const Tangents &tangents, unsigned int lane);
    /// @return what it adds to the diagonal of A's local rows
    std::vector<double>
    add_contact(const Stage<double> &stage, const Field<double> &W, const ActiveSet &active);
    /// Of a local row of A.
    double &diagonal_entry(unsigned int row) const;
    void    scale_and_fix(const std::vector<double> &viscous_diagonal);
    /// Penalised rows and translations.
    void describe_rows();
    void fill_interpolation();
    /// A right-hand side whose bubbles are eliminated; right on owned nodes.
    Field<double> condensed(const Field<double> &rhs) const;

    const Scene                           &scene_;
    const Ownership                       &velocities_, &pressures_;
    SaddleSystem                           system_;
    std::vector<NodeFrame>                 frames_; ///< of each velocity node
    std::vector<double>                    scale_;  ///< of each velocity component in its frame
    double                                 pressure_scale_ = 1.;
    std::vector<BubbleElimination<double>> eliminations_; ///< of the visited cells; empty without bubbles
    std::vector<unsigned int>              diagonal_;     ///< where an owned node stands in its own row
    /// Of each visited cell, for n velocity nodes: n x n places in rows of A, n x 4 of B, 4 x n of D, 4 x 4
    /// of C; zero in rows of other ranks.
    std::vector<Place> places_;
    unsigned int       places_per_cell_ = 0;
  };
} // namespace retroforge
