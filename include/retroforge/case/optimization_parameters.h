// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/base/parameter_handler.h>

#include <map>
#include <string>
#include <vector>

namespace retroforge
{
  /// Objective, parameters and limits of `optimize`: the section `Optimisation`.
  struct OptimizationParameters
  {
    using Values = std::multimap<std::string, double>; ///< by name

    std::vector<std::string> objective; ///< names; empty: all objectives without a limit
    Values                   at_most;   ///< limits of objectives, in their units
    Values                   at_least;
    Values                   data;          ///< measured values of objectives, in their units
    Values                   uncertainties; ///< their standard deviations
    Values                   lower;         ///< bounds of design parameters, in their units
    Values                   upper;
    std::vector<std::string> relations; ///< linear, of design parameters
    Values                   scales;    ///< changes of design parameters that matter alike
    double                   first_step         = 1.;
    double                   largest_step       = 20.;
    unsigned int             iterations         = 30;
    unsigned int             simulations        = 100;
    double                   gradient_tolerance = 1e-3;
    double                   least_gain         = 1e-3;
    double                   limit_tolerance    = 1e-4;
    unsigned int             noise_runs         = 3;
    double                   mesh_quality = 0.2; ///< least, of the billet's cells before forging; 0: any
    double                   confirmation = 0.7;
    unsigned int             corrections  = 2; ///< of limits, by confirmations
    bool                     keep_records = false;

    std::string         scattered;       ///< a design parameter that is not known exactly; empty: none
    std::vector<double> scatter_range;   ///< from, to
    unsigned int        samples    = 3;  ///< number of samples of it
    double              deviations = 1.; ///< lambda in mean + lambda sigma

    std::vector<std::string> operations; ///< files of other cases that are forged with each design

    unsigned int side_by_side = 1; ///< groups of ranks, each with its share of a design's forgings

    void add_parameters(dealii::ParameterHandler &prm);
    /// @throws Error
    void check() const;

  private:
    void check_data() const;
    void check_limits() const;
  };
} // namespace retroforge
