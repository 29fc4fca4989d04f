// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/mesh/surface_areas.h>
#include <retroforge/output/contact_fields.h>

namespace retroforge
{
  namespace
  {
    /// Of each die and node: the force that it is pushed with [N].
    std::vector<std::vector<double>>
    pushing_forces(const Equilibrium<double> &stage, const Field<double> &W, const ActiveSet &active)
    {
      std::vector<std::vector<double>> forces(stage.scene.dies.size(),
                                              std::vector<double>(stage.scene.mesh.n_nodes(), 0.));
      for (unsigned int p = 0; p < stage.contact.pairs.size(); ++p)
      {
        const ContactPair &pair  = stage.contact.pairs[p];
        const double       force = normal_force(stage.contact_node(p, W, active), stage.physics.contact);
        for (unsigned int i = 0; i < pair.point.n_nodes(); ++i)
          forces[pair.die][pair.point.nodes[i]] += pair.point.weight() * force;
      }
      return forces;
    }

    /// The number of the strongest die, counted from 1; 0 for none.
    unsigned int strongest(const std::vector<std::vector<double>> &forces, const NodeIndex k)
    {
      unsigned int die   = 0;
      double       force = 0.;
      for (unsigned int d = 0; d < forces.size(); ++d)
        if (forces[d][k] > force)
        {
          die   = d + 1;
          force = forces[d][k];
        }
      return die;
    }
  } // namespace

  ContactFields
  contact_fields(const Equilibrium<double> &stage, const Field<double> &W, const ActiveSet &active)
  {
    const TetMesh            &mesh   = stage.scene.mesh;
    const auto                forces = pushing_forces(stage, W, active);
    const std::vector<double> areas  = lumped_areas(surface_triangles(mesh), stage.X);
    ContactFields             fields{std::vector<double>(mesh.n_nodes(), 0.),
                         std::vector<double>(mesh.n_nodes(), 0.),
                         NodalVectors<double>(mesh.n_nodes())};
    for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
      if (const unsigned int die = strongest(forces, k); die > 0)
      {
        fields.die[k] = die;
        for (const auto &of_die : forces)
          fields.pressure[k] += of_die[k] / areas[k];
      }
    for (unsigned int p = 0; p < stage.contact.pairs.size(); ++p)
    {
      const ContactPair &pair = stage.contact.pairs[p];
      const NodeIndex    k    = pair.point.nodes[0];
      if (!pair.point.is_node() || fields.die[k] != pair.die + 1.)
        continue;
      fields.slip[k] = slip(stage.contact_node(p, W, active));
    }
    return fields;
  }
} // namespace retroforge
