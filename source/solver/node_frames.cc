// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/solver/node_frames.h>

#include <deal.II/base/symmetric_tensor.h>

namespace retroforge
{
  template <int dim>
  unsigned int
  append_axis(dealii::Tensor<2, dim> &axes, const unsigned int n, dealii::Tensor<1, dim> direction)
  {
    if (n == dim)
      return dim;
    // Twice, for what is left of a direction close to the span is as inexact as it is short.
    for (const bool again : {false, true})
    {
      for (unsigned int i = 0; i < n; ++i)
        direction -= (axes[i] * direction) * axes[i];
      if (!again && direction.norm() < 1e-3)
        return n;
    }
    axes[n] = direction / direction.norm();
    return n + 1;
  }

  template <int dim>
  void complete_axes(dealii::Tensor<2, dim> &axes, unsigned int n)
  {
    for (unsigned int i = 0; i < dim && n < dim; ++i)
    {
      dealii::Tensor<1, dim> unit;
      unit[(i + 1) % dim] = 1.;
      // A direction far from the axes there are keeps the completion well conditioned.
      dealii::Tensor<1, dim> rest = unit;
      for (unsigned int j = 0; j < n; ++j)
        rest -= (axes[j] * unit) * axes[j];
      if (rest.norm() > 0.5)
        n = append_axis(axes, n, unit);
    }
  }

  std::vector<NodeFrame>
  make_frames(const Scene &scene, const ContactSet<double> &contact, const ActiveSet &active)
  {
    const NodeNumbering      &nodes = *scene.discretization.condensed_nodes();
    std::vector<NodeFrame>    frames(nodes.n_places());
    std::vector<unsigned int> n_axes(nodes.n_places(), 0);
    const auto                append = [&](const unsigned int k, const Vec3 &direction) {
      n_axes[k] = append_axis(frames[k].axes, n_axes[k], direction);
    };
    for (unsigned int k = 0; k < frames.size(); ++k)
    {
      for (const Vec3 &direction : scene.discretization.fixed_directions(k))
        append(k, direction);
      frames[k].n_fixed = n_axes[k];
    }
    // Contacts that hold come first, for only their penalties must stand on single axes; nodes come before
    // edges, so that a node that is held by itself has its own normal for an axis.
    for (const bool holds : {true, false})
      for (const bool of_nodes : {true, false})
        for (unsigned int p = 0; p < contact.pairs.size(); ++p)
          if (const ContactPoint &point = contact.pairs[p].point;
              (active[p] != 0) == holds && point.has_own_velocity() == of_nodes)
            for (unsigned int i = 0; i < point.n_velocity_nodes(); ++i)
              append(nodes.place(point.velocity_node_at(i)), contact.projections[p].n);
    for (unsigned int k = 0; k < frames.size(); ++k)
      if (n_axes[k] == 0)
        frames[k].axes = dealii::unit_symmetric_tensor<3>();
      else
      {
        frames[k].identity = false;
        complete_axes(frames[k].axes, n_axes[k]);
      }
    for (NodeFrame &frame : frames)
      frame.tests = frame.axes;
    return frames;
  }

  template <int dim>
  void choose_tests(const dealii::Tensor<2, dim> &tangent, VelocityFrame<dim> &frame)
  {
    if (frame.n_fixed == dim)
      return;
    unsigned int p = frame.n_fixed;
    for (unsigned int i = p + 1; i < dim; ++i)
      if (tangent[i][i] > tangent[p][p])
        p = i;
    for (unsigned int i = frame.n_fixed; i < dim; ++i)
      if (const double difference = tangent[i][p] - tangent[p][i]; difference != 0.)
      {
        frame.tests[i] -= difference / tangent[p][p] * frame.axes[p];
        frame.identity = false;
      }
  }

#define RETROFORGE_INSTANTIATE(dim)                                                                  \
  template unsigned int append_axis(dealii::Tensor<2, dim> &, unsigned int, dealii::Tensor<1, dim>); \
  template void         complete_axes(dealii::Tensor<2, dim> &, unsigned int);                       \
  template void         choose_tests(const dealii::Tensor<2, dim> &, VelocityFrame<dim> &);
  RETROFORGE_INSTANTIATE(2)
  RETROFORGE_INSTANTIATE(3)
#undef RETROFORGE_INSTANTIATE
} // namespace retroforge
