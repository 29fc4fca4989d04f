// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/linear_algebra/types.h>

#include <functional>
#include <vector>

namespace retroforge
{
  /// y = F x
  using BlockOperator = std::function<void(la::BlockVector &y, const la::BlockVector &x)>;

  /// The iterations that a Krylov method took, and whether they have reached the tolerance.
  struct KrylovResult
  {
    unsigned int iterations = 0;
    bool         converged  = false;
  };

  /// Directions Z of solves and what the matrix makes of them, W = M Z: what other right-hand sides of the
  /// same matrix need not find again [deSturler1996]. The images of one solve are orthogonal to those of others.
  class KrylovSpace
  {
  public:
    struct Basis;

    /// @param room  number of solves whose directions it takes
    explicit KrylovSpace(unsigned int room = 1);
    KrylovSpace(KrylovSpace &&) noexcept;
    ~KrylovSpace();

    bool empty() const;
    bool is_full() const;

    /// x += Z y,  r -= W y  with the y that leaves the least of the residual r.
    void reduce(la::BlockVector &x, la::BlockVector &r) const;

    /// Of each solve.
    const std::vector<Basis> &bases() const { return bases_; }

    void add(Basis basis);

  private:
    unsigned int       room_;
    std::vector<Basis> bases_;
  };

  /// Solves M x = b by flexible GMRES [Saad1993], Belos' of Trilinos: P, which approximates M^(-1), may change
  /// from one application to the next. Directions are orthogonalised against all others at once, and then once
  /// more. Collective; the same bits on the same number of ranks.
  /// @param x          where it starts, and the last iterate, converged or not; unchanged where numbers have
  ///                   left their range. Zero where the space has anything already
  /// @param tolerance  of the residual's norm, as the iteration itself knows it
  /// @param limit      of the number of iterations
  /// @param restart    directions that are kept
  /// @param space      directions that are orthogonal in their images to what it has are looked for, and where there
  ///                   is room the last of them are added. Of b it must have taken what it can
  KrylovResult solve_by_flexible_gmres(const BlockOperator   &M,
                                       const BlockOperator   &P,
                                       const la::BlockVector &b,
                                       la::BlockVector       &x,
                                       double                 tolerance,
                                       unsigned int           limit,
                                       unsigned int           restart,
                                       KrylovSpace           *space = nullptr);
} // namespace retroforge
