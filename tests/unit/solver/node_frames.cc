// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The axes in which a node's velocities are solved for. Proved, for linear and for quadratic velocities: each
// frame is orthonormal to rounding, however close to one another the normals that made it; the normal of a
// symmetry plane is the first axis; and a die that holds a node has an axis of its own, also where the node
// lies between it and a die that does not. In two and three dimensions, axes are completed to a basis, nearly
// parallel directions are not taken twice, and momentum is tested so that a tangent couples the stiffest axis
// with the others alike in both directions.

#include <deal.II/base/mpi.h>

#include <retroforge/solver/node_frames.h>

#include "corner_stage.h"

using namespace retroforge;

namespace
{
  const char *answer(const bool yes)
  {
    return yes ? "yes" : "NO";
  }

  template <int dim>
  double deviation(const VelocityFrame<dim> &frame)
  {
    double largest = 0.;
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        largest = std::max(largest, std::abs(frame.axes[i] * frame.axes[j] - (i == j ? 1. : 0.)));
    return largest;
  }

  template <int dim>
  dealii::Tensor<1, dim> direction(Random &random)
  {
    dealii::Tensor<1, dim> x;
    for (unsigned int i = 0; i < dim; ++i)
      x[i] = random.scalar();
    return x;
  }

  template <int dim>
  void check_algebra()
  {
    Random random;
    double deviations = 0., asymmetry = 0.;
    bool   taken_once = true;
    for (unsigned int n = 0; n < 200; ++n)
    {
      VelocityFrame<dim> frame;
      frame.identity   = false;
      const auto first = direction<dim>(random);
      append_axis<dim>(frame.axes, 0, first);
      taken_once =
        taken_once && append_axis<dim>(frame.axes, 1, 2. * first + 1e-4 * direction<dim>(random)) == 1;
      complete_axes(frame.axes, 1);
      deviations  = std::max(deviations, deviation(frame));
      frame.tests = frame.axes;
      // In the axes; with the stiffest first.
      dealii::Tensor<2, dim> tangent;
      for (unsigned int i = 0; i < dim; ++i)
        tangent[i] = direction<dim>(random);
      tangent[0][0] = 7.;
      choose_tests(tangent, frame);
      const dealii::Tensor<2, dim> tested = frame.tests * transpose(frame.axes) * tangent;
      for (unsigned int i = 1; i < dim; ++i)
        asymmetry = std::max(asymmetry, std::abs(tested[i][0] - tested[0][i]));
    }
    std::cout << dim << "D, completed to 1e-14: " << answer(deviations < 1e-14)
              << "; a direction is taken once: " << answer(taken_once)
              << "; tested symmetrically: " << answer(asymmetry < 1e-13) << "\n";
  }

  bool symmetry_first(const CornerStage &corner, const std::vector<NodeFrame> &frames)
  {
    bool first = true;
    for (NodeIndex k = 0; k < frames.size(); ++k)
      for (const Vec3 &direction : corner.scene.discretization.fixed_directions(k))
        first &= std::abs(std::abs(frames[k].axes[0] * direction) - 1.) < 1e-14;
    return first;
  }

  /// Nodes whose own contact with a die holds, while the one with the other die does not: how many there are,
  /// and whether the first axis that is free is the holding one's normal, but for what symmetry fixes.
  std::pair<unsigned int, bool> holding_first(const CornerStage &corner, const std::vector<NodeFrame> &frames)
  {
    std::vector<const Vec3 *> holding(frames.size(), nullptr);
    std::vector<unsigned int> n_pairs(frames.size(), 0), n_holding(frames.size(), 0);
    for (unsigned int p = 0; p < corner.contact.pairs.size(); ++p)
      if (const ContactPoint &point = corner.contact.pairs[p].point; point.has_own_velocity())
      {
        const NodeIndex k = point.velocity_node_at(0);
        ++n_pairs[k];
        if (corner.active[p] != 0)
        {
          ++n_holding[k];
          holding[k] = &corner.contact.projections[p].n;
        }
      }
    unsigned int between = 0;
    bool         first   = true;
    for (NodeIndex k = 0; k < frames.size(); ++k)
      if (n_pairs[k] == 2 && n_holding[k] == 1 && frames[k].n_fixed < 2)
      {
        ++between;
        Vec3 rest = *holding[k];
        for (unsigned int i = 0; i <= frames[k].n_fixed; ++i)
          rest -= (frames[k].axes[i] * *holding[k]) * frames[k].axes[i];
        first &= rest.norm() < 1e-14;
      }
    return {between, first};
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const ElementPair pair : {ElementPair::mini, ElementPair::taylor_hood})
  {
    Random      random;
    CornerStage corner(random, 10., pair);
    // Whichever of the two dies holds a node.
    for (auto &active : corner.active)
      active = random.scalar() > 0.;
    const auto frames  = make_frames(corner.scene, corner.contact, corner.active);
    double     largest = 0.;
    for (const NodeFrame &frame : frames)
      largest = std::max(largest, deviation(frame));
    const auto [between, first] = holding_first(corner, frames);
    std::cout << (pair == ElementPair::mini ? "linear" : "quadratic")
              << " velocities, orthonormal to 1e-14: " << answer(largest < 1e-14)
              << "; symmetry first: " << answer(symmetry_first(corner, frames))
              << "; nodes between two dies: " << answer(between > 3)
              << "; the holding die first there: " << answer(first) << "\n";
  }
  check_algebra<2>();
  check_algebra<3>();
}
