// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/objective/free_nodes.h>

namespace retroforge
{
  namespace
  {
    /// Vertices alone: the middles of quadratic velocities lie on straight edges between them.
    template <typename Number>
    ContactView<Number> contact_view(const FinalView<Number> &view)
    {
      const Scene &scene = view.scene;
      return {
        scene.mesh, scene.topology, scene.dies, view.dies, view.X, nullptr, scene.discretization.comm()};
    }

    template <typename Number>
    ContactSet<Number>
    contact_of(const FinalView<Number> &view, const std::vector<ContactPair> &near, const FrictionRamp &ramp)
    {
      return make_contact_set<Number>(contact_view(view), near, {ramp, Number(1.)});
    }

    template <typename Number>
    std::vector<Number> products(const FinalView<Number> &view, const ContactSet<Number> &contact)
    {
      std::vector<Number> parts(view.X.size(), Number(1.));
      for (unsigned int p = 0; p < contact.pairs.size(); ++p)
        if (contact.pairs[p].point.is_node())
          parts[contact.pairs[p].point.nodes[0]] *= Number(1. - contact.ramps[p]);
      return parts;
    }
  } // namespace

  FreeNodes::Decisions FreeNodes::decide(const FinalView<double> &view) const
  {
    return find_contact_pairs(contact_view(view), ramp_, ramp_.width, true);
  }

  template <typename Number>
  std::vector<Number> FreeNodes::parts(const FinalView<Number> &view, const Decisions &near) const
  {
    return products(view, contact_of(view, near, ramp_));
  }

  void FreeNodes::reverse(const FinalView<double>   &view,
                          const Decisions           &near,
                          const std::vector<double> &parts_bar,
                          FinalBar                  &bar) const
  {
    const auto                                     contact = contact_of(view, near, ramp_);
    ContactSetBar                                  contact_bar(near.size());
    std::map<NodeIndex, std::vector<unsigned int>> pairs_of; // several dies may touch a node
    for (unsigned int p = 0; p < near.size(); ++p)
      if (near[p].point.is_node())
        pairs_of[near[p].point.nodes[0]].push_back(p);
    for (const auto &[k, pairs] : pairs_of)
      for (const unsigned int p : pairs)
      {
        double others = 1.;
        for (const unsigned int other : pairs)
          others *= other == p ? 1. : 1. - contact.ramps[other];
        contact_bar.ramp[p] = -parts_bar[k] * others;
      }
    NodalVectors<double> no_velocity_bar(view.X.size());
    reverse_contact_set(contact_view(view), contact, ramp_, contact_bar, bar.X, no_velocity_bar, bar.dies);
  }

  template std::vector<double> FreeNodes::parts(const FinalView<double> &, const Decisions &) const;
  template std::vector<Dual>   FreeNodes::parts(const FinalView<Dual> &, const Decisions &) const;
} // namespace retroforge
