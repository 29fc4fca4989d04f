// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/billet/billet.h>
#include <retroforge/objective/final_objective.h>

#include "objective_test_tools.h"

namespace retroforge
{
  /// All that a final objective's value depends on.
  template <typename Number>
  struct FinalInputs
  {
    NodalVectors<Number>          X;
    std::vector<Number>           q, damage; ///< damage may be empty: not followed
    std::vector<DieState<Number>> dies;
    NodalVectors<Number>          target;

    std::vector<Group<Number>> groups()
    {
      std::vector<Group<Number>> groups = {
        {"X", {}}, {"q", {}}, {"damage", {}}, {"displacement", {}}, {"target", {}}, {"dies", {}}};
      append(X, groups[0].second);
      for (Number &value : q)
        groups[1].second.push_back(&value);
      for (Number &value : damage)
        groups[2].second.push_back(&value);
      for (auto &die : dies)
        for (unsigned int i = 0; i < 3; ++i)
          groups[3].second.push_back(&die.displacement[i]);
      append(target, groups[4].second);
      for (auto &die : dies)
        append(die.vertices, groups[5].second);
      return groups;
    }
  };

  struct FinalProblem
  {
    Scene               scene;
    FinalInputs<double> at;

    FinalProblem(TetMesh                 mesh,
                 NodalVectors<double>    target,
                 const std::vector<Die> &dies = {Die("lower", Vec3(), Vec3({0., 0., 1.}))})
        : scene(std::move(mesh), DiscretizationChoice(), dies, MPI_COMM_WORLD)
        , at{scene.mesh.X,
             std::vector<double>(scene.mesh.n_cells(), 0.3),
             {},
             std::vector<DieState<double>>(dies.size()),
             std::move(target)}
    {
      for (std::size_t d = 0; d < dies.size(); ++d)
        if (dies[d].surface())
          at.dies[d].vertices = dies[d].surface()->vertices();
    }

    template <typename Number>
    FinalView<Number> view(const FinalInputs<Number> &inputs) const
    {
      return {scene,
              inputs.X,
              inputs.q,
              inputs.dies,
              inputs.target.empty() ? nullptr : &inputs.target,
              nullptr,
              inputs.damage.empty() ? nullptr : &inputs.damage};
    }

    template <typename Number>
    Number value(const FinalObjective      &objective,
                 const FinalDecisions      &decisions,
                 const FinalInputs<Number> &inputs) const
    {
      return objective.value(objective.integrals(view(inputs), decisions).complete(), decisions);
    }

    /// Integrals, value and details by the decisions taken here.
    std::vector<double> integrals(const FinalObjective &objective) const
    {
      return objective.integrals(view(at), objective.decide(view(at))).complete();
    }

    double value(const FinalObjective &objective) const
    {
      return value(objective, objective.decide(view(at)), at);
    }

    double detail(const FinalObjective &objective, const std::string &name) const
    {
      return objective.details(integrals(objective), objective.decide(view(at))).at(name);
    }

    FinalInputs<double> reverse(const FinalObjective      &objective,
                                const FinalDecisions      &decisions,
                                const FinalInputs<double> &inputs) const
    {
      const auto     seen    = view(inputs);
      const auto     b       = objective.integrals(seen, decisions).complete();
      const auto     weights = objective.reverse_value(b, decisions);
      const FinalBar bar     = objective.derivatives(seen, decisions, weights).complete();
      return {bar.X, bar.q, bar.damage, bar.dies, bar.target};
    }

    FinalInputs<Dual> dual_shape() const
    {
      std::vector<DieState<Dual>> dies(at.dies.size());
      for (std::size_t d = 0; d < dies.size(); ++d)
        dies[d].vertices.resize(at.dies[d].vertices.size());
      return {NodalVectors<Dual>(at.X.size()),
              std::vector<Dual>(at.q.size(), Dual(0.)),
              std::vector<Dual>(at.damage.size(), Dual(0.)),
              std::move(dies),
              NodalVectors<Dual>(at.target.size())};
    }
  };

  inline TetMesh box(const Vec3 &base, const Vec3 &size, const double element_size, const bool half = false)
  {
    BilletParameters parameters;
    parameters.base_centre  = base;
    parameters.size         = size;
    parameters.element_size = element_size;
    if (half)
      parameters.symmetry_planes = {Vec3({-1., 0., 0.})};
    return make_billet(parameters, MPI_COMM_WORLD);
  }

  inline std::shared_ptr<TriangleSurface>
  scaled(const TriangleSurface &shape, const double factor, const Vec3 &shift)
  {
    NodalVectors<double> x = shape.vertices();
    for (Vec3 &vertex : x)
      vertex = factor * vertex + shift;
    return std::make_shared<TriangleSurface>("target", x, shape.triangles());
  }
} // namespace retroforge
