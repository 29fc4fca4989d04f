// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include "ramps_by_duals.h"

#include "recorded_run.h"

#include <retroforge/core/dual.h>
#include <retroforge/discretization/element_pairs.h>
#include <retroforge/solver/spent_power.h>

#include <map>

/// The backward sweep once more, built from the library's kernels, that can leave out any one term: tests of
/// derivatives are worth what they see.
namespace retroforge
{
  enum class Term
  {
    none,
    gap,           // d delta / dX
    area,          // d S / dX
    friction_area, // d S^f / dX
    ramp,          // w'(delta)
    lambda_bubble, // bubble part of lambda in lambda·dR/dX
    power_bubble,  // dPhi / dbeta
    first_stage,   // the solve at X_i that later stages come from
    dt,            // of the increment, by the die's speed
    tau,           // approach time, by the die's speed
    curvature,     // dn / dX of a smooth die
    coordinates,   // d delta / dX by way of the barycentric coordinates of the foot
    normals,       // corner normals of a smooth die in its vertices
    edge_ramp,     // what edges let nodes touch
    edge_area,     // d S / dX of edges
    closing,       // the work on gaps that close
    wall,          // width of the ramp by the die's normal
    coming,        // width of the ramp by the metal's velocity in the increment before
    rate,          // strain rate that friction follows
    rate_position, // the same by the nodes' positions
    rate_velocity, // the same by their velocity in the increment before
    zone           // weight of a zone of friction by the place on the die
  };

  /// A facet of a smooth die and a point, as project_smoothly() has them: 21 numbers.
  template <typename Number>
  struct FacetScene
  {
    Vector3<Number>                x;
    std::array<Vector3<Number>, 3> corners, normals;

    std::array<Vector3<Number> *, 7> inputs()
    {
      return {{&x, &corners[0], &corners[1], &corners[2], &normals[0], &normals[1], &normals[2]}};
    }
  };

  /// Barycentric coordinates of the foot and its distance along the interpolated normal.
  template <typename Number>
  using Foot = std::array<Number, 4>;

  template <typename Number>
  Vector3<Number> interpolated(const std::array<Vector3<Number>, 3> &of_corners, const Foot<Number> &foot)
  {
    return of_corners[0] * foot[0] + of_corners[1] * foot[1] + of_corners[2] * foot[2];
  }

  template <typename Number>
  Vector3<Number> mismatch(const FacetScene<Number> &scene, const Foot<Number> &foot)
  {
    return interpolated(scene.corners, foot) + interpolated(scene.normals, foot) * foot[3] - scene.x;
  }

  /// Newton's step of the foot, with the matrix of `at`: from the solution, that is its derivative.
  template <typename Number>
  Foot<Number> improved(const FacetScene<Number> &scene,
                        const Foot<Number>       &foot,
                        const FacetScene<double> &at,
                        const Foot<double>       &foot_at)
  {
    dealii::Tensor<2, 3> J;
    const Vec3           N = interpolated(at.normals, foot_at);
    for (unsigned int i = 0; i < 3; ++i)
    {
      for (unsigned int a = 1; a < 3; ++a)
        J[i][a - 1] =
          at.corners[a][i] - at.corners[0][i] + foot_at[3] * (at.normals[a][i] - at.normals[0][i]);
      J[i][2] = N[i];
    }
    const dealii::Tensor<2, 3> inverse = dealii::invert(J);
    const Vector3<Number>      r       = mismatch(scene, foot);
    std::array<Number, 3>      step;
    for (unsigned int i = 0; i < 3; ++i)
      step[i] = -(inverse[i][0] * r[0] + inverse[i][1] * r[1] + inverse[i][2] * r[2]);
    return {{foot[0] - step[0] - step[1], foot[1] + step[0], foot[2] + step[1], foot[3] + step[2]}};
  }

  inline Foot<double> find_foot(const FacetScene<double> &scene)
  {
    Foot<double> foot{{1. / 3., 1. / 3., 1. / 3., 0.}};
    for (unsigned int i = 0; i < 20; ++i)
      foot = improved(scene, foot, scene, foot);
    return foot;
  }

  template <typename Number>
  Projection<Number> project(const FacetScene<Number> &scene, const Foot<Number> &foot)
  {
    const Vector3<Number> p0 = interpolated(scene.corners, foot);
    Vector3<Number>       p  = p0;
    for (unsigned int a = 0; a < 3; ++a)
      p += scene.normals[a] * Number(0.5 * foot[a] * Number((scene.corners[a] - p0) * scene.normals[a]));
    Projection<Number> projection;
    projection.n     = -unit(interpolated(scene.normals, foot));
    projection.delta = (p - scene.x) * projection.n;
    return projection;
  }

  /// Pull-back of a smooth die's gap and normal, by one dual number after another.
  inline void reverse_smooth(const Die            &die,
                             const CornerNormals  &normals,
                             const DieFeature     &feature,
                             const Vec3           &x,
                             const double          delta_bar,
                             const Vec3           &n_bar,
                             const Term            omitted,
                             Vec3                 &x_bar,
                             NodalVectors<double> &vertices_bar)
  {
    const TriangleSurface &surface = *die.surface();
    const Triangle        &corners = surface.triangles()[feature.facet];
    FacetScene<double>     at;
    at.x = x;
    for (unsigned int a = 0; a < 3; ++a)
    {
      at.corners[a] = surface.vertices()[corners[a]];
      at.normals[a] = normals[normals.of_corner(feature.facet, a)];
    }
    const Foot<double> foot_at = find_foot(at);
    FacetScene<Dual>   scene;
    Foot<Dual>         fixed;
    for (unsigned int i = 0; i < 4; ++i)
      fixed[i] = Dual(foot_at[i]);
    for (unsigned int k = 0; k < 7; ++k)
      for (unsigned int i = 0; i < 3; ++i)
        (*scene.inputs()[k])[i] = Dual((*at.inputs()[k])[i]);
    std::array<Vec3, 7> bar;
    for (unsigned int k = 0; k < 7; ++k)
      for (unsigned int i = 0; i < 3; ++i)
      {
        Dual &input           = (*scene.inputs()[k])[i];
        input.fastAccessDx(0) = 1.;
        const auto moving     = project(scene, improved(scene, fixed, at, foot_at));
        const auto delta =
          k == 0 && omitted == Term::coordinates ? project(scene, fixed).delta : moving.delta;
        bar[k][i] = delta_bar * delta.dx(0);
        if (k > 0 || omitted != Term::curvature)
          for (unsigned int j = 0; j < 3; ++j)
            bar[k][i] += n_bar[j] * moving.n[j].dx(0);
        input.fastAccessDx(0) = 0.;
      }
    x_bar += bar[0];
    for (unsigned int a = 0; a < 3; ++a)
    {
      vertices_bar[corners[a]] += bar[1 + a];
      if (omitted != Term::normals)
        normals.reverse_normal(surface, normals.of_corner(feature.facet, a), bar[4 + a], vertices_bar);
    }
  }

  /// The dies' surfaces are smooth, with this feature angle [degrees].
  constexpr double feature_angle = 40.;

  inline void reverse_set(const std::vector<Die>              &dies,
                          const std::vector<DieState<double>> &states,
                          const ContactSet<double>            &contact,
                          const FrictionRamp                  &ramp,
                          const NodalVectors<double>          &X,
                          const NodalVectors<double>          &V,
                          const ContactSetBar                 &bar,
                          const Term                           omitted,
                          NodalVectors<double>                &X_bar,
                          NodalVectors<double>                &V_bar,
                          std::vector<DieState<double>>       &dies_bar)
  {
    const RampsBar ramps_bar = reverse_ramps(contact, ramp, bar.ramp, omitted != Term::edge_ramp);
    std::map<unsigned int, CornerNormals> normals;
    for (unsigned int d = 0; d < dies.size(); ++d)
      if (dies[d].surface())
        normals.emplace(d, CornerNormals(*dies[d].surface(), feature_angle, 1.));
    for (unsigned int p = 0; p < contact.pairs.size(); ++p)
    {
      const ContactPair &pair = contact.pairs[p];
      const Die         &die  = dies[pair.die];
      const double       s = contact.scales[p], s_bar = ramps_bar.scales[p];
      const double       delta_bar = bar.delta[p] + ramps_bar.gaps[p];
      Vec3               n_bar     = bar.n[p];
      if (s_bar != 0.)
      {
        // One die moves: it and the others close along its velocity.
        unsigned int moving = 0;
        while (states[moving].velocity.norm() == 0.)
          ++moving;
        const Vec3   c = states[moving].velocity, n = contact.projections[p].n;
        const Vec3   u = V.empty() ? c : pair.point.position(V) - states[pair.die].velocity;
        const double r = u * n / c.norm();
        if (V.empty() || r > 0.)
        {
          const double r_bar = s_bar * (1. - ramp.wall * ramp.wall) * r / s;
          if (omitted != Term::wall)
            n_bar += r_bar / c.norm() * u;
          if (!V.empty() && omitted != Term::coming)
            pair.point.add_to_position(Vec3(r_bar / c.norm() * n), V_bar);
          if (!V.empty())
          {
            dies_bar[pair.die].velocity -= r_bar / c.norm() * n;
            dies_bar[moving].velocity -= r_bar * r / c.norm_square() * c;
          }
        }
      }
      Vec3 &displacement = dies_bar[pair.die].displacement;
      Vec3  at_point;
      if (omitted != Term::zone)
        for (unsigned int z = 0; z < bar.zones[p].size(); ++z)
        {
          const Vec3 on_die = pair.point.position(X) - states[pair.die].displacement,
                     by_x   = bar.zones[p][z] * die.zones.gradient(z, on_die);
          pair.point.add_to_position(by_x, X_bar);
          displacement -= by_x;
        }
      if (die.surface() && pair.feature.kind == 0)
      {
        reverse_smooth(die,
                       normals.at(pair.die),
                       pair.feature,
                       pair.point.position(X) - states[pair.die].displacement,
                       delta_bar,
                       n_bar,
                       omitted,
                       at_point,
                       dies_bar[pair.die].vertices);
        displacement -= at_point;
      }
      else
        die.reverse_project(pair.point.position(X),
                            states[pair.die].displacement,
                            pair.feature,
                            delta_bar,
                            n_bar,
                            at_point,
                            displacement,
                            die.surface() ? &dies_bar[pair.die].vertices : nullptr);
      pair.point.add_to_position(at_point, X_bar);
    }
  }

  /// The contact's part of a reverse sweep; `reverse_node` is that of one node.
  template <typename NodeReverse>
  void reverse_contact(const Equilibrium<double> &stage,
                       const Term                 omitted,
                       const NodeReverse         &reverse_node,
                       NodalVectors<double>      &X_bar,
                       ContactSetBar             &contact_bar,
                       PhysicsBar                &bar)
  {
    const std::size_t n = stage.contact.pairs.size();
    contact_bar.zones.resize(n);
    ContactAreas<double> areas_bar{std::vector<double>(n, 0.), std::vector<double>(n, 0.)};
    for (unsigned int p = 0; p < n; ++p)
    {
      const ContactNodeBar node    = reverse_node(p);
      const bool           is_node = stage.contact.pairs[p].point.is_node();
      areas_bar.S[p]  = omitted == Term::area || (omitted == Term::edge_area && !is_node) ? 0. : node.S;
      areas_bar.Sf[p] = omitted == Term::friction_area ? 0. : node.Sf;
      contact_bar.delta[p] += node.delta;
      contact_bar.n[p] += node.n;
      contact_bar.rates[p] += omitted == Term::rate ? 0. : node.rate2;
      contact_bar.zones[p].resize(node.zones.size(), 0.);
      for (unsigned int z = 0; z < node.zones.size(); ++z)
        contact_bar.zones[p][z] += node.zones[z].weight;
      bar.tau += node.tau;
      bar.dies[stage.contact.pairs[p].die].velocity -= node.u;
    }
    reverse_contact_areas(
      stage.scene.mesh, stage.scene.topology, stage.contact, stage.X, areas_bar, X_bar, contact_bar);
  }

  /// Derivatives of the power spent in its terms.
  inline std::vector<double> power_weights(const std::vector<double> &terms)
  {
    std::vector<Dual>   at(terms.begin(), terms.end());
    std::vector<double> weights;
    for (Dual &term : at)
    {
      term.fastAccessDx(0) = 1.;
      weights.push_back(spent_power(at).total().dx(0));
      term.fastAccessDx(0) = 0.;
    }
    return weights;
  }

  /// Derivatives of weight * dt * power, of the only stage that is weighted; returns those in W.
  inline Field<double> reverse_energy(const Equilibrium<double> &stage,
                                      const Field<double>       &W,
                                      const ActiveSet           &active,
                                      const double               weight,
                                      const double               dt,
                                      const Term                 omitted,
                                      NodalVectors<double>      &X_bar,
                                      ContactSetBar             &contact_bar,
                                      PhysicsBar                &bar)
  {
    const TetMesh            &mesh    = stage.scene.mesh;
    const std::vector<double> terms   = power_terms(EquilibriumView<double>{stage, W, active});
    const std::vector<double> weights = power_weights(terms);
    Field<double>             W_bar(stage.scene.discretization);
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    {
      CellValues<double> w_bar = {};
      const auto s = reverse_cell_dissipation(geometry_of_cell(stage.scene.discretization, stage.X, c),
                                              MiniPair::on_cell(stage.scene.discretization, W, c),
                                              stage.physics.material.law,
                                              weight * dt * weights[0],
                                              w_bar);
      for (unsigned int a = 0; a < 4; ++a)
      {
        X_bar[mesh.cells[c][a]] += s.X[a];
        W_bar.V[mesh.cells[c][a]] += w_bar.V[a];
      }
      if (omitted != Term::power_bubble)
        MiniPair::bubble(stage.scene.discretization, W_bar, c) += w_bar.beta;
    }
    const auto reverse_node = [&](const unsigned int p) {
      const auto at   = stage.contact_node(p, W, active);
      auto       node = reverse_friction_power(
        at, stage.physics.material.law, stage.physics.contact, weight * dt * weights[1]);
      if (omitted != Term::closing)
      {
        const double          *of_die = &weights[3 + n_closing_moments * stage.contact.pairs[p].die];
        ClosingMoments<double> factors;
        for (unsigned int i = 0; i < n_closing_moments; ++i)
          factors[i] = weight * dt * of_die[i];
        double     rest_speed_bar = 0.;
        const auto closing        = reverse_closing_moments(at,
                                                     stage.physics.contact,
                                                     rest_speed(stage.physics.dies),
                                                     !stage.contact.pairs[p].point.has_own_velocity(),
                                                     factors,
                                                     rest_speed_bar);
        reverse_rest_speed(stage.physics.dies, rest_speed_bar, bar.dies);
        node.u += closing.u;
        node.n += closing.n;
        node.delta += closing.delta;
        node.tau += closing.tau;
        node.S += closing.S;
      }
      stage.contact.pairs[p].point.add_to_velocity(node.u, W_bar.V);
      return node;
    };
    reverse_contact(stage, omitted, reverse_node, X_bar, contact_bar, bar);
    bar.dt += weight * spent_power(terms).total();
    return W_bar;
  }

  /// Derivatives of lambda·R.
  inline void reverse_equilibrium(const Equilibrium<double> &stage,
                                  const Field<double>       &W,
                                  const ActiveSet           &active,
                                  Field<double>              lambda,
                                  const Term                 omitted,
                                  NodalVectors<double>      &X_bar,
                                  ContactSetBar             &contact_bar,
                                  PhysicsBar                &bar)
  {
    const TetMesh &mesh = stage.scene.mesh;
    if (omitted == Term::lambda_bubble)
      for (CellIndex c = 0; c < mesh.n_cells(); ++c)
        MiniPair::bubble(stage.scene.discretization, lambda, c) = Vec3();
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    {
      const auto s = reverse_cell_residual(geometry_of_cell(stage.scene.discretization, stage.X, c),
                                           MiniPair::on_cell(stage.scene.discretization, W, c),
                                           MiniPair::on_cell(stage.scene.discretization, lambda, c),
                                           stage.physics.material.law);
      for (unsigned int a = 0; a < 4; ++a)
        X_bar[mesh.cells[c][a]] += s.X[a];
    }
    const auto reverse_node = [&](const unsigned int p) {
      return reverse_contact_force(stage.contact_node(p, W, active),
                                   stage.physics.material.law,
                                   stage.physics.contact,
                                   stage.contact.pairs[p].point.velocity(lambda.V));
    };
    reverse_contact(stage, omitted, reverse_node, X_bar, contact_bar, bar);
  }

  /// Reverse of one increment for the energy, as Increment::reverse has it, without the omitted
  /// term.
  inline void reverse_increment(RecordedRun                &problem,
                                const NodalVectors<double> &X,
                                const NodalVectors<double> &V,
                                const IncrementRecord      &record,
                                const Term                  omitted,
                                NodalVectors<double>       &G,
                                NodalVectors<double>       &V_bar,
                                Process<double>            &process_bar)
  {
    const Scene                      &scene   = problem.scene;
    const Physics<double>             physics = problem.process().over(place(record));
    const double                      dt      = problem.process().duration(place(record));
    const ContactSet<double>          contact = make_contact_set<double>(scene.view(physics.dies, X, &V),
                                                                record.pairs,
                                                                {record.contact.ramp_in(record.step),
                                                                          record.contact.approach * dt,
                                                                          record.contact.approach_law(record.step),
                                                                          record.contact.edge_stiffness});
    ContactSetBar                     contact_bar(record.pairs.size());
    PhysicsBar                        bar(scene.dies);
    const Scheme                     &scheme     = problem.model().step.scheme;
    const NodalVectors<double>        next       = G; // dPhi/dX_{i+1}
    const NodalVectors<double>        next_V_bar = std::exchange(V_bar, NodalVectors<double>(X.size()));
    std::vector<NodalVectors<double>> Y_bar(scheme.n_stages());
    for (unsigned int s = scheme.n_stages(); s-- > 0;)
    {
      const SolveRecord         &solve    = record.solves[s];
      const NodalVectors<double> position = advanced(X, dt, scheme.a[s], record.solves);
      const Equilibrium<double>  stage(scene, physics, contact, position);
      Field<double> W(scene.discretization), rhs(scene.discretization), minus_rhs(scene.discretization),
        lambda;
      W.V.take(solve.V);
      W.P.take(solve.P);
      recover_bubbles(stage, W);
      NodalVectors<double> X_bar(X.size());
      if (scheme.b[s] != 0.)
        rhs = reverse_energy(stage, W, solve.active, scheme.b[s], dt, omitted, X_bar, contact_bar, bar);
      const auto lead_to = [&](const double weight, const NodalVectors<double> &there) {
        for (std::size_t k = 0; k < there.size(); ++k)
        {
          bar.dt += weight * (there[k] * W.V[k]);
          rhs.V[k] += weight * dt * there[k];
        }
      };
      lead_to(scheme.b[s], next);
      for (std::size_t k = 0; k < X.size(); ++k)
        rhs.V[k] += scheme.b[s] * next_V_bar[k];
      for (unsigned int r = s + 1; r < scheme.n_stages(); ++r)
        lead_to(scheme.a[r][s], Y_bar[r]);
      minus_rhs.add(-1., rhs);
      problem.first_epoch().system.assemble(stage, W, solve.active);
      problem.first_epoch().system.solve(minus_rhs, problem.model().step.adjoint_tolerance, lambda);
      if (s == 0 && omitted == Term::first_stage)
        lambda = Field<double>(scene.discretization);
      reverse_equilibrium(stage, W, solve.active, lambda, omitted, X_bar, contact_bar, bar);
      for (std::size_t k = 0; k < X.size(); ++k)
        G[k] += X_bar[k];
      Y_bar[s] = X_bar;
    }
    if (omitted == Term::gap)
      contact_bar.delta.assign(record.pairs.size(), 0.);
    if (omitted == Term::ramp)
      contact_bar.ramp.assign(record.pairs.size(), 0.);
    if (omitted == Term::dt)
      bar.dt = 0.;
    if (omitted == Term::tau)
      bar.tau = 0.;
    reverse_set(scene.dies,
                physics.dies,
                contact,
                record.contact.ramp_in(record.step),
                X,
                V,
                contact_bar,
                omitted,
                G,
                V_bar,
                bar.dies);
    NodalVectors<double> no_X(X.size()), no_V(X.size());
    reverse_surface_rates(scene.view(physics.dies, X, &V),
                          contact.pairs,
                          contact_bar.rates,
                          omitted == Term::rate_position ? no_X : G,
                          omitted == Term::rate_velocity ? no_V : V_bar,
                          bar.dies);
    reverse_over(problem.process(), place(record), record.contact.approach, bar, process_bar);
  }

  inline AdjointResult sweep(RecordedRun &problem, const Term omitted)
  {
    AdjointResult        result{NodalVectors<double>(problem.state().workpiece.X.size()),
                         no_process_derivatives(problem.process(), problem.scene.dies)};
    const auto           X = positions_of(problem);
    NodalVectors<double> V_bar(X.back().size());
    for (unsigned int i = problem.records.size(); i-- > 0;)
    {
      const IncrementRecord &record = problem.records[i];
      const auto V = i > 0 ? problem.first_epoch().increment.mechanics.mean_velocity(problem.records[i - 1])
                           : NodalVectors<double>();
      reverse_increment(problem, X[i], V, record, omitted, result.X_0, V_bar, result.process);
    }
    return result;
  }
} // namespace retroforge
