// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/record/increment_record.h>
#include <retroforge/solver/equilibrium.h>
#include <retroforge/steps/press_motion.h>

#include <algorithm>

namespace retroforge
{
  /// One increment's place, fixed by decision: in an operation, from `stroke` on by `step` [mm]. The times
  /// follow.
  struct StrokeStep
  {
    double       stroke, step;
    unsigned int operation = 0;
  };

  /// Returns that of a recorded increment.
  inline StrokeStep place(const IncrementRecord &record)
  {
    return {record.stroke, record.step, record.operation};
  }

  /// One stroke of the press: which dies stand in it, how it goes, and what comes before.
  template <typename Number>
  struct Operation
  {
    std::vector<unsigned int> dies;            ///< those in the press
    unsigned int              leading_die = 0; ///< whose path is the stroke
    /// Path of the leading die over the stroke, which is that of the nominal design: not 1 where this die
    /// follows a billet whose height has changed, or where the press begins earlier (case/earlier_start.h).
    Number              path_scale = Number(1.);
    PressMotion<Number> motion;
    /// How far it goes in the nominal design [mm]. A run divides it into increments by decision: nothing is
    /// differentiated by it.
    Number          stroke  = Number(0.);
    Waiting<Number> waiting = {}; ///< before its stroke

    template <typename Self>
    static auto members(Self &self)
    {
      auto &[dies, leading_die, path_scale, motion, stroke, waiting] = self;
      return std::tie(dies, leading_die, path_scale, motion, stroke, waiting);
    }

    /// Returns whether a die stands in the press.
    bool has(const unsigned int die) const { return std::find(dies.begin(), dies.end(), die) != dies.end(); }
  };

  /// Everything about the process that a design can change: the material, the dies of all operations, and the
  /// operations. Derivatives of a scalar in it are another such aggregate. `dies[d].displacement` is the
  /// die's offset at the start of its operation, `velocity` that of a press at constant speed. Time follows
  /// the stroke: the path of the leading die, at its speed, by the motion of the press.
  template <typename Number>
  struct Process
  {
    Material<Number>               material;
    ContactLaw<Number>             contact;
    std::vector<DieState<Number>>  dies;
    std::vector<Operation<Number>> operations;
    HeatLaw<Number>                heat = {};

    template <typename Self>
    static auto members(Self &self)
    {
      auto &[material, contact, dies, operations, heat] = self;
      return std::tie(material, contact, dies, operations, heat);
    }

    /// Returns the velocity of the leading die of an operation [mm/s].
    const Vector3<Number> &leading_velocity(unsigned int operation = 0) const;

    /// Returns its speed [mm/s].
    Number speed(unsigned int operation = 0) const;

    /// Returns the time that a press at constant speed takes to a stroke [s]: a die's path is this times its
    /// velocity, whatever the motion.
    Number nominal_time(double stroke, unsigned int operation = 0) const;

    /// Returns the time from the start of an operation to a stroke [s].
    Number time(double stroke, unsigned int operation = 0) const;

    /// Returns the time that an increment takes:  scale * path(stroke, step) / speed  [s].
    Number duration(const StrokeStep &at) const;

    /// Returns the end of the last operation.
    StrokeStep end() const;

    /// Returns the strokes of all operations up to one of an operation [mm].
    Number whole_stroke(double stroke, unsigned int operation) const;

    /// Returns the time from the start of the first stroke to a stroke of an operation, the waiting between them
    /// included [s].
    Number whole_time(double stroke, unsigned int operation) const;

    /// Returns the time on dies until then: under the press, and waiting before each stroke [s].
    Number time_on_dies(double stroke, unsigned int operation) const;

    /// Returns laws and dies when the leading die has gone `stroke` [mm] in an operation. Their velocities
    /// are those of a press at constant speed.
    Physics<Number> at_stroke(double stroke, unsigned int operation = 0) const;

    /// Returns laws and dies at the start of an increment, the dies with their mean velocities over it; dies
    /// that are not of its operation are not in the press.
    Physics<Number> over(const StrokeStep &at) const;
  };

  /// Looks at what comes before each stroke.
  /// @throws Error  for times that are not, and for a die to wait on that does not stand in the operation
  void check_waiting(const Process<double> &process);

  /// Pull-back of over(), dt = duration(), tau = approach dt, and whole_time() at the start: adds to process_bar.
  void reverse_over(const Process<double> &process,
                    const StrokeStep      &at,
                    double                 approach,
                    const PhysicsBar      &bar,
                    Process<double>       &process_bar);

  /// Returns zero derivatives in a process.
  /// @param dies  with their surfaces, whose vertices have derivatives
  Process<double> no_process_derivatives(const Process<double> &process, const std::vector<Die> &dies);
} // namespace retroforge
