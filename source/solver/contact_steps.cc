// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/solver/contact_steps.h>

namespace retroforge
{
  namespace
  {
    /// Nodes that two dies hold need more than one sweep over the pairs.
    constexpr unsigned int sweeps = 3;

    /// Approach excess of projected nodes, as a part of the fastest die's speed: enough to count as active,
    /// too little for a force. (A node may stick to its die, so that its own speed against it is no measure.)
    constexpr double beyond = 1e-8;

    double fastest(const std::vector<DieState<double>> &dies)
    {
      double speed = 0.;
      for (const auto &die : dies)
        speed = std::max(speed, die.velocity.norm());
      return speed;
    }

    /// Corrects the node's velocity along the die's normal, as far as the symmetry planes let it move that
    /// way.
    /// @param speed  the approach excess of the node afterwards [mm/s]
    void set_approach_excess(const Equilibrium<double> &stage,
                             const unsigned int         p,
                             const double               speed,
                             Field<double>             &W)
    {
      const NodeIndex           k              = stage.contact.pairs[p].point.velocity_node;
      const ContactNode<double> node           = stage.contact_node(p, W, {});
      Vec3                      free           = node.n;
      const auto               &discretization = stage.scene.discretization;
      for (const Vec3 &fixed : discretization.fixed_directions(discretization.condensed_nodes()->place(k)))
        free -= (fixed * free) * fixed;
      constexpr double held = 1e-3; // of the normal: symmetry holds the node, not the die
      if (const double part = free * node.n; part > held)
        W.V[k] -= (approach_excess(node) - speed) / part * free;
    }

    void put_onto_die(const Equilibrium<double> &stage, const unsigned int p, Field<double> &W)
    {
      set_approach_excess(stage, p, beyond * fastest(stage.physics.dies), W);
    }

    /// Returns whether a node is at its die: its allowed approach speed is a small part of its speed.
    bool touches(const ContactNode<double> &node)
    {
      constexpr double little = 0.05;
      return approach_speed(node.delta, node.tau, node.approach) < little * node.u.norm();
    }

    /// A node is pressed against its die by more than this part of the mean force of those that are.
    constexpr double pressing = 0.1;

    /// Returns, for each pair with a velocity of its own, the force with which the metal presses its node
    /// against the die when no node is held [N].
    std::vector<double> forces_of_metal(const Equilibrium<double> &stage, const Field<double> &W)
    {
      const auto &pairs = stage.contact.pairs;
      // Edges hold nodes, too: these are not the die's to hold.
      ActiveSet edges = stage.decide_active(W);
      for (unsigned int p = 0; p < pairs.size(); ++p)
        if (pairs[p].point.has_own_velocity())
          edges[p] = 0;
      Field<double> r = stage.residual(W, edges);
      r.V.update_ghosts();
      std::vector<double> force(pairs.size(), 0.);
      for (unsigned int p = 0; p < pairs.size(); ++p)
        if (pairs[p].point.has_own_velocity())
          force[p] = -(r.V[pairs[p].point.velocity_node] * stage.contact.projections[p].n);
      return force;
    }

    std::vector<char> pressed_by_metal(const Equilibrium<double> &stage, const Field<double> &W)
    {
      std::vector<double> force = forces_of_metal(stage, W);
      double              sum   = 0.;
      unsigned int        n     = 0;
      for (unsigned int p = 0; p < force.size(); ++p)
      {
        if (!touches(stage.contact_node(p, W, {})))
          force[p] = 0.;
        sum += std::max(0., force[p]);
        n += force[p] > 0.;
      }
      std::vector<char> pressed(force.size(), 0);
      for (unsigned int p = 0; p < force.size(); ++p)
        pressed[p] = force[p] > 0. && force[p] > pressing * sum / n;
      return pressed;
    }
  } // namespace

  std::vector<char>
  project_onto_dies(const Equilibrium<double> &stage, Field<double> &W, const ActiveChoice &pressed)
  {
    const auto &pairs = stage.contact.pairs;
    Assert(pressed.fits(pairs.size()),
           dealii::ExcMessage("a choice of active contacts has an entry for each pair"));
    std::vector<char> held = pressed.is_given() ? *pressed : pressed_by_metal(stage, W);
    for (unsigned int sweep = 0; sweep < sweeps; ++sweep)
      for (unsigned int p = 0; p < pairs.size(); ++p)
        if (pairs[p].point.has_own_velocity())
        {
          held[p] = held[p] || stage.contact_node(p, W, {}).active;
          if (held[p])
            put_onto_die(stage, p, W);
        }
    return held;
  }

  void
  apply_contact_pressure(const Equilibrium<double> &stage, const std::vector<char> &held, Field<double> &W)
  {
    const std::vector<double> force = forces_of_metal(stage, W);
    for (unsigned int p = 0; p < force.size(); ++p)
      if (held[p] && force[p] > 0.)
        set_approach_excess(
          stage, p, excess_under(force[p], stage.contact_node(p, W, {}), stage.physics.contact), W);
  }

  void clip_to_dies(const Equilibrium<double> &stage, const ActiveSet &active, Field<double> &W)
  {
    const auto &pairs = stage.contact.pairs;
    for (unsigned int sweep = 0; sweep < sweeps; ++sweep)
      for (unsigned int p = 0; p < pairs.size(); ++p)
        if (pairs[p].point.has_own_velocity() && !active[p])
          if (stage.contact_node(p, W, {}).active)
            put_onto_die(stage, p, W);
  }
} // namespace retroforge
