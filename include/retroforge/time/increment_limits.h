// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/error.h>
#include <retroforge/time/forging_state.h>
#include <retroforge/time/press_parameters.h>
#include <retroforge/time/remesher.h>

#include <limits>
#include <optional>

namespace retroforge
{
  /// Why a solved or unsolvable increment is rejected, and must be shorter.
  struct StepRejection
  {
    std::string  reason;
    unsigned int halvings     = 1;     ///< that will do
    bool         of_mesh      = true;  ///< a better mesh may be enough
    bool         is_full      = false; ///< there is no room for the metal
    bool         for_accuracy = false; ///< the increment is sound
    bool         is_bearable  = false; ///< it goes less than twice as far as it may
  };

  /// The end of a forging in which there is no room left for the metal: no other numerics help.
  struct NoRoom : Error
  {
    using Error::Error;
  };

  /// What increments and runs may do. An increment that does more is rejected, a run that does more is
  /// stopped, each with the reason.
  class IncrementLimits
  {
  public:
    /// What is passed must live as long.
    IncrementLimits(const ForgingModel &model, const PressParameters &press, const Remesher &remesher)
        : model_(model), press_(press), remesher_(remesher)
    {
    }

    /// Returns why an increment that was solved, from X to X_next, is rejected, if it is.
    std::optional<StepRejection> rejection(const Process<double>      &process,
                                           const MeshEpoch            &epoch,
                                           const IncrementRecord      &record,
                                           const NodalVectors<double> &X,
                                           const NodalVectors<double> &X_next) const;

    /// Returns why one that has no solution is.
    static StepRejection singular(const ForgingState &state);

    /// Of nodes along curved dies in an increment, over the edge length wanted there; 0 without remeshing.
    double slip(const Process<double>      &process,
                const IncrementRecord      &record,
                const NodalVectors<double> &X,
                const NodalVectors<double> &X_next) const
    {
      return largest_slip(process, record, X, X_next).of_edge;
    }

    /// Whether nodes may slip that far, over the edge length wanted there.
    bool allow(const double slip) const { return slip <= press_.largest_slip; }

    /// Whether the metal may be strained that far in an increment, in the mean over where it flows.
    bool allow_strain(const double strain) const
    {
      return !press_.largest_strain || strain <= *press_.largest_strain;
    }

    /// Whether a step that is repeated may be expected to go less than twice as far as it may.
    /// @param state  before it
    bool bear(const ForgingState &state, double step) const;

    /// Returns why an increment that strains the metal so is too long for the accuracy, if it is.
    std::optional<StepRejection> strain_rejection(double strain) const;

    /// Returns the longest step that strain allows where a mm of stroke strains the metal so; infinite where it
    /// does not matter [mm].
    double borne_step(const double strain_rate) const
    {
      return press_.largest_strain && strain_rate > 0. ? *press_.largest_strain / strain_rate
                                                       : std::numeric_limits<double>::infinity();
    }

    /// Whether steps follow from the accuracy that is wanted: what contact measures in increments then follows
    /// each step.
    bool choose_steps() const { return press_.largest_strain.has_value(); }

    /// Whether an increment presses metal into dies that has no room between them.
    /// @param X  positions after it
    bool is_full(const Process<double>      &process,
                 const Scene                &scene,
                 const IncrementRecord      &record,
                 const NodalVectors<double> &X) const;

    /// Whether an increment may not be halved any more.
    bool too_short(double step) const;

    /// Ends a run in which an increment that may not be halved any more is rejected.  @throws Error
    [[noreturn]] void stop(const Process<double> &process,
                           const ForgingState    &state,
                           const IncrementRecord &record,
                           const StepRejection   &rejection) const;

    /// Where a solved increment presses a billet aside that nothing but the hold of what is loose holds.
    /// @throws Error
    void check_hold(const Process<double> &process,
                    const ForgingState    &state,
                    const IncrementRecord &record) const;

    /// Where a run can only go on to no good: it takes too many increments, or loses its volume.
    /// @throws Error
    void check_progress(const ForgingState &state) const;

    /// Where metal meets metal, which is not in the model, or more has been taken away in such places than may be.
    /// @throws Error
    void check_fold(const ForgingState &state) const;

  private:
    struct Slip
    {
      double      of_edge = 0.; ///< slipped, over the edge length wanted there
      std::string where;
    };

    /// Returns which limit a cell or its edges violate, if any.
    /// @param slack  by which they may go farther
    std::optional<std::string> violated_limit(const TetMesh              &mesh,
                                              CellIndex                   c,
                                              const NodalVectors<double> &X,
                                              const NodalVectors<double> &X_next,
                                              double                      slack) const;
    /// Returns that of the first cell that violates one. Collective.
    std::optional<std::string> violated_limit(const Scene                &scene,
                                              const NodalVectors<double> &X,
                                              const NodalVectors<double> &X_next,
                                              double                      slack = 1.) const;
    Slip                       largest_slip(const Process<double>      &process,
                                            const IncrementRecord      &record,
                                            const NodalVectors<double> &X,
                                            const NodalVectors<double> &X_next) const;
    /// The shortest increment [mm].
    double shortest() const;

    /// A body that nothing holds has no velocity, however fine its mesh is.  @throws Error  where that is so
    void check_held(const Process<double> &process,
                    const ForgingState    &state,
                    const IncrementRecord &record,
                    const std::string     &what) const;

    const ForgingModel    &model_;
    const PressParameters &press_;
    const Remesher        &remesher_;
  };
} // namespace retroforge
