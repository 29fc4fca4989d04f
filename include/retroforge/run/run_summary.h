// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/adjoint/objective_sensitivity.h>
#include <retroforge/case/case.h>
#include <retroforge/output/summary.h>
#include <retroforge/run/forward_run.h>
#include <retroforge/run/slope_trust.h>
#include <retroforge/time/objective_trace.h>

namespace retroforge
{
  /// Returns the volume of the billet that the mesh stands for, whose round sides are no chords: that of the
  /// mesh, X_0, times the shape's over the mesh's where it was made. NaN for a billet that has no measures.
  /// To be called on one rank only.  Units: mm^3.
  double shape_volume(const Case &forging_case);

  /// Fills in what a summary says of the forging: counts, volumes, heat, restarts.
  /// @param process  that of the run
  void summarise_run(const Case            &forging_case,
                     const Process<double> &process,
                     const ForgingState    &forged,
                     Summary               &summary);

  /// Returns what to know of a run at whose end the metal is strained or warm beyond its table of flow stresses, or at
  /// temperatures where the numbers of its law do not hold.
  std::vector<std::string>
  beyond_law(const Case &forging_case, const Process<double> &process, const ForgingState &state);

  /// Returns how deep the surface is in a die at the end of an increment, and where. Collective.
  /// @param process  that of the run
  Summary::Depth
  depth_in_dies(const Case &forging_case, const Process<double> &process, const ForgingState &state);

  /// Returns what a user must know of a run that nothing watched on its way, by how it ends: metal inside a die, volume
  /// lost or won, strains beyond a table. Collective.
  std::vector<std::string> warnings_at_end(const Case &forging_case, const ForwardRun &run);

  /// Returns the part of the run that each objective is made of; nothing for those that do not follow from forces.
  std::vector<std::optional<ValueSpan>> spans_of(const Objectives                      &objectives,
                                                 const ObjectiveTrace                  &trace,
                                                 const std::vector<IncrementDecisions> &run);

  /// Fills in how far the derivatives of a combination of objectives hold; where one of them has no span, and it is no
  /// temperature, nothing.
  void judge_slopes(const Combination                           &combination,
                    const std::vector<std::optional<ValueSpan>> &spans,
                    const std::vector<IncrementDecisions>       &run,
                    const Design                                &design,
                    const std::vector<double>                   &mu,
                    ObjectiveSensitivity                        &sensitivity);

  /// Fills in the objectives.
  /// @param values  of each
  void summarise_objectives(const Case                                  &forging_case,
                            const ObjectiveTrace                        &trace,
                            const ForgingState                          &forged,
                            const std::vector<double>                   &values,
                            const std::vector<std::optional<ValueSpan>> &spans,
                            Summary                                     &summary);

  /// Fills in the design parameters, with the gradients.
  void summarise_gradients(const Case                              &forging_case,
                           const std::vector<ObjectiveSensitivity> &sensitivities,
                           Summary                                 &summary);
} // namespace retroforge
