// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/rank_sum.h>
#include <retroforge/solver/hold_forces.h>

namespace retroforge
{
  namespace
  {
    /// Calls f(place, node) for the nodes of the mesh that this rank owns.
    template <typename F>
    void for_each_owned_vertex(const Scene &scene, const F &f)
    {
      const NodeNumbering &nodes = *scene.discretization.condensed_nodes();
      for (unsigned int place = 0; place < nodes.n_owned(); ++place)
        if (const NodeIndex k = nodes.node_at(place); k < scene.mesh.n_nodes())
          f(place, k);
    }
  } // namespace

  template <typename Number>
  std::vector<Number> mean_speeds(const Equilibrium<Number> &stage, const NodeVector<3, Number> &V)
  {
    const auto                  &motions = stage.contact.hold.motions;
    RankSum<std::vector<Number>> speeds(std::vector<Number>(motions.size(), Number(0.)),
                                        stage.scene.discretization.comm());
    for_each_owned_vertex(stage.scene, [&](const unsigned int place, const NodeIndex k) {
      for (std::size_t j = 0; j < motions.size(); ++j)
        speeds.part()[j] += motions[j].at(stage.X[k]) * V.at_place(place) / Number(stage.X.size());
    });
    return speeds.complete();
  }

  template <typename Number>
  void add_hold_forces(const Equilibrium<Number> &stage, const Field<Number> &W, Field<Number> &r)
  {
    const RigidHold &hold = stage.contact.hold;
    if (hold.empty())
      return;
    const std::vector<Number> speeds = mean_speeds(stage, W.V);
    for_each_owned_vertex(stage.scene, [&](const unsigned int place, const NodeIndex k) {
      for (std::size_t j = 0; j < speeds.size(); ++j)
        r.V.at_place(place) +=
          hold.motions[j].at(stage.X[k]) * Number(hold.drag / stage.X.size() * speeds[j]);
    });
  }

  template std::vector<double> mean_speeds(const Equilibrium<double> &, const NodeVector<3, double> &);
  template std::vector<Dual>   mean_speeds(const Equilibrium<Dual> &, const NodeVector<3, Dual> &);
  template void add_hold_forces(const Equilibrium<double> &, const Field<double> &, Field<double> &);
  template void add_hold_forces(const Equilibrium<Dual> &, const Field<Dual> &, Field<Dual> &);

  void reverse_hold_forces(const EquilibriumView<double> &view,
                           const Field<double>           &lambda,
                           NodalVectors<double>          &X_bar)
  {
    const Equilibrium<double> &stage = view.stage;
    const RigidHold           &hold  = stage.contact.hold;
    if (hold.empty())
      return;
    // lambda·f = c_h sum_j g_j(V) g_j(lambda), and d g_j(V)/dX_k = V_k x turn_j / n.
    const std::vector<double> of_V = mean_speeds(stage, view.W.V), of_lambda = mean_speeds(stage, lambda.V);
    const double              part = hold.drag / stage.X.size();
    for_each_owned_vertex(stage.scene, [&](const unsigned int place, const NodeIndex k) {
      for (std::size_t j = 0; j < of_V.size(); ++j)
        X_bar[k] +=
          cross(Vec3(part * (of_lambda[j] * view.W.V.at_place(place) + of_V[j] * lambda.V.at_place(place))),
                hold.motions[j].turn);
    });
  }

  HoldLoad hold_load(const EquilibriumView<double> &view)
  {
    const Equilibrium<double> &stage = view.stage;
    const RigidHold           &hold  = stage.contact.hold;
    HoldLoad                   load;
    if (hold.empty())
      return load;
    const std::vector<double> speeds = mean_speeds(stage, view.W.V);
    Vec3                      centre;
    for (const Vec3 &x : stage.X)
      centre += x / static_cast<double>(stage.X.size());
    for (std::size_t j = 0; j < speeds.size(); ++j)
      for (const Vec3 &x : stage.X)
      {
        const Vec3 force = hold.drag / stage.X.size() * speeds[j] * hold.motions[j].at(x);
        load.force += force;
        load.moment += cross(Vec3(x - centre), force);
      }
    return load;
  }
} // namespace retroforge
