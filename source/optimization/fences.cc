// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/optimization/fences.h>
#include <retroforge/optimization/small_vectors.h>

#include <utility>

namespace retroforge
{
  void Fences::add(const Vector &x, const Vector &failed)
  {
    Fence        fence;
    const double reach = length(difference(failed, x));
    fence.across.assign(x.size(), 0.);
    retroforge::add(1. / reach, difference(failed, x), fence.across);
    constexpr double part = 0.25;
    fence.failed          = dot(fence.across, failed);
    fence.at              = fence.failed - (1. - part) * reach;
    fences_.push_back(std::move(fence));
  }

  void Fences::loosen(const Vector &x)
  {
    constexpr double near = 0.1; // of what is left to where it failed
    for (Fence &fence : fences_)
    {
      const double left = fence.failed - fence.at;
      if (dot(fence.across, x) > fence.at - near * left)
        fence.at += 0.5 * left;
    }
  }

  std::vector<PenaltyTerm> Fences::terms(const LocalModel &model) const
  {
    std::vector<PenaltyTerm> terms;
    for (const Fence &fence : fences_)
      terms.push_back({dot(fence.across, model.origin()) - fence.at,
                       fence.across,
                       model.stiff_against(fence.across),
                       true});
    return terms;
  }
} // namespace retroforge
