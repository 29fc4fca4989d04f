// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/optimization/design_space.h>
#include <retroforge/optimization/journal.h>
#include <retroforge/optimization/merit.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  /// Confidence of parameters determined from data, by the Jacobian  J_ij = (dv_i/dmu_j) / s_i  where they
  /// agree best: covariance  D (D^T J^T J D)^-1 D^T,  for data whose errors are independent and normal, with
  /// D the directions that bounds and relations leave free.
  struct Confidence
  {
    std::vector<unsigned int>        parameters;   ///< parameters inside their bounds
    std::vector<double>              deviations;   ///< standard ones, of each, in its unit
    std::vector<std::vector<double>> correlations; ///< between them
    double                           misfit = 0.;  ///< sum of ((v_i - d_i) / s_i)^2
    int freedom = 0; ///< data less free directions: what the misfit should be about
    /// A change of the parameters, in scales, that data do not see; empty where they see all.
    std::vector<double> unseen;

    /// Returns whether the misfit is beyond what errors of the given deviations make of it: by three
    /// deviations of chi square, and some for few data.
    bool disagrees() const { return misfit > freedom + 3. * std::sqrt(2. * std::max(freedom, 1)) + 4.; }

    /// Half width of the interval in which the parameter lies with 95 %.
    static constexpr double half_width_95 = 1.959963984540054; // of a normal distribution, in deviations
  };

  /// @param best  with gradients
  Confidence confidence_of(const Criteria &criteria, const DesignSpace &space, const Evaluation &best);
} // namespace retroforge
