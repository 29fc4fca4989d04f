// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/rank_sum.h>
#include <retroforge/heat/skin.h>
#include <retroforge/solver/equilibrium.h>

#include <any>
#include <map>
#include <string>

/// @file
/// Objectives of the workpiece at the end:  Phi = F(b(X_N, q_N, ...)),  with a few integrals b over the
/// workpiece and F a function of these numbers, differentiated by dual numbers. The reverse of b is written
/// by each objective in closed form, and starts the backward sweep: G = dPhi/dX_N.
///
/// Discrete decisions (which features are closest) are values that a run records and that replays and
/// derivatives take from it: an objective itself keeps nothing of a run.
namespace retroforge
{
  /// The workpiece and the dies after the last increment.
  template <typename Number>
  struct FinalView
  {
    const Scene                         &scene;
    const NodalVectors<Number>          &X;
    const std::vector<Number>           &q;    ///< accumulated equivalent strain of each cell
    const std::vector<DieState<Number>> &dies; ///< displacements at the end
    /// Vertices of the objective's target surface, where a derivative in them is wanted; null: its own.
    const NodalVectors<Number> *target = nullptr;
    const std::vector<Number>  *T      = nullptr; ///< temperatures of the nodes [C]; null: not followed
    const std::vector<Number>  *damage = nullptr; ///< of each cell; null: not followed
    /// Skins beneath the nodes (heat/skin.h), and the numbers of heat; null where it does not flow.
    const NodeSkins<Number> *skin = nullptr;
    const HeatLaw<Number>   *heat = nullptr;
  };

  /// What an objective decided on a workpiece, a value of the type T::Decisions of FinalObjectiveOf. Of lists
  /// that are shared out among the ranks (nodes, samples) it has this rank's share.
  using FinalDecisions = std::any;

  /// Decisions of an objective that takes none.
  struct NoDecisions
  {
  };

  /// Derivatives in what FinalView holds.
  struct FinalBar
  {
    NodalVectors<double> X;
    std::vector<double>  q;
    std::vector<double>  T;      ///< empty where temperatures are not followed
    std::vector<double>  damage; ///< empty where it is not followed
    NodeSkins<double>    skin;   ///< empty where heat does not flow
    NodalVectors<double> target; ///< vertices of the target, where the view or a die has them; else empty
    /// Displacements, temperatures, and vertices of dies that are not meant as the target.
    std::vector<DieState<double>> dies;

    /// Makes zero derivatives.
    /// @param target_die  that of the objective
    FinalBar(const FinalView<double> &view, unsigned int target_die);

    template <typename Self>
    static auto members(Self &self)
    {
      auto &[X, q, T, damage, skin, target, dies] = self;
      return std::tie(X, q, T, damage, skin, target, dies);
    }
  };

  class FinalObjective
  {
  public:
    virtual ~FinalObjective() = default;

    virtual std::string name() const = 0;
    virtual std::string unit() const = 0;

    /// Returns the die whose surface is the target, or invalid_index: whoever moves its vertices passes them
    /// in the view.
    virtual unsigned int target_die() const { return invalid_index; }

    /// Takes the discrete decisions (closest features) on which value and derivatives then rely. Collective.
    /// Called once for a run; its replays and derivatives are given what was decided.
    /// @throws Error  where the workpiece cannot be judged
    virtual FinalDecisions decide(const FinalView<double> &view) const = 0;

    /// Returns b.
    virtual RankSum<std::vector<double>> integrals(const FinalView<double> &view,
                                                   const FinalDecisions    &decisions) const = 0;
    virtual RankSum<std::vector<Dual>>   integrals(const FinalView<Dual> &view,
                                                   const FinalDecisions  &decisions) const = 0;

    /// Returns the derivatives of weights·b.
    virtual RankSum<FinalBar> derivatives(const FinalView<double>   &view,
                                          const FinalDecisions      &decisions,
                                          const std::vector<double> &weights) const = 0;

    /// Returns F of completed integrals.
    virtual double value(const std::vector<double> &integrals, const FinalDecisions &decisions) const = 0;
    virtual Dual   value(const std::vector<Dual> &integrals, const FinalDecisions &decisions) const   = 0;

    /// Returns dF/db.
    virtual std::vector<double> reverse_value(const std::vector<double> &integrals,
                                              const FinalDecisions      &decisions) const = 0;

    /// Returns the summands of the value.
    virtual std::map<std::string, double> parts(const std::vector<double> &) const { return {}; }

    /// Returns other numbers told beside it, in its unit unless their names say other.
    virtual std::map<std::string, double> details(const std::vector<double> &, const FinalDecisions &) const
    {
      return {};
    }
  };

  /// A FinalObjective made from class T, which has for any Number
  ///   std::vector<Number> compute_integrals(const FinalView<Number> &view) const;           b, of this rank
  ///   Number              combine(const std::vector<Number> &integrals) const;              F
  /// and, to add the derivatives of weights·b, of this rank,
  ///   void reverse_integrals(const FinalView<double>   &view,
  ///                          const std::vector<double> &weights,
  ///                          FinalBar                  &bar) const;
  /// A class that decides has moreover
  ///   struct Decisions;
  ///   Decisions compute_decisions(const FinalView<double> &view) const;
  /// and the other three take  const Decisions &  as their second argument.
  template <typename T>
  class FinalObjectiveOf : public FinalObjective
  {
  public:
    using Decisions = NoDecisions;
    Decisions compute_decisions(const FinalView<double> &) const { return {}; }

    FinalDecisions decide(const FinalView<double> &view) const override
    {
      check_sizes(view);
      return self().compute_decisions(view);
    }

    RankSum<std::vector<double>> integrals(const FinalView<double> &view,
                                           const FinalDecisions    &decisions) const override
    {
      return sum_integrals(view, decisions);
    }

    RankSum<std::vector<Dual>> integrals(const FinalView<Dual> &view,
                                         const FinalDecisions  &decisions) const override
    {
      return sum_integrals(view, decisions);
    }

    RankSum<FinalBar> derivatives(const FinalView<double>   &view,
                                  const FinalDecisions      &decisions,
                                  const std::vector<double> &weights) const override
    {
      check_sizes(view);
      FinalBar bar(view, target_die());
      with(decisions, [&](const auto &...taken) { self().reverse_integrals(view, taken..., weights, bar); });
      return {std::move(bar), view.scene.discretization.comm()};
    }

    double value(const std::vector<double> &integrals, const FinalDecisions &decisions) const override
    {
      return combined(integrals, decisions);
    }

    Dual value(const std::vector<Dual> &integrals, const FinalDecisions &decisions) const override
    {
      return combined(integrals, decisions);
    }

    std::vector<double> reverse_value(const std::vector<double> &integrals,
                                      const FinalDecisions      &decisions) const override
    {
      std::vector<double> bar;
      std::vector<Dual>   at(integrals.begin(), integrals.end());
      for (Dual &integral : at)
      {
        integral.fastAccessDx(0) = 1.;
        bar.push_back(combined(at, decisions).dx(0));
        integral.fastAccessDx(0) = 0.;
      }
      return bar;
    }

  private:
    const T &self() const { return static_cast<const T &>(*this); }

    /// Calls f with the decisions, where T takes any.
    template <typename F>
    static auto with(const FinalDecisions &decisions, const F &f)
    {
      using Taken = typename T::Decisions;
      Assert(std::any_cast<Taken>(&decisions),
             dealii::ExcMessage("these are decisions of another objective"));
      if constexpr (std::is_same_v<Taken, NoDecisions>)
        return f();
      else
        return f(std::any_cast<const Taken &>(decisions));
    }

    template <typename Number>
    RankSum<std::vector<Number>> sum_integrals(const FinalView<Number> &view,
                                               const FinalDecisions    &decisions) const
    {
      check_sizes(view);
      return {
        with(decisions,
             [&](const auto &...taken) { return self().template compute_integrals<Number>(view, taken...); }),
        view.scene.discretization.comm()};
    }

    template <typename Number>
    Number combined(const std::vector<Number> &integrals, const FinalDecisions &decisions) const
    {
      return with(decisions,
                  [&](const auto &...taken) { return self().template combine<Number>(integrals, taken...); });
    }

    template <typename Number>
    static void check_sizes([[maybe_unused]] const FinalView<Number> &view)
    {
      AssertDimension(view.X.size(), view.scene.mesh.n_nodes());
      AssertDimension(view.q.size(), view.scene.mesh.n_cells());
      AssertDimension(view.dies.size(), view.scene.dies.size());
    }
  };
} // namespace retroforge
