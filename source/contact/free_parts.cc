// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/contact/free_parts.h>

namespace retroforge
{
  template <typename Number>
  std::vector<Number> free_parts(const ContactSet<Number> &contact, const std::size_t n_nodes)
  {
    std::vector<Number> parts(n_nodes, Number(1.));
    for (unsigned int p = 0; p < contact.pairs.size(); ++p)
      if (const ContactPoint &point = contact.pairs[p].point; point.is_node())
        parts[point.nodes[0]] *= 1. - contact.ramps[p];
    return parts;
  }

  void reverse_free_parts(const ContactSet<double>  &contact,
                          const std::vector<double> &parts_bar,
                          ContactSetBar             &bar)
  {
    AssertDimension(bar.ramp.size(), contact.pairs.size());
    std::vector<std::vector<unsigned int>> pairs(parts_bar.size());
    for (unsigned int p = 0; p < contact.pairs.size(); ++p)
      if (const ContactPoint &point = contact.pairs[p].point; point.is_node())
        pairs[point.nodes[0]].push_back(p);
    for (NodeIndex k = 0; k < parts_bar.size(); ++k)
      for (const unsigned int p : pairs[k])
      {
        double others = 1.;
        for (const unsigned int q : pairs[k])
          others *= q == p ? 1. : 1. - contact.ramps[q];
        bar.ramp[p] -= parts_bar[k] * others;
      }
  }

  template std::vector<double> free_parts(const ContactSet<double> &, std::size_t);
  template std::vector<Dual>   free_parts(const ContactSet<Dual> &, std::size_t);
} // namespace retroforge
