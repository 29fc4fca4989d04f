// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/solver/stage_motion.h>
#include <retroforge/steps/mechanics.h>

namespace retroforge
{
  namespace
  {
    Vector3<Dual> make_dual(const Vec3 &value, const Vec3 &dot)
    {
      Vector3<Dual> x;
      for (unsigned int i = 0; i < 3; ++i)
      {
        x[i]                 = Dual(value[i]);
        x[i].fastAccessDx(0) = dot[i];
      }
      return x;
    }

    Vec3 dot_of(const Vector3<Dual> &x)
    {
      Vec3 d;
      for (unsigned int i = 0; i < 3; ++i)
        d[i] = x[i].dx(0);
      return d;
    }

    /// A tangent is taken where the dies have the vertices they were made with.
    Process<double> values_of(const Process<Dual> &process)
    {
      auto values = converted<double>(process);
      for (auto &die : values.dies)
        die.vertices.clear();
      return values;
    }

    /// Gives the numbers that normal forces are made of the values of the run: dual numbers, which find gaps by
    /// another path, round them otherwise, and times the penalty that is 1e-9 of a pressure, which Coulomb's law
    /// takes for one that changes.
    void take_values(const IncrementStart<double> &from, IncrementStart<Dual> &to)
    {
      const auto take = [](const double value, Dual &x) { x.val() = value; };
      for_each_number([&](const double &value, Dual &x) { take(value, x); }, from.physics, to.physics);
      take(from.dt, to.dt);
      take(from.contact.tau, to.contact.tau);
      AssertDimension(from.contact.projections.size(), to.contact.projections.size());
      for (std::size_t p = 0; p < to.contact.projections.size(); ++p)
      {
        take(from.contact.projections[p].delta, to.contact.projections[p].delta);
        for (unsigned int i = 0; i < 3; ++i)
          take(from.contact.projections[p].n[i], to.contact.projections[p].n[i]);
      }
    }

    Field<Dual> make_dual(const Field<double> &value, const Field<double> &dot)
    {
      Field<Dual> W;
      W.V = NodeVector<3, Dual>(value.V.numbering());
      W.P = NodeVector<1, Dual>(value.P.numbering());
      for (unsigned int i = 0; i < W.V.size(); ++i)
        W.V.at_place(i) = make_dual(value.V.at_place(i), dot.V.at_place(i));
      for (unsigned int i = 0; i < W.P.size(); ++i)
      {
        W.P.at_place(i)                 = Dual(value.P.at_place(i));
        W.P.at_place(i).fastAccessDx(0) = dot.P.at_place(i);
      }
      return W;
    }
  } // namespace

  Field<Dual> Mechanics::tangent_field(const Equilibrium<Dual> &stage, const SolvedStage &at)
  {
    const Field<Dual> still = make_dual(at.W, Field<double>(scene_.discretization));
    const Field<Dual> R     = stage.residual(still, at.active);
    Field<double>     minus_R_dot(scene_.discretization), W_dot;
    for (unsigned int i = 0; i < R.V.size(); ++i)
      minus_R_dot.V.at_place(i) = -dot_of(R.V.at_place(i));
    for (unsigned int i = 0; i < R.P.size(); ++i)
      minus_R_dot.P.at_place(i) = -R.P.at_place(i).dx(0);
    system_.assemble(at.stage, at.W, at.active);
    system_.solve_derivative(minus_R_dot, model_.adjoint_tolerance, W_dot);
    return make_dual(at.W, W_dot);
  }

  namespace
  {
    /// What `advanced` asks of a stage.
    struct Moved
    {
      NodalVectors<Dual> nodes;

      const NodalVectors<Dual> &motion() const { return nodes; }
    };
  } // namespace

  NodalVectors<Dual> Mechanics::tangent(const Process<Dual>           &process,
                                        const WorkpieceState<3, Dual> &state,
                                        const IncrementRecord         &record,
                                        const TangentObserver         &observer)
  {
    AssertDimension(state.X.size(), scene_.mesh.n_nodes());
    AssertDimension(record.solves.size(), scheme_of(record).n_stages());
    WorkpieceState<3, double> value;
    convert(state, value);
    const auto           start_value = recorded_start(values_of(process), value, record);
    IncrementStart<Dual> start(scene_, process, state, record);
    take_values(*start_value, start);
    const Scheme      &scheme = scheme_of(record);
    std::vector<Moved> stages;
    for (unsigned int s = 0; s < scheme.n_stages(); ++s)
    {
      const NodalVectors<Dual> position = advanced(state.X, start.dt, scheme.a[s], stages);
      const Equilibrium<Dual>  stage(scene_, start.physics, start.contact, position, start.history.points(s));
      const Field<Dual>        W =
        tangent_field(stage, *recorded_stage(*start_value, value.X, scheme, record.solves, s));
      start.history.add(scheme, s, {stage, W, record.solves[s].active}, start.dt);
      stages.push_back({retroforge::motion(stage, W)});
      if (scheme.b[s] != 0.)
        observer({stage, W, record.solves[s].active, scheme.b[s]}, start.dt);
    }
    return advanced(state.X, start.dt, scheme.b, stages);
  }
} // namespace retroforge
