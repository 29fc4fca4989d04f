// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/time/leg.h>
#include <retroforge/time/remesher.h>

namespace retroforge
{
  struct PressParameters
  {
    std::string  leading_die;
    double       stroke          = 10.;
    unsigned int increments      = 0;
    std::string  scheme          = Scheme::all().front().name;
    double       smallest_volume = 0.2;
    double       largest_move    = 0.5;
    double       largest_slip    = 1.;
    unsigned int max_cuts        = 8;
    double       largest_loss    = 0.02;

    void add_parameters(dealii::ParameterHandler &prm);
  };

  /// Where a run stands between two increments.
  struct ForgingState
  {
    std::shared_ptr<Leg> leg;
    NodalVectors<double> X;
    std::vector<double>  strain; ///< accumulated equivalent strain of each cell
    Field<double>        W;      ///< the last increment's solution, where the next one starts
    double               stroke   = 0.;
    double               volume   = 0.; ///< at the start of the run [mm^3]
    double               repaired = 0.; ///< taken away where the surface crossed itself [mm^3]
    unsigned int         depth    = 0;  ///< an increment is the whole one / 2^depth
    double slip = 0.; ///< of the last increment: largest one along a curved die, in edges [mm^-1]

    /// Where the present numerics began to hold: stroke [mm] and increments before.
    double       numerics_stroke     = 0.;
    unsigned int numerics_increments = 0;
    std::string  parameters; ///< the complete input, to be recorded with the next increment; else empty

    Energy<double>                   energy;
    unsigned int                     increments = 0, cuts = 0, newton = 0, krylov = 0, linear_solves = 0;
    std::vector<unsigned int>        remeshed;       ///< the increments, from 0, that began on a new mesh
    std::vector<std::vector<double>> strains_before; ///< of each remeshing, on the mesh it left
  };

  /// Why an increment must be shorter.
  struct Refusal
  {
    std::string  reason;          ///< empty: it need not be
    unsigned int halvings = 1;    ///< that will do
    bool         of_mesh  = true; ///< a better mesh may be enough
  };

  /// What is known at the end of an increment.
  struct IncrementEvent
  {
    const IncrementRecord      &record;
    const NodalVectors<double> &X_before; ///< on the mesh of the increment
    const SolvedIncrement      &solved;
    const ForgingState         &state; ///< after the increment
    double                      time;
  };

  /// The time loop: increments of equal stroke, halved while an element would invert or a node would cross
  /// too much of an edge, on meshes that are remade when they must. In a replay what was recorded is obeyed
  /// instead.
  class Forging
  {
  public:
    using Watch  = std::function<void(const IncrementEvent &)>;
    using Source = std::function<const IncrementRecord &(unsigned int)>;

    Forging(const ForgingModel    &model,
            const PressParameters &press,
            const Remesher        &remesher,
            Timings               &timings);

    /// Before the first increment.
    ForgingState start(std::shared_ptr<Leg> leg, const NodalVectors<double> &X_0) const;

    /// From `state` on other numerics hold: it goes on with whole increments of theirs.
    /// @param parameters  the complete input, which the next increment's record is to tell
    static void change_numerics(const std::string &parameters, ForgingState &state);

    /// Whether the stroke is not done yet.
    bool is_left(const ForgingState &state) const;

    /// Goes on from `state` to the end of the stroke, and decides everything anew.
    void run(const Process<double> &process, ForgingState &state, const Watch &watch) const;

    /// Where a run stood after n recorded increments, to the bit: nothing is solved.
    void restore(const Process<double> &process,
                 unsigned int           n,
                 const Source          &source,
                 ForgingState          &state,
                 const Watch           &watch) const;

    /// Obeys the decisions of n recorded increments, and starts each solve from the recorded one.
    void replay(const Process<double> &process,
                unsigned int           n,
                const Source          &source,
                ForgingState          &state,
                const Watch           &watch = {}) const;

    /// Changes the mesh as recorded: positions X' = J X + c, strain by transfer_cells().
    void change_mesh(const RemeshRecord &remesh, ForgingState &state) const;

  private:
    /// Solves an increment of record.step. @param guess  out: what was found, for a shorter increment
    Refusal attempt(const Process<double> &process,
                    const ForgingState    &state,
                    Guess                 &guess,
                    IncrementRecord       &record,
                    SolvedIncrement       &solved) const;
    std::string
    too_much(const Leg &leg, const NodalVectors<double> &X, const NodalVectors<double> &X_next) const;

    /// Of nodes along curved dies, over the edge length wanted there. @param where  of the largest one
    double            largest_slip(const Process<double>      &process,
                                   const IncrementRecord      &record,
                                   const NodalVectors<double> &X,
                                   const NodalVectors<double> &X_next,
                                   std::string                &where) const;
    [[noreturn]] void throw_stuck(const IncrementRecord &record, const std::string &reason) const;
    /// Throws Error where a run can only go on to no good: it takes too many increments, or loses its volume.
    void check_progress(const ForgingState &state) const;
    void remesh(const Process<double> &process, ForgingState &state, IncrementRecord &record) const;
    /// Takes the state to the increment's end, and tells `watch`.
    void finish_increment(const Process<double> &process,
                          const IncrementRecord &record,
                          const SolvedIncrement &solved,
                          ForgingState          &state,
                          const Watch           &watch) const;

    /// Stroke of an increment that is not cut [mm].
    double whole() const { return model_.step.contact.step; }

    const ForgingModel    &model_;
    const PressParameters &press_;
    const Remesher        &remesher_;
    Timings               &timings_;
  };
} // namespace retroforge
