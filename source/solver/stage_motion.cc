// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/discretization/vertex_motion.h>
#include <retroforge/solver/stage_motion.h>

namespace retroforge
{
  namespace
  {
    template <typename Number>
    std::vector<Number> freedom(const Equilibrium<Number> &stage)
    {
      std::vector<Number> c(stage.scene.mesh.n_nodes(), Number(1.));
      for (unsigned int p = 0; p < stage.contact.pairs.size(); ++p)
        if (const ContactPoint &point = stage.contact.pairs[p].point; point.is_node())
          c[point.nodes[0]] *= 1. - stage.contact.ramps[p];
      return c;
    }

    /// Adds to the ramps' derivatives. A node may be held by several dies.
    void
    reverse_freedom(const Equilibrium<double> &stage, const std::vector<double> &c_bar, ContactSetBar &bar)
    {
      const ContactSet<double>              &contact = stage.contact;
      std::vector<std::vector<unsigned int>> pairs(c_bar.size());
      for (unsigned int p = 0; p < contact.pairs.size(); ++p)
        if (const ContactPoint &point = contact.pairs[p].point; point.is_node())
          pairs[point.nodes[0]].push_back(p);
      for (NodeIndex k = 0; k < c_bar.size(); ++k)
        for (const unsigned int p : pairs[k])
        {
          double others = 1.;
          for (const unsigned int q : pairs[k])
            others *= q == p ? 1. : 1. - contact.ramps[q];
          bar.ramp[p] -= c_bar[k] * others;
        }
    }
  } // namespace

  template <typename Number>
  NodalVectors<Number> motion(const Equilibrium<Number> &stage, const Field<Number> &W)
  {
    Assert(W.belongs_to(stage.scene.discretization),
           dealii::ExcMessage("the unknowns are of another discretisation than the stage"));
    const Scene &scene          = stage.scene;
    const auto  &discretization = scene.discretization;
    if (!discretization.middles())
      return W.V.complete(*discretization.condensed_nodes());
    const NodalVectors<Number> V = W.V.complete(*discretization.condensed_nodes());
    const std::vector<Number>  c = freedom(stage);
    return vertex_velocities<Number>({scene.mesh, scene.topology, *discretization.middles(), stage.X, V, c});
  }

  void reverse_motion(const Equilibrium<double>     &stage,
                      const Field<double>           &W,
                      const NodalVectors<double>    &motion_bar,
                      Field<double>                 &W_bar,
                      RankSum<NodalVectors<double>> &X_bar,
                      RankSum<ContactSetBar>        &contact_bar)
  {
    Assert(W.belongs_to(stage.scene.discretization) && W_bar.belongs_to(stage.scene.discretization),
           dealii::ExcMessage("the unknowns are of another discretisation than the stage"));
    AssertDimension(motion_bar.size(), stage.X.size());
    const Scene &scene          = stage.scene;
    const auto  &discretization = scene.discretization;
    const auto   add_to_W       = [&](const NodalVectors<double> &V_bar) {
      for (unsigned int place = 0; place < W_bar.V.size(); ++place)
        if (const NodeIndex k = W_bar.V.numbering()->node_at(place); k < V_bar.size())
          W_bar.V.at_place(place) += V_bar[k];
    };
    if (!discretization.middles())
      return add_to_W(motion_bar);
    const NodalVectors<double> V = W.V.complete(*discretization.condensed_nodes());
    const std::vector<double>  c = freedom(stage);
    VertexMotionBar            motion_input_bar{NodalVectors<double>(stage.X.size()),
                                     NodalVectors<double>(V.size()),
                                     std::vector<double>(c.size(), 0.)};
    reverse_vertex_velocities(
      {scene.mesh, scene.topology, *discretization.middles(), stage.X, V, c}, motion_bar, motion_input_bar);
    add_to_W(motion_input_bar.V);
    X_bar.add_once([&](NodalVectors<double> &part) {
      AssertDimension(part.size(), stage.X.size());
      for (std::size_t k = 0; k < part.size(); ++k)
        part[k] += motion_input_bar.X[k];
    });
    contact_bar.add_once(
      [&](ContactSetBar &part) { reverse_freedom(stage, motion_input_bar.freedom, part); });
  }

  template NodalVectors<double> motion(const Equilibrium<double> &, const Field<double> &);
  template NodalVectors<Dual>   motion(const Equilibrium<Dual> &, const Field<Dual> &);
} // namespace retroforge
