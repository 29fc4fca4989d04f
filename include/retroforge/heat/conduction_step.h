// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/heat/conduction_network.h>

#include <functional>

/// @file
/// One step in time of conduction between the nodes of a network and through films on it,
///   C_i dT_i/dt = sum_j g_ij (T_j - T_i) + sum_p phi_ip (t_p - T_i).
///
/// Two solutions are found: a bounded one by the implicit Euler scheme with conductances that are not negative (an M-matrix);
/// and one of second order by the L-stable two-stage scheme of Alexander, gamma = 1 - 1/sqrt(2). The heat flows in
/// which they differ, along edges and through films, are added to the bounded one as far as no node leaves the
/// range of its own and its neighbours' temperatures, before and bounded, and of those behind its films (as by Zalesak's
/// limiter, smoothed). So heat is conserved, nothing overshoots, and where the solution is smooth it is the second one.
namespace retroforge
{
  /// Films of the nodes: a conductance [mW/K], and it times the temperature behind it [mW].
  template <typename Number>
  struct NodeFilms
  {
    std::vector<Number> conductance, source;

    explicit NodeFilms(const std::size_t n) : conductance(n, Number(0.)), source(n, Number(0.)) {}
  };

  /// What a step is made of.
  template <typename Number>
  struct ConductionStep
  {
    const NetworkEdges        &edges;
    const std::vector<Number> &capacities;   ///< of nodes [mJ/K]
    const std::vector<Number> &conductances; ///< of edges [mW/K]
    const std::vector<Number> &bounded;      ///< those of the bounded solution, none negative [mW/K]
    Number                     dt;           ///< [s]
  };

  /// Films that follow the temperature: those at the start, and at the middle of the time.
  template <typename Number>
  using FilmsAt = std::function<NodeFilms<Number>(const std::vector<Number> &T)>;

  /// The temperatures after a step [C], the heat that went through the films of each node [mJ], in, and the temperatures
  /// with which films that stay as they are took it, means over the step [C].
  template <typename Number>
  struct ConductionResult
  {
    std::vector<Number> T, film_heat, at_films;
  };

  /// @param films  at given temperatures: asked for those at the start and for the mean of start and end
  template <typename Number>
  ConductionResult<Number> conduction_step(const ConductionStep<Number> &step,
                                           const std::vector<Number>    &T,
                                           const FilmsAt<Number>        &films);

  /// Derivatives of a scalar in what a step is made of.
  struct ConductionStepBar
  {
    std::vector<double> &capacities, &conductances, &bounded;
    double               dt = 0.;
  };

  /// Reverse of FilmsAt: takes the derivatives in films at given temperatures; adds those in the temperatures.
  using ReverseFilmsAt = std::function<
    void(const std::vector<double> &T, const NodeFilms<double> &bar, std::vector<double> &T_bar)>;

  /// What a reverse finds.
  struct ReversedConductionStep
  {
    std::vector<double> T_bar; ///< derivatives in the temperatures before
    std::vector<double> at_films;
  };

  /// @param T_bar, at_films_bar  derivatives in what the step makes
  ReversedConductionStep reverse_conduction_step(const ConductionStep<double> &step,
                                                 const std::vector<double>    &T,
                                                 const FilmsAt<double>        &films,
                                                 const std::vector<double>    &T_bar,
                                                 const std::vector<double>    &at_films_bar,
                                                 const ReverseFilmsAt         &reverse_films,
                                                 ConductionStepBar            &bar);
} // namespace retroforge
