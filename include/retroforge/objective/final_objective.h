// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/solver/stage.h>

#include <map>
#include <string>

/// @file
/// Objectives of the workpiece at the end:  Phi = F(b(X_N, q_N, ...)),  with a few integrals b over the
/// workpiece and F a function of these numbers, differentiated by dual numbers. The reverse of b is written
/// by each objective in closed form, and starts the backward sweep: G = dPhi/dX_N.
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
  };

  /// Derivatives, this rank's part of the sums.
  struct FinalBar
  {
    NodalVectors<double> X;
    std::vector<double>  q;
    NodalVectors<double> target; ///< vertices; filled in when it has as many entries as there are
    /// Displacements, and vertices of dies that are not meant as the target.
    std::vector<DieState<double>> dies;

    FinalBar(const Scene &scene, const std::size_t n_target_vertices = 0)
        : X(scene.mesh.n_nodes())
        , q(scene.mesh.n_cells(), 0.)
        , target(n_target_vertices)
        , dies(no_derivatives(scene.dies))
    {
    }
  };

  class FinalObjective
  {
  public:
    virtual ~FinalObjective() = default;

    virtual std::string name() const = 0;
    virtual std::string unit() const = 0;

    /// The die whose surface is the target, or invalid_index: whoever moves its vertices passes them in the
    /// view.
    virtual unsigned int target_die() const { return invalid_index; }

    /// Takes the discrete decisions (closest features) on which value and derivatives then rely. The same on
    /// every rank. Called once for a run; a replay keeps them.
    virtual void decide(const FinalView<double> &) {}

    /// b: this rank's part of the sums, to be completed by sum_over_ranks().
    virtual std::vector<double> integrals(const FinalView<double> &view) const = 0;
    virtual std::vector<Dual>   integrals(const FinalView<Dual> &view) const   = 0;

    /// Adds the derivatives of weights·integrals, this rank's part.
    virtual void reverse_integrals(const FinalView<double>   &view,
                                   const std::vector<double> &weights,
                                   FinalBar                  &bar) const = 0;

    /// F of completed integrals.
    virtual double value(const std::vector<double> &integrals) const = 0;
    virtual Dual   value(const std::vector<Dual> &integrals) const   = 0;

    /// Summands of the value.
    virtual std::map<std::string, double> parts(const std::vector<double> &) const { return {}; }

    /// Other numbers told beside it, in its unit unless their names say other.
    virtual std::map<std::string, double> details(const std::vector<double> &) const { return {}; }

    /// dF/db.
    virtual std::vector<double> reverse_value(const std::vector<double> &integrals) const = 0;
  };

  /// A FinalObjective made from class T, which has for any Number
  ///   std::vector<Number> compute_integrals(const FinalView<Number> &) const;
  ///   Number              combine(const std::vector<Number> &integrals) const;
  template <typename T>
  class FinalObjectiveOf : public FinalObjective
  {
  public:
    std::vector<double> integrals(const FinalView<double> &view) const override
    {
      check_sizes(view);
      return self().template compute_integrals<double>(view);
    }

    std::vector<Dual> integrals(const FinalView<Dual> &view) const override
    {
      check_sizes(view);
      return self().template compute_integrals<Dual>(view);
    }

    double value(const std::vector<double> &integrals) const override
    {
      return self().template combine<double>(integrals);
    }

    Dual value(const std::vector<Dual> &integrals) const override
    {
      return self().template combine<Dual>(integrals);
    }

    std::vector<double> reverse_value(const std::vector<double> &integrals) const override
    {
      std::vector<double> bar;
      std::vector<Dual>   at(integrals.begin(), integrals.end());
      for (Dual &integral : at)
      {
        integral.fastAccessDx(0) = 1.;
        bar.push_back(value(at).dx(0));
        integral.fastAccessDx(0) = 0.;
      }
      return bar;
    }

  private:
    template <typename Number>
    static void check_sizes([[maybe_unused]] const FinalView<Number> &view)
    {
      AssertDimension(view.X.size(), view.scene.mesh.n_nodes());
      AssertDimension(view.q.size(), view.scene.mesh.n_cells());
      AssertDimension(view.dies.size(), view.scene.dies.size());
    }

    const T &self() const { return static_cast<const T &>(*this); }
  };
} // namespace retroforge
