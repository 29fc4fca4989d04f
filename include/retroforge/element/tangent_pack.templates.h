// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/processors.h>
#include <retroforge/element/tangent_pack.h>

/// @file
/// One source for one cell (T = double) and for a pack of cells (T = Pack).
namespace retroforge
{
  /// Calls f(entry of pack, entry of one lane) for all entries, which must be doubles in the same order.
  template <typename Blocks, typename One, typename F>
  RETROFORGE_INLINE void for_each_entry(Blocks &pack, One &one, const F &f)
  {
    static_assert(sizeof(Blocks) == n_lanes * sizeof(One), "a pack must hold the same entries");
    auto *p = reinterpret_cast<double *>(&pack);
    auto *x = reinterpret_cast<double *>(&one);
    for (unsigned int k = 0; k < sizeof(One) / sizeof(double); ++k)
      f(p[n_lanes * k], x[k]);
  }

  /// y = e g  of a symmetric tensor
  template <typename T>
  RETROFORGE_INLINE void eps_times_g(const T (&e)[6], const T (&g)[3], T (&y)[3])
  {
    y[0] = e[0] * g[0] + e[5] * g[1] + e[4] * g[2];
    y[1] = e[5] * g[0] + e[1] * g[1] + e[3] * g[2];
    y[2] = e[4] * g[0] + e[3] * g[1] + e[2] * g[2];
  }

  /// e:e
  template <typename T>
  RETROFORGE_INLINE T square(const T (&e)[6])
  {
    return e[0] * e[0] + e[1] * e[1] + e[2] * e[2] + 2. * (e[3] * e[3] + e[4] * e[4] + e[5] * e[5]);
  }

  template <typename T>
  RETROFORGE_INLINE T dot(const T (&a)[3], const T (&b)[3])
  {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }

  /// Stress factor and d log(factor)/d(eps:eps), of one cell or lane by lane.
  RETROFORGE_INLINE void
  evaluate_law(const MaterialLaw<double> &law, const double &eps2, double &factor, double &slope)
  {
    factor = law(eps2);
    slope  = law.slope(eps2);
  }

  RETROFORGE_INLINE void evaluate_law(const LaneLaws &laws, const Pack &eps2, Pack &factor, Pack &slope)
  {
    for (unsigned int lane = 0; lane < n_lanes; ++lane)
    {
      factor[lane] = laws[lane](eps2[lane]);
      slope[lane]  = laws[lane].slope(eps2[lane]);
    }
  }

  /// The law's potential over its factor.
  RETROFORGE_INLINE void
  evaluate_potential_ratio(const MaterialLaw<double> &law, const double &eps2, double &ratio)
  {
    ratio = law.potential_ratio(eps2);
  }

  RETROFORGE_INLINE void evaluate_potential_ratio(const LaneLaws &laws, const Pack &eps2, Pack &ratio)
  {
    for (unsigned int lane = 0; lane < n_lanes; ++lane)
      ratio[lane] = laws[lane].potential_ratio(eps2[lane]);
  }
} // namespace retroforge
