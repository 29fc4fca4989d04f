// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/case/optimization_parameters.h>
#include <retroforge/design/design.h>
#include <retroforge/optimization/linear_relation.h>

namespace retroforge
{
  /// A parameter of the billet that follows from the others, because it holds the volume, and where a user
  /// wants it to stay: a limit, as objectives have them.
  struct HeldParameter
  {
    std::string name, unit;
    double      lower, upper; ///< may be infinite
  };

  /// The design parameters as an optimiser sees them: changes from the start in units of their scales,
  /// x_j = (mu_j - start_j) / scale_j,  between bounds and related to each other as a user asks. Those that
  /// are not varied stay where they start.
  class DesignSpace
  {
  public:
    /// @param varied  names of the parameters that an optimiser may change
    /// @param start   values where the optimisation begins
    /// @param held    the parameter that follows from the volume, which may have bounds, too
    /// @throws Error  for names that are not among the parameters, bounds that cross, a start outside of them
    /// or of a relation
    DesignSpace(const std::vector<DesignParameter>   &parameters,
                const std::vector<std::string>       &varied,
                const std::vector<double>            &start,
                const OptimizationParameters         &optimization,
                const std::optional<DesignParameter> &held = {});

    const std::optional<HeldParameter> &held() const { return held_; }

    std::size_t                         size() const { return start_.size(); }
    const std::vector<DesignParameter> &parameters() const { return parameters_; }
    const std::vector<double>          &start() const { return start_; }
    const std::vector<double>          &scales() const { return scales_; }
    const std::vector<double>          &lower() const { return lower_; } ///< in terms of mu
    const std::vector<double>          &upper() const { return upper_; }

    /// Bounds of x.
    std::vector<double> scaled_lower() const { return scaled(lower_); }
    std::vector<double> scaled_upper() const { return scaled(upper_); }

    const std::vector<LinearRelation> &relations() const { return relations_; } ///< in terms of mu
    /// Relations in terms of x, each with weights of length 1.
    const std::vector<LinearRelation> &scaled_relations() const { return scaled_relations_; }
    /// Returns whether a relation holds as an equation at mu.
    bool holds_as_equation(const std::vector<double> &mu, std::size_t relation) const;

    std::vector<double> scaled(const std::vector<double> &mu) const;
    /// mu(x), within its bounds in spite of rounding.
    std::vector<double> values(const std::vector<double> &x) const;
    /// d/dx from d/dmu.
    std::vector<double> pull_back(const std::vector<double> &by_mu) const;

    enum class At
    {
      fixed, ///< not varied
      inside,
      lower,
      upper
    };
    At at(const std::vector<double> &mu, std::size_t j) const;
    /// The point nearest to x within the bounds and relations.
    std::vector<double> projected(std::vector<double> x) const;
    /// Orthonormal directions along which x can go from mu without leaving a bound or a relation it is at.
    std::vector<std::vector<double>> free_directions(const std::vector<double> &mu) const;
    /// Length of  P(x - g) - x,  with P onto bounds and relations: 0 at an optimum.
    double projected_length(const std::vector<double> &mu, const std::vector<double> &by_mu) const;

  private:
    std::vector<DesignParameter> parameters_;
    std::vector<double>          start_, scales_, lower_, upper_;
    std::vector<LinearRelation>  relations_, scaled_relations_;
    std::optional<HeldParameter> held_;

    void read_relations(const std::vector<std::string> &texts, const std::vector<std::string> &varied);
  };

  /// Returns the change of an objective per unit of the bound of each relation, at an optimum: the
  /// multipliers nu with the least  |g - sum_r nu_r weights_r|  over variables that no bound holds; 0 of
  /// relations that do not hold as equations.
  /// @param by_mu  derivative of the objective, limits included, by mu
  std::vector<double> slopes_of_relations(const DesignSpace         &space,
                                          const std::vector<double> &mu,
                                          const std::vector<double> &by_mu);
} // namespace retroforge
