// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/error.h>
#include <retroforge/solver/linear_system.h>

namespace retroforge
{
  struct NewtonParameters
  {
    double       tolerance      = 1e-8;
    double       forcing        = 1e-2;
    unsigned int max_iterations = 60;

    void add_parameters(dealii::ParameterHandler &prm);
  };

  /// No equilibrium was found: an increment that is shorter may have one that is.
  struct NoEquilibrium : Error
  {
    using Error::Error;
  };

  struct NewtonStatistics
  {
    unsigned int iterations = 0;
    unsigned int krylov     = 0;
    double       residual   = 0.; ///< relative, at the end
  };

  /// How well the start of Newton's method is known.
  enum class Origin
  {
    previous,   ///< the solution of the increment before, or of a longer one, on the same mesh
    transferred ///< interpolated from another mesh: strain rates are wrong here and there
  };

  /// Where Newton's method begins in the stages of an increment.
  struct InitialGuess
  {
    Field<double>                W;
    Origin                       origin = Origin::previous;
    std::optional<Field<double>> rate;       ///< of W over the stroke, where it is known
    double                       ahead = 0.; ///< stroke from W to the first stage [mm]

    /// Takes a solution ahead by `stroke`, as far as the rate tells.
    void advance(const double stroke, Field<double> &solution) const
    {
      if (rate)
        solution.add(stroke, *rate);
    }
  };

  /// Solves the equilibrium of a stage for W by Newton's method, with a line search on the power functional
  /// where the laws of contact have one (Equilibrium::has_potential()): the step length is a root of its slope
  /// along the step, monotone because the functional is convex in V. Where they have none, as where friction
  /// follows the pressure, the search is for a fall of the residual's norm, which Newton's step promises as
  /// well. A step that must be cut tells that the power law bends more than its tangent knows. Steps at
  /// constant viscosity (Picard) are short of no length: one follows each that was cut, and a start from afar
  /// begins with them. Bubbles settle after each step, so that what Newton's method sees is a functional of V
  /// and P alone: a bubble in metal that hardly flows would keep it from converging. At first the slope is
  /// that of the functional with the contacts of the step, and nodes that arrive do so at once
  /// (contact_steps.h); where that does not converge, of the functional itself. A slope that has
  /// become a fifth smaller is enough; where it has changed its sign, it must be a tenth, or that halfway must
  /// not be larger: then the functional is lower than at the start, or hardly higher. An iteration that does not
  /// settle ends in NoEquilibrium, and the increment is made shorter.
  class Newton
  {
  public:
    Newton(const Scene &scene, const NewtonParameters &parameters, LinearSystem &system);

    /// @param W       in: initial guess; out: the solution
    /// @param frozen   the recorded active set of a replay, which ends with a step below the tolerance
    /// @param pressed  the active set of a solution nearby, with the same pairs, where one is known
    NewtonStatistics solve(const Equilibrium<double> &stage,
                           Field<double>             &W,
                           const ActiveChoice        &frozen,
                           Origin                     origin  = Origin::previous,
                           const ActiveChoice        &pressed = {});

    /// The velocity field of a Newtonian metal under the same dies, as a start from nothing.
    void initial_guess(const Equilibrium<double> &stage,
                       Field<double>             &W,
                       const ActiveChoice        &frozen,
                       NewtonStatistics          &statistics);

  private:
    using Scale = std::pair<double, double>; ///< of momentum and continuity, as residual_scale

    double relative_residual(const Equilibrium<double> &stage,
                             const Field<double>       &W,
                             const ActiveChoice        &frozen,
                             const Scale               &scale,
                             Field<double>             &r);
    /// Advances W and returns the part of the velocity step that was taken.
    /// @param r       residual at W, with the same contacts
    /// @param active  the contacts that count throughout, where they are not decided at each step
    double search_power(const Equilibrium<double> &stage,
                        Field<double>             &W,
                        const Field<double>       &r,
                        const Field<double>       &step,
                        const ActiveChoice        &active);

    /// What a search begins with: the residual at W, its relative norm and scale, and the dies' speed.
    struct SearchStart
    {
      const Field<double> &r;
      double               residual;
      Scale                scale;
      double               speed;
    };

    /// The same by the residual's norm, bubbles settled: the step that search_power takes where it lowers
    /// that, else the longest of 1, 1/2, ... that does, or the one after which it is least.
    double search_residual(const Equilibrium<double> &stage,
                           Field<double>             &W,
                           const SearchStart         &start,
                           const Field<double>       &step,
                           const ActiveChoice        &active);

    /// search_power where the equilibrium has a potential, else search_residual.
    double search(const Equilibrium<double> &stage,
                  Field<double>             &W,
                  const SearchStart         &start,
                  const Field<double>       &step,
                  const ActiveChoice        &active);
    double slope(const Field<double> &r, const Field<double> &step) const;

    const Scene            &scene_;
    const NewtonParameters &parameters_;
    LinearSystem           &system_;
  };
} // namespace retroforge
