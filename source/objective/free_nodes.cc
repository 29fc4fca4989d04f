// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/contact/free_parts.h>
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
  } // namespace

  FreeNodes::Decisions FreeNodes::decide(const FinalView<double> &view) const
  {
    return find_contact_pairs(contact_view(view), ramp_, ramp_.width, true);
  }

  template <typename Number>
  std::vector<Number> FreeNodes::parts(const FinalView<Number> &view, const Decisions &near) const
  {
    return free_parts(contact_of(view, near, ramp_), view.X.size());
  }

  void FreeNodes::reverse(const FinalView<double>   &view,
                          const Decisions           &near,
                          const std::vector<double> &parts_bar,
                          FinalBar                  &bar) const
  {
    const auto    contact = contact_of(view, near, ramp_);
    ContactSetBar contact_bar(near.size());
    reverse_free_parts(contact, parts_bar, contact_bar);
    NodalVectors<double> no_velocity_bar(view.X.size());
    reverse_contact_set(contact_view(view), contact, ramp_, contact_bar, bar.X, no_velocity_bar, bar.dies);
  }

  template std::vector<double> FreeNodes::parts(const FinalView<double> &, const Decisions &) const;
  template std::vector<Dual>   FreeNodes::parts(const FinalView<Dual> &, const Decisions &) const;
} // namespace retroforge
