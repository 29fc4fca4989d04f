// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/contact/free_parts.h>
#include <retroforge/discretization/vertex_motion.h>
#include <retroforge/solver/stage_motion.h>

namespace retroforge
{
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
    const std::vector<Number>  c = free_parts(stage.contact, stage.X.size());
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
    const std::vector<double>  c = free_parts(stage.contact, stage.X.size());
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
      [&](ContactSetBar &part) { reverse_free_parts(stage.contact, motion_input_bar.freedom, part); });
  }

  template NodalVectors<double> motion(const Equilibrium<double> &, const Field<double> &);
  template NodalVectors<Dual>   motion(const Equilibrium<Dual> &, const Field<Dual> &);
} // namespace retroforge
