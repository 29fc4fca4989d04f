// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/optimization/local_model.h>

namespace retroforge
{
  /// Planes before points that have failed, across the steps that led there. A model with them goes along an edge
  /// beyond which there are no values, where a smaller region alone would creep up to it.
  class Fences
  {
  public:
    using Vector = BoundedProblem::Vector;

    bool empty() const { return fences_.empty(); }
    void clear() { fences_.clear(); }
    /// A quarter of the way from a point to where it failed.
    void add(const Vector &x, const Vector &failed);
    /// Half-way to where they failed, those that a point has come to.
    void loosen(const Vector &x);
    /// As limits of a model.
    std::vector<PenaltyTerm> terms(const LocalModel &model) const;

  private:
    struct Fence
    {
      Vector across;     ///< of length 1
      double at, failed; ///< along it
    };

    std::vector<Fence> fences_;
  };
} // namespace retroforge
