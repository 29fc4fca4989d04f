// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/solver/node_frames.h>

#include <deal.II/base/symmetric_tensor.h>

namespace retroforge
{
  namespace
  {
    /// Appends `direction`, orthonormalised against the first n rows, unless it lies nearly in their span.
    unsigned int append_axis(dealii::Tensor<2, 3> &axes, const unsigned int n, Vec3 direction)
    {
      if (n == 3)
        return 3;
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
  } // namespace

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
        for (unsigned int i = 0; i < 3 && n_axes[k] < 3; ++i)
        {
          Vec3 unit;
          unit[(i + 1) % 3] = 1.;
          // A direction far from the axes there are keeps the completion well conditioned.
          Vec3 rest = unit;
          for (unsigned int j = 0; j < n_axes[k]; ++j)
            rest -= (frames[k].axes[j] * unit) * frames[k].axes[j];
          if (rest.norm() > 0.5)
            append(k, unit);
        }
      }
    for (NodeFrame &frame : frames)
      frame.tests = frame.axes;
    return frames;
  }

  void choose_tests(const dealii::Tensor<2, 3> &tangent, NodeFrame &frame)
  {
    if (frame.n_fixed == 3)
      return;
    unsigned int p = frame.n_fixed;
    for (unsigned int i = p + 1; i < 3; ++i)
      if (tangent[i][i] > tangent[p][p])
        p = i;
    for (unsigned int i = frame.n_fixed; i < 3; ++i)
      if (const double difference = tangent[i][p] - tangent[p][i]; difference != 0.)
      {
        frame.tests[i] -= difference / tangent[p][p] * frame.axes[p];
        frame.identity = false;
      }
  }
} // namespace retroforge
