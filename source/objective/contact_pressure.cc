// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/objective/contact_pressure.h>
#include <retroforge/objective/contact_pullback.h>

namespace retroforge
{
  namespace
  {
    /// Is pair p one of the die's, on a node of this rank?
    template <typename Number>
    bool is_mine(const StageView<Number> &view, const unsigned int p, const unsigned int die)
    {
      const ContactPair &pair = view.stage.contact.pairs[p];
      return pair.die == die && view.stage.scene.partition.owns(pair.node);
    }

    /// p_k over the reference, zero where the die does not press.
    template <typename Number>
    Number relative_pressure(const ContactNode<Number> &node, const Number &rho, const double reference)
    {
      const Number h = approach_excess(node);
      return node.active && value_of(h) > 0. ? Number(rho * h / reference) : Number(0.);
    }
  } // namespace

  ContactPressure::ContactPressure(const unsigned int die, const double exponent, const double reference)
      : die_(die), exponent_(exponent), reference_(reference)
  {
    if (!(exponent >= 1.))
      throw Error("Contact pressure",
                  "the exponent is " + std::to_string(exponent),
                  "it must be at least 1",
                  "use 10 to 50: the larger, the nearer to the maximum");
    if (!(reference > 0.))
      throw Error("Contact pressure",
                  "the reference is " + std::to_string(reference) + " MPa",
                  "it must be positive",
                  "use the pressure expected, or the consistency K");
  }

  double ContactPressure::largest(const StageView<double> &view) const
  {
    double largest = 0.;
    for (unsigned int p = 0; p < view.stage.contact.pairs.size(); ++p)
      if (is_mine(view, p, die_))
        largest =
          std::max(largest,
                   relative_pressure(
                     view.stage.contact_node(p, view.W, view.active), view.stage.physics.contact.rho, 1.));
    return largest;
  }

  template <typename Number>
  std::vector<Number> ContactPressure::compute_integrals(const StageView<Number> &view) const
  {
    const Stage<Number> &stage = view.stage;
    std::vector<Number>  sums(2, Number(0.));
    for (unsigned int p = 0; p < stage.contact.pairs.size(); ++p)
      if (is_mine(view, p, die_))
      {
        const ContactNode<Number> node     = stage.contact_node(p, view.W, view.active);
        const Number              pressure = relative_pressure(node, stage.physics.contact.rho, reference_);
        sums[0] += node.S * power(pressure, Number(exponent_));
        sums[1] += node.S * stage.contact.ramps[p];
      }
    return sums;
  }

  void ContactPressure::reverse_integrals(const StageView<double>   &view,
                                          const std::vector<double> &weights,
                                          StageBar                  &bar) const
  {
    const Stage<double> &stage = view.stage;
    ContactPullback      pullback(view, bar);
    for (unsigned int p = 0; p < stage.contact.pairs.size(); ++p)
      if (is_mine(view, p, die_))
      {
        const ContactNode<double> node     = stage.contact_node(p, view.W, view.active);
        const double              rho      = stage.physics.contact.rho;
        const double              pressure = relative_pressure(node, rho, reference_);
        ContactNodeBar            node_bar;
        node_bar.S = weights[0] * std::pow(pressure, exponent_) + weights[1] * stage.contact.ramps[p];
        bar.contact.ramp[p] += weights[1] * node.S;
        double h_bar = 0.;
        if (pressure > 0.)
        {
          const double slope =
            weights[0] * node.S * exponent_ * std::pow(pressure, exponent_ - 1.) / reference_;
          node_bar.rho = slope * approach_excess(node);
          h_bar        = slope * rho;
        }
        pullback.add(p, node_bar);
        pullback.add_excess(p, node, h_bar);
      }
    pullback.finish();
  }

  template std::vector<double> ContactPressure::compute_integrals(const StageView<double> &) const;
  template std::vector<Dual>   ContactPressure::compute_integrals(const StageView<Dual> &) const;
} // namespace retroforge
