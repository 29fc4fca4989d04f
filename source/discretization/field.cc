// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/discretization/field.h>

namespace retroforge
{
  template <int dim>
  FlowField<dim, double> interpolated(const Discretization<dim>                 &discretization,
                                      const std::vector<dealii::Tensor<1, dim>> &V,
                                      const std::vector<double>                 &P)
  {
    AssertDimension(V.size(), discretization.n_vertices());
    AssertDimension(P.size(), discretization.pressure_nodes()->n());
    FlowField<dim, double> W(discretization);
    for (unsigned int place = 0; place < W.V.size(); ++place)
    {
      const NodeIndex k = discretization.velocity_nodes()->node_at(place);
      if (k < V.size())
        W.V.at_place(place) = V[k];
      else if (discretization.middles())
      {
        const auto [a, b]   = discretization.middles()->ends_of(k);
        W.V.at_place(place) = 0.5 * (V[a] + V[b]);
      }
    }
    W.P.take(P);
    return W;
  }

  template FlowField<2, double> interpolated(const Discretization<2> &,
                                             const std::vector<dealii::Tensor<1, 2>> &,
                                             const std::vector<double> &);
  template FlowField<3, double> interpolated(const Discretization<3> &,
                                             const std::vector<dealii::Tensor<1, 3>> &,
                                             const std::vector<double> &);
} // namespace retroforge
