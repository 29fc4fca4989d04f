// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/discretization/element_pairs.h>
#include <retroforge/element/cell_geometry.templates.h>
#include <retroforge/solver/contact_pullback.h>
#include <retroforge/solver/hold_forces.h>

namespace retroforge
{
  std::vector<DieState<double>> no_derivatives(const std::vector<Die> &dies)
  {
    std::vector<DieState<double>> states(dies.size());
    for (std::size_t d = 0; d < dies.size(); ++d)
    {
      states[d].vertices.resize(dies[d].surface() ? dies[d].surface()->vertices().size() : 0);
      states[d].zones.resize(dies[d].zones.boxes.size());
    }
    return states;
  }

  namespace
  {
    /// What the sums of a stage need: unknowns of its scene, and a choice for each pair if for any.
    template <typename Number>
    void check_arguments([[maybe_unused]] const Equilibrium<Number> &stage,
                         [[maybe_unused]] const Field<Number>       &W,
                         [[maybe_unused]] const ActiveChoice        &active)
    {
      Assert(W.belongs_to(stage.scene.discretization),
             dealii::ExcMessage("the unknowns are of another discretisation than the stage"));
      Assert(active.fits(stage.contact.pairs.size()),
             dealii::ExcMessage("a choice of active contacts has an entry for each pair"));
    }

    /// The same of derivatives: an entry for each that the stage depends on.
    void check_bar([[maybe_unused]] const Equilibrium<double> &stage,
                   [[maybe_unused]] const EquilibriumBar      &bar)
    {
      AssertDimension(bar.X.size(), stage.X.size());
      AssertDimension(bar.contact.delta.size(), stage.contact.pairs.size());
      AssertDimension(bar.contact.ramp.size(), stage.contact.pairs.size());
      AssertDimension(bar.contact.n.size(), stage.contact.pairs.size());
      AssertDimension(bar.physics.dies.size(), stage.physics.dies.size());
    }
  } // namespace

  template <typename Number>
  ContactNode<Number> Equilibrium<Number>::contact_node(const unsigned int   p,
                                                        const Field<Number> &W,
                                                        const ActiveChoice  &active) const
  {
    AssertIndexRange(p, contact.pairs.size());
    check_arguments(*this, W, active);
    const ContactPair      &pair = contact.pairs[p];
    const DieState<Number> &die  = physics.dies[pair.die];
    ContactNode<Number>     node;
    node.u             = pair.point.velocity(W.V) - die.velocity;
    node.n             = contact.projections[p].n;
    node.delta         = contact.projections[p].delta;
    node.tau           = contact.tau;
    node.approach      = contact.approach.of(pair.point);
    node.S             = areas.S[p];
    node.Sf            = areas.Sf[p];
    node.alpha         = die.friction;
    node.interface_law = die.interface_law;
    node.shear_limit   = die.shear_limit;
    if (!contact.rates.empty())
      node.rate2 = contact.rates[p];
    if (!contact.zones.empty())
      for (unsigned int z = 0; z < die.zones.size(); ++z)
        node.zones.push_back({contact.zones[p][z], die.zones[z]});
    node.active = active.is_given() ? (*active)[p] != 0 : value_of(approach_excess(node)) > 0.;
    return node;
  }

  template <typename Number>
  bool Equilibrium<Number>::has_potential() const
  {
    return std::all_of(physics.dies.begin(), physics.dies.end(), [](const DieState<Number> &die) {
      return !die.any_friction([](const ZoneFriction<Number> &friction) {
        return !interface_law(friction.interface_law).has_potential();
      });
    });
  }

  template <typename Number>
  bool Equilibrium<Number>::is_linear() const
  {
    const auto law = converted<double>(initial_law_);
    return law.is_linear() &&
           std::all_of(physics.dies.begin(), physics.dies.end(), [&](const DieState<Number> &die) {
             return !die.any_friction([&](const ZoneFriction<Number> &friction) {
               return !interface_law(friction.interface_law).is_linear(law);
             });
           });
  }

  template <typename Number>
  std::pair<PointState<Number>, std::vector<CellIndex>>
  Equilibrium<Number>::surface_state(const unsigned int p) const
  {
    const std::vector<CellIndex> cells = cells_behind(scene.mesh, scene.topology, contact.pairs[p].point);
    PointState<Number>           mean;
    for (const CellIndex c : cells)
    {
      const PointState<Number> of_cell = state(c);
      for_each_number([&](Number &x, const Number &y) { x += y / double(cells.size()); }, mean, of_cell);
    }
    return {mean, cells};
  }

  template <typename Number>
  ActiveSet Equilibrium<Number>::decide_active(const Field<Number> &W) const
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
  Field<Number> Equilibrium<Number>::residual(const Field<Number> &W, const ActiveChoice &active) const
  {
    check_arguments(*this, W, active);
    const Discretization<3> &discretization = scene.discretization;
    const ActiveSet          chosen         = active.is_given() ? *active : decide_active(W);
    Field<Number>            r(discretization);
    dispatch_element(discretization, [&](const auto pair) {
      for (const CellIndex c : discretization.visited_cells())
        pair.add(discretization,
                 cell_residual(cell_geometry(pair.positions(discretization, X, c)),
                               pair.on_cell(discretization, W, c),
                               law(c)),
                 c,
                 r);
    });
    for (unsigned int p = 0; p < contact.pairs.size(); ++p)
      if (scene.sees(contact.pairs[p].point))
        contact.pairs[p].point.add_to_velocity(
          contact_force(contact_node(p, W, chosen), surface_law(p), physics.contact), r.V);
    add_hold_forces(*this, W, r);
    return r;
  }

  template <typename Number>
  std::pair<Number, Number> Equilibrium<Number>::power(const Field<Number> &W,
                                                       const ActiveChoice  &active) const
  {
    check_arguments(*this, W, active);
    const Discretization<3>  &discretization = scene.discretization;
    std::pair<Number, Number> power{Number(0.), Number(0.)};
    dispatch_element(discretization, [&](const auto pair) {
      for (const CellIndex c : discretization.cells().owned())
        power.first += cell_dissipation(
          cell_geometry(pair.positions(discretization, X, c)), pair.on_cell(discretization, W, c), law(c));
    });
    for (unsigned int p = 0; p < contact.pairs.size(); ++p)
      if (discretization.owns(contact.pairs[p].point.nodes[0]))
        power.second += friction_power(contact_node(p, W, active), surface_law(p), physics.contact);
    return power;
  }

  template class Equilibrium<double>;
  template class Equilibrium<Dual>;

  std::pair<double, double> residual_scale(const Equilibrium<double> &stage, const Field<double> &W)
  {
    check_arguments(stage, W, {});
    const auto         &discretization = stage.scene.discretization;
    const auto         &velocities     = *discretization.velocity_nodes();
    const auto         &pressures      = *discretization.pressure_nodes();
    std::vector<double> force(velocities.n_places(), 0.), flow(pressures.n_places(), 0.);
    dispatch_element(discretization, [&](const auto pair) {
      for (const CellIndex c : discretization.visited_cells())
      {
        const auto   geometry = cell_geometry(pair.positions(discretization, stage.X, c));
        const auto   w        = pair.on_cell(discretization, W, c);
        const auto   r        = cell_residual(geometry, w, stage.law(c));
        const double flow_c   = 0.25 * cell_volume(geometry) * cell_strain_rate(geometry, w);
        for (unsigned int a = 0; a < r.V.size(); ++a)
          force[discretization.velocity_places(c)[a]] += r.V[a].norm();
        for (unsigned int a = 0; a < 4; ++a)
          flow[discretization.pressure_places(c)[a]] += flow_c;
      }
    });
    double force2 = 0., flow2 = 0.;
    for (unsigned int i = 0; i < discretization.condensed_nodes()->n_owned(); ++i)
      force2 += std::pow(force[i], 2);
    for (unsigned int i = 0; i < pressures.n_owned(); ++i)
      flow2 += flow[i] * flow[i];
    return {std::sqrt(discretization.sum(force2)), std::sqrt(discretization.sum(flow2))};
  }

  std::vector<Vec3>
  die_forces(const Equilibrium<double> &stage, const Field<double> &W, const ActiveSet &active)
  {
    std::vector<Vec3> forces(stage.scene.dies.size());
    for (unsigned int p = 0; p < stage.contact.pairs.size(); ++p)
      forces[stage.contact.pairs[p].die] -=
        contact_force(stage.contact_node(p, W, active), stage.surface_law(p), stage.physics.contact);
    return forces;
  }

  void solve_bubbles(const Equilibrium<double> &stage, Field<double> &W)
  {
    check_arguments(stage, W, {});
    const Discretization<3> &discretization = stage.scene.discretization;
    if (!discretization.has_bubbles())
      return;
    const auto &visited = discretization.visited_cells();
    if (discretization.quadrature())
    {
      const QuadraturePair pair{discretization.quadrature()};
      for (const CellIndex c : visited)
        MiniPair::bubble(discretization, W, c) = solve_bubble(
          pair.positions(discretization, stage.X, c), pair.on_cell(discretization, W, c), stage.law(c));
      return;
    }
    std::array<CellGeometry<double>, n_lanes> geometry;
    std::array<CellValues<double>, n_lanes>   w;
    LaneLaws                                  laws;
    for (std::size_t begin = 0; begin < visited.size(); begin += n_lanes)
    {
      const unsigned int n = std::min<std::size_t>(n_lanes, visited.size() - begin);
      for (unsigned int lane = 0; lane < n_lanes; ++lane)
      {
        // Lanes without a cell repeat the last one.
        const CellIndex c = visited[begin + std::min(lane, n - 1)];
        geometry[lane]    = geometry_of_cell(discretization, stage.X, c);
        w[lane]           = MiniPair::on_cell(discretization, W, c);
        laws[lane]        = stage.law(c);
      }
      const auto beta = solve_bubbles(geometry, w, laws);
      for (unsigned int lane = 0; lane < n; ++lane)
        MiniPair::bubble(discretization, W, visited[begin + lane]) = beta[lane];
    }
  }

  void recover_bubbles(const Equilibrium<double> &stage, Field<double> &W)
  {
    check_arguments(stage, W, {});
    const Discretization<3> &discretization = stage.scene.discretization;
    if (!discretization.has_bubbles())
      return;
    for (const CellIndex c : discretization.visited_cells())
      MiniPair::bubble(discretization, W, c) = Vec3();
    solve_bubbles(stage, W);
  }

  void reverse_law(const Equilibrium<double> &stage,
                   const CellIndex            c,
                   const MaterialLaw<double> &law_bar,
                   PhysicsBar                &bar)
  {
    if (!stage.physics.material.depends_on_state() || stage.points.empty())
    {
      reverse_initial_law(stage.physics.material, law_bar, bar.material);
      return;
    }
    PointState<double> state_bar;
    reverse_at(stage.physics.material, stage.state(c), law_bar, bar.material, state_bar);
    bar.points.resize(stage.scene.mesh.n_cells());
    add_numbers(state_bar, bar.points[c]);
  }

  void reverse_surface_law(const Equilibrium<double> &stage,
                           const unsigned int         p,
                           const MaterialLaw<double> &law_bar,
                           PhysicsBar                &bar)
  {
    if (!stage.physics.material.depends_on_state())
    {
      reverse_initial_law(stage.physics.material, law_bar, bar.material);
      return;
    }
    if (!stage.physics.dies[stage.contact.pairs[p].die].rubs())
      return;
    const auto [mean, cells] = stage.surface_state(p);
    PointState<double> mean_bar;
    reverse_at(stage.physics.material, mean, law_bar, bar.material, mean_bar);
    for_each_number([&](double &x) { x /= double(cells.size()); }, mean_bar);
    bar.points.resize(stage.scene.mesh.n_cells());
    for (const CellIndex c : cells)
      add_numbers(mean_bar, bar.points[c]);
  }

  void reverse_residual(const EquilibriumView<double> &view, const Field<double> &lambda, EquilibriumBar &bar)
  {
    check_arguments(view.stage, view.W, view.active);
    check_arguments(view.stage, lambda, {});
    check_bar(view.stage, bar);
    const Equilibrium<double> &stage          = view.stage;
    const Discretization<3>   &discretization = stage.scene.discretization;
    dispatch_element(discretization, [&](const auto pair) {
      for (const CellIndex c : discretization.cells().owned())
      {
        const auto X        = pair.positions(discretization, stage.X, c);
        const auto w        = pair.on_cell(discretization, view.W, c);
        const auto lambda_c = pair.on_cell(discretization, lambda, c);
        const auto law      = stage.law(c);
        auto       s        = reverse_cell_residual(cell_geometry(X), w, lambda_c, law);
        if (bar.shape.method != ShapeDerivatives::Method::exact)
          s.X = difference_cell_residual(X, w, lambda_c, law, bar.shape);
        add_to_positions(discretization, s.X, c, bar.X);
        reverse_law(stage, c, s.law, bar.physics);
      }
    });
    ContactPullback pullback(view, bar);
    for (unsigned int p = 0; p < stage.contact.pairs.size(); ++p)
      if (const ContactPoint &point = stage.contact.pairs[p].point; discretization.owns(point.nodes[0]))
        pullback.add_at_fixed_velocity(p,
                                       reverse_contact_force(stage.contact_node(p, view.W, view.active),
                                                             stage.surface_law(p),
                                                             stage.physics.contact,
                                                             point.velocity(lambda.V)));
    pullback.finish();
    reverse_hold_forces(view, lambda, bar.X);
  }

  void reverse_power(const EquilibriumView<double> &view,
                     const double                   deformation,
                     const double                   friction,
                     EquilibriumBar                &bar)
  {
    check_arguments(view.stage, view.W, view.active);
    check_arguments(view.stage, bar.W, {});
    check_bar(view.stage, bar);
    const Equilibrium<double> &stage          = view.stage;
    const Discretization<3>   &discretization = stage.scene.discretization;
    dispatch_element(discretization, [&](const auto pair) {
      for (const CellIndex c : discretization.cells().owned())
      {
        const auto X     = pair.positions(discretization, stage.X, c);
        const auto w     = pair.on_cell(discretization, view.W, c);
        auto       w_bar = pair.no_values();
        const auto law   = stage.law(c);
        auto       s     = reverse_cell_dissipation(cell_geometry(X), w, law, deformation, w_bar);
        if (bar.shape.method != ShapeDerivatives::Method::exact)
          s.X = difference_cell_dissipation(X, w, law, deformation, bar.shape);
        add_to_positions(discretization, s.X, c, bar.X);
        pair.add(discretization, w_bar, c, bar.W);
        reverse_law(stage, c, s.law, bar.physics);
      }
    });
    ContactPullback pullback(view, bar);
    for (unsigned int p = 0; p < stage.contact.pairs.size(); ++p)
      if (discretization.owns(stage.contact.pairs[p].point.nodes[0]))
        pullback.add(p,
                     reverse_friction_power(stage.contact_node(p, view.W, view.active),
                                            stage.surface_law(p),
                                            stage.physics.contact,
                                            friction));
    pullback.finish();
  }
} // namespace retroforge
