// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/objective/path_objective.h>

#include <string>
#include <vector>

/// @file
/// How far slopes can be trusted, by what a run knows of itself. They are exact for the run as it was decided; a
/// neighbouring design decides otherwise, in remeshings above all. How far single slopes are off those of lines
/// through nearby designs was measured on some scenes (doc/manual/gradients.md); what is told is the largest of
/// those in the class that a value is of, and no estimate for the scene at hand: the scatter of a slope is
/// not seen in one run.
namespace retroforge
{
  /// What an increment decided.
  struct IncrementDecisions
  {
    double       begin, end; ///< stroke, of all operations [mm]
    bool         remeshed;   ///< it began on a new mesh
    unsigned int cuts;       ///< times it was halved
  };

  /// The part of a run that a value is made of.
  struct ValueSpan
  {
    double       begin = 0., end = 0.; ///< stroke [mm]
    double       part       = 0.;      ///< of the path, as many increments as count alike
    unsigned int remeshings = 0;       ///< within: between two increments that count
    unsigned int cuts       = 0;       ///< increments within that were halved
    unsigned int remeshed   = 0;       ///< within and before, but for one before the first increment

    /// Metal was deeper in a die, or edges spanned more of its corners, than needs no word: what it takes to come out
    /// again follows single nodes.
    bool in_die = false;

    /// Few increments make the value.
    bool is_short() const { return part < 0.35; }
  };

  /// Returns by how much each increment counts: the sizes of the parts that its integrals have in the value, over
  /// their sum.
  std::vector<double> shares_of_increments(const PathObjective &objective, const PathRows<double> &rows);

  /// An increment counts with a hundredth of the share of the one that counts most.
  ValueSpan span_of(const std::vector<double> &shares, const std::vector<IncrementDecisions> &run);

  /// Returns what a user must know of a value that few increments make and that remeshings or cuts lie within;
  /// "" for others.
  std::string note_on(const ValueSpan &span);

  /// Returns how far a slope of a value that follows from forces holds, in a few words.
  /// @param effect  what 1 % of the parameter does to the value, over the value
  /// @param is_proportional  the value is proportional to the parameter, which moves no metal
  std::string trust_in_slope(const ValueSpan &span, double effect, bool is_proportional);

  /// Returns the same of a temperature at the end: that it does not hold, where meshes are made anew and that scatters
  /// the temperature by as much as 1 % of the parameter changes it; "" where nothing is known.
  /// @param remeshed  increments on a new mesh, but for the first
  /// @param effect    of 1 % of the parameter [K]
  std::string trust_in_slope_of_temperature(unsigned int remeshed, double effect);

  /// Returns the same of a value of the metal as it is in the end, its shape or its strains: no class of slopes is known that
  /// holds; "" where the mesh is the first one.
  std::string trust_in_slope_of_final_state(unsigned int remeshed);
} // namespace retroforge
