// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/base/array_view.h>
#include <deal.II/base/tensor.h>

#include <cmath>

namespace retroforge
{
  /// The functional of a cell as a function of its bubble alone, its gradient, and Newton's step.
  template <int dim, typename T>
  struct BubbleState
  {
    T value, residual[dim], newton_step[dim];
  };

  /// Newton's method for the bubble of one cell, with a search along each step: says where it wants to know
  /// the state, is told, and goes on. So cells of a pack need not go on alike.
  template <int dim>
  class BubbleSearch
  {
  public:
    using Vector = dealii::Tensor<1, dim>;

    BubbleSearch() = default;
    /// @param V  velocities of the nodes, whose differences are the scale
    template <typename Velocities>
    BubbleSearch(const Vector &start, const Velocities &V) : beta_(start), trial_(start)
    {
      for (unsigned int c = 1; c < V.size(); ++c)
        spread_ += (V[c] - V[0]).norm();
    }

    bool          done() const { return done_; }
    const Vector &beta() const { return beta_; }
    /// Returns the bubble at which the state is wanted.
    const Vector &trial() const { return trial_; }

    void take(const BubbleState<dim, double> &state)
    {
      if (!first_ && scale_ > 1e-4 &&
          state.value > value_ - 1e-4 * scale_ * decrement_ + 1e-14 * std::abs(value_))
      {
        scale_ *= 0.5;
        trial_ = beta_ + scale_ * step_;
        return;
      }
      beta_      = trial_;
      value_     = state.value;
      step_      = Vector(dealii::make_array_view(state.newton_step, state.newton_step + dim));
      decrement_ = -(step_ * Vector(dealii::make_array_view(state.residual, state.residual + dim)));
      scale_     = 1.;
      trial_     = beta_ + step_;
      first_     = false;
      // Convergence is quadratic: the error left by so small a step is below rounding.
      const bool small = step_.norm() <= 1e-9 * beta_.norm() + 1e-16 * spread_;
      done_            = !(decrement_ > 0.) || small || n_steps_++ == most_steps;
      if (decrement_ > 0. && small)
        beta_ = trial_;
    }

  private:
    static constexpr unsigned int most_steps = 60;

    Vector       beta_, trial_, step_;
    double       spread_ = 0., value_ = 0., decrement_ = 0., scale_ = 1.;
    unsigned int n_steps_ = 0;
    bool         first_ = true, done_ = false;
  };
} // namespace retroforge
