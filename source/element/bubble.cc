// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/element/mini_element.templates.h>
#include <retroforge/element/mini_pack.templates.h>

namespace retroforge
{
  namespace
  {
    /// The functional of a cell as a function of its bubble alone, its gradient, and Newton's step.
    template <typename T>
    struct BubbleState
    {
      T value, residual[3], newton_step[3];
    };

    template <typename T>
    RETROFORGE_INLINE void compute_state(const CellInput<T> &cell,
                                         const T (&grad_p)[3],
                                         const MaterialLaw<double> &law,
                                         BubbleState<T>            &state)
    {
      TangentInput<T> in;
      fill(cell, law, in);
      for (unsigned int i = 0; i < 3; ++i)
        state.residual[i] = 0.25 * cell.volume * grad_p[i];
      state.value = dot(state.residual, cell.beta);
      for (unsigned int a = 0; a < 4; ++a)
      {
        T y[3], ratio;
        eps_times_g(in.eps[a], in.g[a], y);
        for (unsigned int i = 0; i < 3; ++i)
          state.residual[i] += 8. * in.half[a] * y[i];
        ask_potential_ratio(law, square(in.eps[a]), ratio);
        state.value += 2. * in.half[a] * ratio;
      }
      T block[3][3], inverse[3][3];
      bubble_block(in, law.is_linear(), block);
      invert(block, inverse);
      for (unsigned int i = 0; i < 3; ++i)
        state.newton_step[i] = -dot(inverse[i], state.residual);
    }

    /// Not with fused multiplications: a cell has the same bubble, to the bit, by itself and in a pack.
    RETROFORGE_ALSO_FOR("avx")
    void compute_states(const CellInput<Pack> &cells,
                        const Pack (&grad_p)[3],
                        const MaterialLaw<double> &law,
                        BubbleState<Pack>         &states)
    {
      compute_state(cells, grad_p, law, states);
    }

    Vec3 vector(const double (&x)[3])
    {
      return Vec3({x[0], x[1], x[2]});
    }

    /// Newton's method for the bubble of one cell, with a search along each step: says where it wants to know
    /// the state, is told, and goes on. So cells of a pack need not go on alike.
    class BubbleSearch
    {
    public:
      BubbleSearch() = default;
      BubbleSearch(const CellValues<double> &w) : beta_(w.beta), trial_(w.beta)
      {
        for (unsigned int c = 1; c < 4; ++c)
          spread_ += (w.V[c] - w.V[0]).norm();
      }

      bool        done() const { return done_; }
      const Vec3 &beta() const { return beta_; }
      /// Where the state is wanted.
      const Vec3 &trial() const { return trial_; }

      void take(const BubbleState<double> &state)
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
        step_      = vector(state.newton_step);
        decrement_ = -(step_ * vector(state.residual));
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

      Vec3         beta_, trial_, step_;
      double       spread_ = 0., value_ = 0., decrement_ = 0., scale_ = 1.;
      unsigned int n_steps_ = 0;
      bool         first_ = true, done_ = false;
    };
  } // namespace

  Vec3 solve_bubble(const CellGeometry<double> &geometry,
                    const CellValues<double>   &w,
                    const MaterialLaw<double>  &law)
  {
    const Vec3          gradient  = pressure_gradient(geometry, w.P);
    const double        grad_p[3] = {gradient[0], gradient[1], gradient[2]};
    CellInput<double>   cell      = input_of(geometry, w.V, w.beta);
    BubbleState<double> state;
    BubbleSearch        search(w);
    while (!search.done())
    {
      for (unsigned int i = 0; i < 3; ++i)
        cell.beta[i] = search.trial()[i];
      compute_state(cell, grad_p, law, state);
      search.take(state);
    }
    return search.beta();
  }

  std::array<Vec3, n_lanes> solve_bubbles(const std::array<CellGeometry<double>, n_lanes> &geometry,
                                          const std::array<CellValues<double>, n_lanes>   &w,
                                          const MaterialLaw<double>                       &law)
  {
    CellInput<Pack>                   cells = input_of(geometry, w);
    Pack                              grad_p[3];
    std::array<BubbleSearch, n_lanes> searches;
    for (unsigned int lane = 0; lane < n_lanes; ++lane)
    {
      const Vec3 gradient = pressure_gradient(geometry[lane], w[lane].P);
      for (unsigned int i = 0; i < 3; ++i)
        grad_p[i][lane] = gradient[i];
      searches[lane] = BubbleSearch(w[lane]);
    }
    BubbleState<Pack>   states;
    BubbleState<double> state;
    while (!std::all_of(searches.begin(), searches.end(), [](const auto &search) { return search.done(); }))
    {
      for (unsigned int lane = 0; lane < n_lanes; ++lane)
        for (unsigned int i = 0; i < 3; ++i)
          cells.beta[i][lane] = searches[lane].trial()[i];
      compute_states(cells, grad_p, law, states);
      for (unsigned int lane = 0; lane < n_lanes; ++lane)
        if (!searches[lane].done())
        {
          for_each_entry(states, state, [lane](const double &p, double &x) { x = (&p)[lane]; });
          searches[lane].take(state);
        }
    }
    std::array<Vec3, n_lanes> beta;
    for (unsigned int lane = 0; lane < n_lanes; ++lane)
      beta[lane] = searches[lane].beta();
    return beta;
  }
} // namespace retroforge
