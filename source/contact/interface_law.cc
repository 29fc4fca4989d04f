// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/contact/interface_law.h>

namespace retroforge
{
  namespace
  {
    bool has_friction(const ContactNode<double> &node)
    {
      return node.Sf * node.alpha != 0.;
    }
  } // namespace

  template <typename Number>
  Vector3<Number> contact_force(const ContactNode<Number> &node,
                                const MaterialLaw<Number> &law,
                                const ContactLaw<Number>  &contact)
  {
    Vector3<Number> force;
    if (node.active)
      force += node.n * Number(contact.rho * node.S * approach_excess(node));
    if (value_of(node.Sf) * value_of(node.alpha) != 0.)
    {
      const Vector3<Number> dv = slip(node);
      force += dv * FrictionLaw<Number>{law, contact}(Number(node.Sf * node.alpha), Number(dv * dv));
    }
    return force;
  }

  template <typename Number>
  Number friction_power(const ContactNode<Number> &node,
                        const MaterialLaw<Number> &law,
                        const ContactLaw<Number>  &contact)
  {
    if (value_of(node.Sf) * value_of(node.alpha) == 0.)
      return Number(0.);
    const Vector3<Number> dv  = slip(node);
    const Number          dv2 = dv * dv;
    return FrictionLaw<Number>{law, contact}(Number(node.Sf * node.alpha), dv2) * dv2;
  }

  double contact_potential(const ContactNode<double> &node,
                           const MaterialLaw<double> &law,
                           const ContactLaw<double>  &contact)
  {
    const double              h   = node.active ? approach_excess(node) : 0.;
    const Vec3                dv  = slip(node);
    const double              dv2 = dv * dv;
    const FrictionLaw<double> friction{law, contact};
    return 0.5 * contact.rho * node.S * h * h +
           (has_friction(node) ? friction(node.Sf * node.alpha, dv2) * friction.potential_ratio(dv2) : 0.);
  }

  dealii::Tensor<2, 3> contact_tangent(const ContactNode<double> &node,
                                       const MaterialLaw<double> &law,
                                       const ContactLaw<double>  &contact)
  {
    dealii::Tensor<2, 3> tangent;
    if (node.active)
      tangent += contact.rho * node.S * outer_product(node.n, node.n);
    if (has_friction(node))
    {
      const Vec3                dv  = slip(node);
      const double              dv2 = dv * dv;
      const FrictionLaw<double> friction{law, contact};
      const double              factor = friction(node.Sf * node.alpha, dv2);
      tangent -= factor * outer_product(node.n, node.n);
      for (unsigned int i = 0; i < 3; ++i)
        tangent[i][i] += factor;
      if (const double slope = friction.slope(dv2); slope != 0.)
        tangent += factor * slope * outer_product(dv, dv);
    }
    return tangent;
  }

  ContactNodeBar reverse_contact_force(const ContactNode<double> &node,
                                       const MaterialLaw<double> &law,
                                       const ContactLaw<double>  &contact,
                                       const Vec3                &lambda)
  {
    ContactNodeBar bar;
    double         h_bar = 0.;
    if (node.active)
    {
      const double h = approach_excess(node), lambda_n = lambda * node.n;
      h_bar           = contact.rho * node.S * lambda_n;
      bar.S           = contact.rho * h * lambda_n;
      bar.n           = contact.rho * node.S * h * lambda;
      bar.contact.rho = node.S * h * lambda_n;
    }
    Vec3 dv_bar;
    if (has_friction(node))
    {
      const Vec3                dv  = slip(node);
      const double              dv2 = dv * dv, product = lambda * dv;
      const FrictionLaw<double> friction{law, contact};
      const double              factor = friction(node.Sf * node.alpha, dv2);
      bar.Sf                           = factor * product / node.Sf;
      bar.alpha                        = factor * product / node.alpha;
      friction.reverse(dv2, factor * product, bar.law, bar.contact);
      dv_bar = factor * (lambda + friction.slope(dv2) * product * dv);
    }
    reverse_kinematics(node, dv_bar, h_bar, bar);
    return bar;
  }

  ContactNodeBar reverse_friction_power(const ContactNode<double> &node,
                                        const MaterialLaw<double> &law,
                                        const ContactLaw<double>  &contact,
                                        const double               weight)
  {
    ContactNodeBar bar;
    if (!has_friction(node))
      return bar;
    const Vec3                dv  = slip(node);
    const double              dv2 = dv * dv;
    const FrictionLaw<double> friction{law, contact};
    const double              factor = weight * friction(node.Sf * node.alpha, dv2);
    bar.Sf                           = factor * dv2 / node.Sf;
    bar.alpha                        = factor * dv2 / node.alpha;
    friction.reverse(dv2, factor * dv2, bar.law, bar.contact);
    reverse_kinematics(node, factor * (2. + friction.slope(dv2) * dv2) * dv, 0., bar);
    return bar;
  }

#define RETROFORGE_INSTANTIATE(Number)                                                     \
  template Vector3<Number> contact_force(                                                  \
    const ContactNode<Number> &, const MaterialLaw<Number> &, const ContactLaw<Number> &); \
  template Number friction_power(                                                          \
    const ContactNode<Number> &, const MaterialLaw<Number> &, const ContactLaw<Number> &);
  RETROFORGE_INSTANTIATE(double)
  RETROFORGE_INSTANTIATE(Dual)
#undef RETROFORGE_INSTANTIATE
} // namespace retroforge
