// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/element/bubble_search.h>
#include <retroforge/element/mini_element.templates.h>
#include <retroforge/element/mini_pack.templates.h>

namespace retroforge
{
  namespace
  {
    template <typename T, typename Law>
    RETROFORGE_INLINE void
    compute_state(const CellInput<T> &cell, const T (&grad_p)[3], const Law &law, BubbleState<3, T> &state)
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
        evaluate_potential_ratio(law, square(in.eps[a]), ratio);
        state.value += 2. * in.half[a] * ratio;
      }
      T block[3][3], inverse[3][3];
      bubble_block(in, is_linear(law), block);
      invert(block, inverse);
      for (unsigned int i = 0; i < 3; ++i)
        state.newton_step[i] = -dot(inverse[i], state.residual);
    }

    /// Not with fused multiplications: a cell has the same bubble, to the bit, by itself and in a pack.
    RETROFORGE_ALSO_FOR("avx")
    void compute_states(const CellInput<Pack> &cells,
                        const Pack (&grad_p)[3],
                        const LaneLaws       &laws,
                        BubbleState<3, Pack> &states)
    {
      compute_state(cells, grad_p, laws, states);
    }
  } // namespace

  Vec3 solve_bubble(const CellGeometry<double> &geometry,
                    const CellValues<double>   &w,
                    const MaterialLaw<double>  &law)
  {
    const Vec3             gradient  = pressure_gradient(geometry, w.P);
    const double           grad_p[3] = {gradient[0], gradient[1], gradient[2]};
    CellInput<double>      cell      = input_of(geometry, w.V, w.beta);
    BubbleState<3, double> state;
    BubbleSearch<3>        search(w.beta, w.V);
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
                                          const LaneLaws                                  &laws)
  {
    CellInput<Pack>                      cells = input_of(geometry, w);
    Pack                                 grad_p[3];
    std::array<BubbleSearch<3>, n_lanes> searches;
    for (unsigned int lane = 0; lane < n_lanes; ++lane)
    {
      const Vec3 gradient = pressure_gradient(geometry[lane], w[lane].P);
      for (unsigned int i = 0; i < 3; ++i)
        grad_p[i][lane] = gradient[i];
      searches[lane] = BubbleSearch<3>(w[lane].beta, w[lane].V);
    }
    BubbleState<3, Pack>   states;
    BubbleState<3, double> state;
    while (!std::all_of(searches.begin(), searches.end(), [](const auto &search) { return search.done(); }))
    {
      for (unsigned int lane = 0; lane < n_lanes; ++lane)
        for (unsigned int i = 0; i < 3; ++i)
          cells.beta[i][lane] = searches[lane].trial()[i];
      compute_states(cells, grad_p, laws, states);
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
