// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/discretization/element_pairs.h>
#include <retroforge/element/cell_geometry.templates.h>
#include <retroforge/solver/contact_pullback.h>

namespace retroforge
{
  std::vector<DieState<double>> no_derivatives(const std::vector<Die> &dies)
  {
    std::vector<DieState<double>> states(dies.size());
    for (std::size_t d = 0; d < dies.size(); ++d)
      states[d].vertices.resize(dies[d].surface() ? dies[d].surface()->vertices().size() : 0);
    return states;
  }

  template <typename Number>
  ContactNode<Number>
  Stage<Number>::contact_node(const unsigned int p, const Field<Number> &W, const ActiveSet &active) const
  {
    const ContactPair      &pair = contact.pairs[p];
    const DieState<Number> &die  = physics.dies[pair.die];
    ContactNode<Number>     node;
    node.u             = pair.point.velocity(W.V) - die.velocity;
    node.n             = contact.projections[p].n;
    node.delta         = contact.projections[p].delta;
    node.tau           = contact.tau;
    node.approach      = contact.approach;
    node.S             = areas.S[p];
    node.Sf            = areas.Sf[p];
    node.alpha         = die.friction;
    node.interface_law = die.interface_law;
    node.active        = active.empty() ? value_of(approach_excess(node)) > 0. : active[p] != 0;
    return node;
  }

  template <typename Number>
  bool Stage<Number>::has_potential() const
  {
    return std::all_of(physics.dies.begin(), physics.dies.end(), [](const DieState<Number> &die) {
      return value_of(die.friction) == 0. || interface_law(die.interface_law).has_potential();
    });
  }

  template <typename Number>
  ActiveSet Stage<Number>::decide_active(const Field<Number> &W) const
  {
    ActiveSet active(contact.pairs.size());
    for (unsigned int p = 0; p < active.size(); ++p)
      active[p] = contact_node(p, W, {}).active;
    for (unsigned int p = 0; p < contact.middles_around.size(); ++p)
      if (const auto &middles = contact.middles_around[p]; !active[p] && !middles.empty())
        active[p] =
          std::all_of(middles.begin(), middles.end(), [&](const unsigned int m) { return active[m] != 0; });
    return active;
  }

  template <typename Number>
  Field<Number> Stage<Number>::residual(const Field<Number> &W, const ActiveSet &active) const
  {
    const Partition &partition = scene.partition;
    const ActiveSet  chosen    = active.empty() ? decide_active(W) : active;
    Field<Number>    r(scene.spaces);
    with_pair(scene.spaces, [&](const auto pair) {
      for (const CellIndex c : partition.visited_cells)
        pair.add(
          scene.spaces,
          cell_residual(geometry_of_cell(scene.mesh, X, c), pair.on_cell(scene.spaces, W, c), physics.law),
          c,
          r);
    });
    for (unsigned int p = 0; p < contact.pairs.size(); ++p)
      if (partition.sees(contact.pairs[p].point.nodes))
        contact.pairs[p].point.add_to_velocity(
          contact_force(contact_node(p, W, chosen), physics.law, physics.contact), r.V);
    return r;
  }

  template <typename Number>
  std::pair<Number, Number> Stage<Number>::power(const Field<Number> &W, const ActiveSet &active) const
  {
    const Partition          &partition = scene.partition;
    std::pair<Number, Number> power{Number(0.), Number(0.)};
    with_pair(scene.spaces, [&](const auto pair) {
      for (const CellIndex c : partition.cells().owned())
        power.first +=
          cell_dissipation(geometry_of_cell(scene.mesh, X, c), pair.on_cell(scene.spaces, W, c), physics.law);
    });
    for (unsigned int p = 0; p < contact.pairs.size(); ++p)
      if (partition.owns(contact.pairs[p].point.nodes[0]))
        power.second += friction_power(contact_node(p, W, active), physics.law, physics.contact);
    return power;
  }

  template class Stage<double>;
  template class Stage<Dual>;

  std::pair<double, double> residual_scale(const Stage<double> &stage, const Field<double> &W)
  {
    const Scene        &scene = stage.scene;
    std::vector<double> force(scene.spaces.n_velocity_nodes(), 0.), flow(scene.mesh.n_nodes(), 0.);
    with_pair(scene.spaces, [&](const auto pair) {
      for (const CellIndex c : scene.partition.visited_cells)
      {
        const auto   geometry = geometry_of_cell(scene.mesh, stage.X, c);
        const auto   w        = pair.on_cell(scene.spaces, W, c);
        const auto   r        = cell_residual(geometry, w, stage.physics.law);
        const auto   rates    = cell_strain_rates(geometry, w);
        const double flow_c   = 0.25 * geometry.volume * 0.25 * (rates[0] + rates[1] + rates[2] + rates[3]);
        for (unsigned int a = 0; a < r.V.size(); ++a)
          force[scene.spaces.velocity_nodes(c)[a]] += r.V[a].norm();
        for (const NodeIndex k : scene.mesh.cells[c])
          flow[k] += flow_c;
      }
    });
    double force2 = 0., flow2 = 0.;
    for (const NodeIndex k : scene.velocities.owned())
      force2 += std::pow(force[k], 2);
    for (const NodeIndex k : scene.partition.nodes().owned())
      flow2 += flow[k] * flow[k];
    return {std::sqrt(scene.partition.sum(force2)), std::sqrt(scene.partition.sum(flow2))};
  }

  std::vector<Vec3> die_forces(const Stage<double> &stage, const Field<double> &W, const ActiveSet &active)
  {
    std::vector<Vec3> forces(stage.scene.dies.size());
    for (unsigned int p = 0; p < stage.contact.pairs.size(); ++p)
      forces[stage.contact.pairs[p].die] -=
        contact_force(stage.contact_node(p, W, active), stage.physics.law, stage.physics.contact);
    return forces;
  }

  void settle_bubbles(const Stage<double> &stage, Field<double> &W)
  {
    const Scene &scene = stage.scene;
    if (scene.spaces.n_bubbles() == 0)
      return;
    const auto                               &visited = scene.partition.visited_cells;
    std::array<CellGeometry<double>, n_lanes> geometry;
    std::array<CellValues<double>, n_lanes>   w;
    for (std::size_t begin = 0; begin < visited.size(); begin += n_lanes)
    {
      const unsigned int n = std::min<std::size_t>(n_lanes, visited.size() - begin);
      for (unsigned int lane = 0; lane < n_lanes; ++lane)
      {
        // Lanes without a cell repeat the last one.
        const CellIndex c = visited[begin + std::min(lane, n - 1)];
        geometry[lane]    = geometry_of_cell(scene.mesh, stage.X, c);
        w[lane]           = MiniPair::on_cell(scene.spaces, W, c);
      }
      const auto beta = solve_bubbles(geometry, w, stage.physics.law);
      for (unsigned int lane = 0; lane < n; ++lane)
        W.beta[scene.spaces.bubble(visited[begin + lane])] = beta[lane];
    }
  }

  void recover_bubbles(const Stage<double> &stage, Field<double> &W)
  {
    if (W.beta.empty())
      return;
    std::fill(W.beta.begin(), W.beta.end(), Vec3());
    settle_bubbles(stage, W);
  }

  void reverse_residual(const StageView<double> &view, const Field<double> &lambda, StageBar &bar)
  {
    const Stage<double> &stage     = view.stage;
    const TetMesh       &mesh      = stage.scene.mesh;
    const Partition     &partition = stage.scene.partition;
    with_pair(stage.scene.spaces, [&](const auto pair) {
      for (const CellIndex c : partition.cells().owned())
      {
        const auto      X        = positions_of_cell(mesh, stage.X, c);
        const auto      w        = pair.on_cell(stage.scene.spaces, view.W, c);
        const auto      lambda_c = pair.on_cell(stage.scene.spaces, lambda, c);
        CellSensitivity s        = reverse_cell_residual(cell_geometry(X), w, lambda_c, stage.physics.law);
        if (bar.shape.method != ShapeDerivatives::Method::exact)
          s.X = difference_cell_residual(X, w, lambda_c, stage.physics.law, bar.shape);
        for (unsigned int a = 0; a < 4; ++a)
          bar.X[mesh.cells[c][a]] += s.X[a];
        add_numbers(s.law, bar.physics.law);
      }
    });
    ContactPullback pullback(view, bar);
    for (unsigned int p = 0; p < stage.contact.pairs.size(); ++p)
      if (const ContactPoint &point = stage.contact.pairs[p].point; partition.owns(point.nodes[0]))
        pullback.add_at_fixed_velocity(p,
                                       reverse_contact_force(stage.contact_node(p, view.W, view.active),
                                                             stage.physics.law,
                                                             stage.physics.contact,
                                                             point.velocity(lambda.V)));
    pullback.finish();
  }

  void
  reverse_power(const StageView<double> &view, const double deformation, const double friction, StageBar &bar)
  {
    const Stage<double> &stage     = view.stage;
    const TetMesh       &mesh      = stage.scene.mesh;
    const Partition     &partition = stage.scene.partition;
    with_pair(stage.scene.spaces, [&](const auto pair) {
      for (const CellIndex c : partition.cells().owned())
      {
        const auto                                       X     = positions_of_cell(mesh, stage.X, c);
        const auto                                       w     = pair.on_cell(stage.scene.spaces, view.W, c);
        typename decltype(pair)::template Values<double> w_bar = {};
        CellSensitivity                                  s =
          reverse_cell_dissipation(cell_geometry(X), w, stage.physics.law, deformation, w_bar);
        if (bar.shape.method != ShapeDerivatives::Method::exact)
          s.X = difference_cell_dissipation(X, w, stage.physics.law, deformation, bar.shape);
        for (unsigned int a = 0; a < 4; ++a)
          bar.X[mesh.cells[c][a]] += s.X[a];
        pair.add(stage.scene.spaces, w_bar, c, bar.W);
        add_numbers(s.law, bar.physics.law);
      }
    });
    ContactPullback pullback(view, bar);
    for (unsigned int p = 0; p < stage.contact.pairs.size(); ++p)
      if (partition.owns(stage.contact.pairs[p].point.nodes[0]))
        pullback.add(
          p,
          reverse_friction_power(
            stage.contact_node(p, view.W, view.active), stage.physics.law, stage.physics.contact, friction));
    pullback.finish();
  }
} // namespace retroforge
