// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/objective/objective_type.h>
#include <retroforge/objective/path_objective.h>

namespace retroforge
{
  /// Smooth maximum over nodes and time of the contact pressure on a die [MPa],
  ///   ( sum_i dt_i sum_k S_k p_k^gamma / sum_i dt_i sum_k S_k w_k )^(1/gamma),
  /// p_k the force that pushes a node of the mesh, that of its own and half of that of each edge at it, over
  /// S_k; k the nodes in reach of the die, S_k a third of the surface at k, w_k the friction ramp: the mean
  /// over the surface in contact. The same with linear and with quadratic velocities: these have an even
  /// pressure p load a middle with p/3 of each face at it and a vertex with nothing, half of which is p S_k.
  /// Where the die pulls, p_k counts as zero. The set of pressed points is frozen, as everywhere. Zero before
  /// any contact.
  class ContactPressure : public PathObjectiveOf<ContactPressure>
  {
  public:
    static constexpr unsigned int n_terms = 2;

    /// @param exponent   gamma >= 1, 10 to 50 for a maximum
    /// @param reference  a pressure of the expected size, so that p^gamma neither overflows nor vanishes: it
    /// cancels [MPa]  @throws Error
    ContactPressure(unsigned int die, double exponent, double reference);

    std::string name() const override { return "contact pressure"; }
    std::string unit() const override { return "MPa"; }

    void reverse_integrals(const EquilibriumView<double> &view,
                           const std::vector<double>     &weights,
                           EquilibriumBar                &bar) const override;

    template <typename Number>
    std::vector<Number> compute_integrals(const EquilibriumView<Number> &view) const;

    template <typename Number>
    std::vector<Number> terms(const PathRow<Number> &row, double) const
    {
      return {Number(row.dt * row.integrals[0]), Number(row.dt * row.integrals[1])};
    }

    template <typename Number>
    Number combine(const std::vector<Number> &sums, double) const
    {
      if (value_of(sums[1]) <= 0.)
        return Number(0.);
      return reference_ * power(Number(sums[0] / sums[1]), Number(1. / exponent_));
    }

  private:
    unsigned int die_;
    double       exponent_, reference_;
  };

  /// Returns the type of this objective, as parameter files offer it.
  Choice<ObjectiveType>::Maker contact_pressure_type();
} // namespace retroforge
