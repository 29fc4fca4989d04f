// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/objective/path_objective.h>
#include <retroforge/record/increment_record.h>
#include <retroforge/solver/newton.h>
#include <retroforge/time/process.h>

namespace retroforge
{
  enum class Scheme
  {
    euler,   ///< X_{i+1} = X_i + dt V(X_i)
    midpoint ///< X_{i+1} = X_i + dt V(X_i + dt/2 V(X_i))
  };

  /// What of a scene's numerical model is neither mesh nor process. Of a recorded increment, scheme and
  /// contact are those of the record.
  struct StepModel
  {
    Scheme           scheme = Scheme::midpoint;
    ContactNumerics  contact;
    bool             edges_touch       = true;  ///< middles of edges are contact points of curved dies
    double           reach             = 0.;    ///< nodes nearer than this to a die are watched [mm]
    double           adjoint_tolerance = 1e-10; ///< of the adjoint and tangent linear systems
    ShapeDerivatives shape_derivatives;         ///< of the backward sweep
  };

  /// Energy spent, deformation and friction [mJ].
  template <typename Number>
  struct Energy
  {
    Number deformation = 0., friction = 0.;

    Number total() const { return deformation + friction; }
  };

  /// What flows backwards through a run for one scalar Phi.
  struct Costate
  {
    NodalVectors<double> X;       ///< dPhi/dX, complete on every rank
    std::vector<double>  strain;  ///< dPhi/dq of each cell, complete on every rank; empty: Phi has none
    Process<double>      process; ///< this rank's part
  };

  /// Adds what costate j's Phi takes from the last stage of the increment, this rank's part.
  using StageSource = std::function<void(std::size_t j, const StageView<double> &, StageBar &)>;

  /// What looks on while a tangent passes: the last stage, and the increment's time dt.
  using TangentWatch = std::function<void(const StageView<Dual> &, const Dual &)>;

  /// The last stage of a recorded increment, where objectives are taken.
  class LastStage
  {
  public:
    /// @param X_before  positions before the increment
    LastStage(const Scene                &scene,
              const Process<double>      &process,
              const NodalVectors<double> &X_before,
              const IncrementRecord      &record);

  private:
    Physics<double>      physics_;
    double               dt_;
    ContactSet<double>   contact_;
    NodalVectors<double> X_;

  public:
    const Stage<double> stage;
  };

  /// One increment of time: forward, its tangent, and its reverse.
  class Increment
  {
  public:
    Increment(const Scene            &scene,
              const StepModel        &model,
              const NewtonParameters &newton,
              LinearSystem           &system,
              Timings                &timings);

    /// From X_i to X_{i+1}. @param record  in: stroke, step; with `replay`, the recorded decisions are
    /// obeyed. Out: contact, pairs, solves, energies, forces; iterations are added.
    /// @param W  in: initial guess, out: the last stage's solution
    NodalVectors<double> forward(const Process<double>      &process,
                                 const NodalVectors<double> &X,
                                 bool                        replay,
                                 IncrementRecord            &record,
                                 Field<double>              &W);

    /// Derivative of X_{i+1} along (X, process), at a recorded increment.
    NodalVectors<Dual> tangent(const Process<Dual>      &process,
                               const NodalVectors<Dual> &X,
                               const IncrementRecord    &record,
                               const TangentWatch       &watch);

    /// Reverse of forward, for several scalars at once: they share the matrix and its preconditioner, and
    /// each has a solve per stage of its own. Costates are those of X_{i+1} and q_{i+1} on entry, of X_i and
    /// q_i on exit.
    void reverse(const Process<double>      &process,
                 const NodalVectors<double> &X,
                 const IncrementRecord      &record,
                 const StageSource          &source,
                 std::vector<Costate>       &costates);

    /// X_{i+1} of a recorded increment, to the bit.
    NodalVectors<double> advance(const Process<double>      &process,
                                 const NodalVectors<double> &X,
                                 const IncrementRecord      &record) const;

    /// Solution of the last stage of a recorded increment, its bubbles recovered from nothing: the same bits
    /// as at the end of forward.
    Field<double> last_field(const Process<double>      &process,
                             const NodalVectors<double> &X,
                             const IncrementRecord      &record) const;

    /// Forgets what earlier systems left: preconditioner and starts. Results then depend on the input only.
    void forget();

    /// Positions of the last stage, where objectives are taken.
    NodalVectors<double> stage_positions(const Process<double>      &process,
                                         const NodalVectors<double> &X,
                                         const IncrementRecord      &record) const;

  private:
    NewtonStatistics   solve_stage(const Stage<double> &stage, const ActiveSet &frozen, Field<double> &W);
    ContactSet<double> contact_set(const Physics<double>      &physics,
                                   const NodalVectors<double> &X,
                                   const IncrementRecord      &record,
                                   double                      dt) const;
    bool               escaped(const Stage<double> &stage, const Field<double> &W) const;
    Field<double>      recorded_field(const Stage<double> &stage, const SolveRecord &solve) const;
    Field<Dual>        tangent_field(const Stage<Dual>          &stage,
                                     const NodalVectors<double> &X,
                                     const ContactSet<double>   &contact,
                                     const Physics<double>      &physics,
                                     const SolveRecord          &solve);

    const Scene     &scene_;
    const StepModel &model_;
    LinearSystem    &system_;
    Newton           newton_;
    Timings         &timings_;
    /// Of each stage and costate, from the increments reversed last: where the next adjoint system starts.
    std::array<std::vector<std::vector<Field<double>>>, 2> earlier_lambdas_;
  };
} // namespace retroforge
