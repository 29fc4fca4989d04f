// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/contact/contact_kinematics.h>

#include <algorithm>
#include <array>
#include <tuple>
#include <vector>

/// @file
/// The ramps of friction, written once more and differentiated by dual numbers.
namespace retroforge
{
  /// Derivatives in gaps and in parts of the ramp's width.
  struct RampsBar
  {
    std::vector<double> gaps, scales;
  };

  /// From those in the ramps that count, by one dual number after another.
  inline RampsBar reverse_ramps(const ContactSet<double>  &contact,
                                const FrictionRamp        &ramp,
                                const std::vector<double> &ramps_bar,
                                const bool                 with_edges)
  {
    const auto       &pairs = contact.pairs;
    const std::size_t n     = pairs.size();
    RampsBar          sum{std::vector<double>(n, 0.), std::vector<double>(n, 0.)};
    std::vector<Dual> gap, s(contact.scales.begin(), contact.scales.end());
    for (const auto &projection : contact.projections)
      gap.push_back(Dual(projection.delta));
    const auto own = [&](const unsigned int p) { return ramp(Dual(gap[p] / s[p]), pairs[p].touching); };
    for (unsigned int p = 0; p < n; ++p)
    {
      // 1 - product of what does not touch, over the node and its edges as far as the die bulges into them
      std::vector<std::array<unsigned int, 3>> edges; // and their ends
      std::vector<unsigned int>                inputs  = {p};
      const auto                               pair_of = [&](const NodeIndex k) {
        return std::find_if(pairs.begin(),
                            pairs.end(),
                            [&](const ContactPair &pair) {
                              return pair.die == pairs[p].die && pair.point.is_node() &&
                                     pair.point.nodes[0] == k;
                            }) -
               pairs.begin();
      };
      for (unsigned int q = 0; q < n && pairs[p].point.is_node() && with_edges; ++q)
        if (const auto &nodes = pairs[q].point.nodes;
            pairs[q].die == pairs[p].die && !pairs[q].point.is_node() &&
            (nodes[0] == pairs[p].point.nodes[0] || nodes[1] == pairs[p].point.nodes[0]))
        {
          edges.push_back({{q,
                            static_cast<unsigned int>(pair_of(nodes[0])),
                            static_cast<unsigned int>(pair_of(nodes[1]))}});
          inputs.insert(inputs.end(), edges.back().begin(), edges.back().end());
        }
      const auto touching = [&] {
        Dual free = 1. - own(p);
        for (const auto &[m, a, b] : edges)
          free *= 1. - (1. - ramp(Dual(4. * (0.5 * (gap[a] + gap[b]) - gap[m]) / s[m]), false)) * own(m);
        return Dual(1. - free);
      };
      std::sort(inputs.begin(), inputs.end());
      inputs.erase(std::unique(inputs.begin(), inputs.end()), inputs.end());
      for (auto &[numbers, to] : {std::tie(gap, sum.gaps), std::tie(s, sum.scales)})
        for (const unsigned int i : inputs)
        {
          numbers[i].fastAccessDx(0) = 1.;
          to[i] += ramps_bar[p] * touching().dx(0);
          numbers[i].fastAccessDx(0) = 0.;
        }
    }
    return sum;
  }
} // namespace retroforge
