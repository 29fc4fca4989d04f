// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/objective/objective_type.h>
#include <retroforge/objective/path_maximum.h>

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
  class ContactPressure : public PathMaximumOf<ContactPressure>
  {
  public:
    /// @param exponent, reference  of PathMaximumOf   @throws Error
    ContactPressure(unsigned int die, double exponent, double reference);

    std::string name() const override { return "contact pressure"; }

    void reverse_integrals(const EquilibriumView<double> &view,
                           const std::vector<double>     &weights,
                           EquilibriumBar                &bar) const override;

    template <typename Number>
    std::vector<Number> compute_integrals(const EquilibriumView<Number> &view) const;

  private:
    unsigned int die_;
  };

  /// Returns the type of this objective, as parameter files offer it.
  Choice<ObjectiveType>::Maker contact_pressure_type();
} // namespace retroforge
