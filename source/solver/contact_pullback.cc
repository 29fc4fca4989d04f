// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/solver/contact_pullback.h>

namespace retroforge
{
  ContactPullback::ContactPullback(const EquilibriumView<double> &view, EquilibriumBar &bar)
      : view_(view), bar_(bar)
  {
    areas_bar_.S.assign(view.stage.contact.pairs.size(), 0.);
    areas_bar_.Sf.assign(view.stage.contact.pairs.size(), 0.);
  }

  void ContactPullback::add_at_fixed_velocity(const unsigned int p, const ContactNodeBar &node_bar)
  {
    AssertIndexRange(p, areas_bar_.S.size());
    areas_bar_.S[p] += node_bar.S;
    areas_bar_.Sf[p] += node_bar.Sf;
    bar_.contact.delta[p] += node_bar.delta;
    bar_.contact.n[p] += node_bar.n;
    bar_.physics.tau += node_bar.tau;
    reverse_surface_law(view_.stage, p, node_bar.law, bar_.physics);
    add_numbers(node_bar.contact, bar_.physics.contact);
    DieState<double> &die = bar_.physics.dies[view_.stage.contact.pairs[p].die];
    die.velocity -= node_bar.u;
    die.friction += node_bar.alpha;
    die.shear_limit += node_bar.shear_limit;
    bar_.contact.rates[p] += node_bar.rate2;
    if (node_bar.zones.empty())
      return;
    bar_.contact.zones.resize(areas_bar_.S.size());
    bar_.contact.zones[p].resize(node_bar.zones.size(), 0.);
    for (unsigned int z = 0; z < node_bar.zones.size(); ++z)
    {
      bar_.contact.zones[p][z] += node_bar.zones[z].weight;
      add_numbers(node_bar.zones[z].law, die.zones[z]);
    }
  }

  void ContactPullback::add(const unsigned int p, const ContactNodeBar &node_bar)
  {
    view_.stage.contact.pairs[p].point.add_to_velocity(node_bar.u, bar_.W.V);
    add_at_fixed_velocity(p, node_bar);
  }

  void ContactPullback::finish()
  {
    const Equilibrium<double> &stage = view_.stage;
    reverse_contact_areas(
      stage.scene.mesh, stage.scene.topology, stage.contact, stage.X, areas_bar_, bar_.X, bar_.contact);
  }
} // namespace retroforge
