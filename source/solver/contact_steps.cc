// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/solver/contact_steps.h>

namespace retroforge
{
  namespace
  {
    /// Nodes that two dies hold need more than one sweep over the pairs.
    constexpr unsigned int sweeps = 3;

    /// Beyond the die, of the fastest die's speed: enough to count as active, too little for a force. (A node
    /// may stick to its die, so that its own speed against it is no measure.)
    constexpr double beyond = 1e-8;

    double fastest(const std::vector<DieState<double>> &dies)
    {
      double speed = 0.;
      for (const auto &die : dies)
        speed = std::max(speed, die.velocity.norm());
      return speed;
    }

    /// By a correction along the die's normal, as far as the symmetry planes let the node go that way.
    void put_onto_die(const Stage<double> &stage, const unsigned int p, Field<double> &W)
    {
      const NodeIndex           k    = stage.contact.pairs[p].point.velocity_node;
      const ContactNode<double> node = stage.contact_node(p, W, {});
      Vec3                      free = node.n;
      for (const Vec3 &fixed : stage.scene.spaces.fixed_directions(k))
        free -= (fixed * free) * fixed;
      constexpr double held = 1e-3; // of the normal: symmetry holds the node, not the die
      if (const double part = free * node.n; part > held)
        W.V[k] -= (approach_excess(node) - beyond * fastest(stage.physics.dies)) / part * free;
    }

    /// Whether a node is at its die: what it may approach at is little of its speed.
    bool touches(const ContactNode<double> &node)
    {
      constexpr double little = 0.05;
      return approach_speed(node.delta, node.tau, node.approach) < little * node.u.norm();
    }

    /// A node is pressed against its die by more than this part of the mean force of those that are.
    constexpr double pressing = 0.1;

    /// Of each pair, whether the metal presses it against its die when no node is held.
    std::vector<char> pressed_by_metal(const Stage<double> &stage, const Field<double> &W)
    {
      const auto &pairs = stage.contact.pairs;
      // Edges hold nodes, too: these are not the die's to hold.
      ActiveSet edges = stage.decide_active(W);
      for (unsigned int p = 0; p < pairs.size(); ++p)
        if (pairs[p].point.has_own_velocity())
          edges[p] = 0;
      Field<double> r = stage.residual(W, edges);
      stage.scene.velocities.gather(r.V);
      std::vector<double> force(pairs.size(), 0.);
      double              sum = 0.;
      unsigned int        n   = 0;
      for (unsigned int p = 0; p < pairs.size(); ++p)
        if (const auto node = stage.contact_node(p, W, {});
            pairs[p].point.has_own_velocity() && touches(node))
        {
          force[p] = -(r.V[pairs[p].point.velocity_node] * node.n);
          sum += std::max(0., force[p]);
          n += force[p] > 0.;
        }
      std::vector<char> pressed(pairs.size(), 0);
      for (unsigned int p = 0; p < pairs.size(); ++p)
        pressed[p] = force[p] > 0. && force[p] > pressing * sum / n;
      return pressed;
    }
  } // namespace

  void hold_on_dies(const Stage<double> &stage, Field<double> &W)
  {
    const auto       &pairs = stage.contact.pairs;
    std::vector<char> held  = pressed_by_metal(stage, W);
    for (unsigned int sweep = 0; sweep < sweeps; ++sweep)
      for (unsigned int p = 0; p < pairs.size(); ++p)
        if (pairs[p].point.has_own_velocity())
        {
          held[p] = held[p] || stage.contact_node(p, W, {}).active;
          if (held[p])
            put_onto_die(stage, p, W);
        }
  }

  void stop_at_dies(const Stage<double> &stage, const ActiveSet &active, Field<double> &W)
  {
    const auto &pairs = stage.contact.pairs;
    for (unsigned int sweep = 0; sweep < sweeps; ++sweep)
      for (unsigned int p = 0; p < pairs.size(); ++p)
        if (pairs[p].point.has_own_velocity() && !active[p])
          if (stage.contact_node(p, W, {}).active)
            put_onto_die(stage, p, W);
  }
} // namespace retroforge
