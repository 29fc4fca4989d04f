// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/element/mini_element.templates.h>
#include <retroforge/solver/rigid_modes.h>

#include <deal.II/lac/lapack_full_matrix.h>

namespace retroforge
{
  namespace
  {
    /// How much farther from a die than the nearest node others may be and still touch it, over the size of
    /// the workpiece.
    constexpr double touching = 0.05;
    /// Eigenvalues below this, of one per resisting direction, are of free motions.
    constexpr double unresisted = 1e-8;
  } // namespace

  unsigned int
  n_free_rigid_modes(const Scene &scene, const Physics<double> &physics, const NodalVectors<double> &X)
  {
    Vec3 centre;
    for (const Vec3 &x : X)
      centre += x / static_cast<double>(X.size());
    double size = 0.;
    for (const Vec3 &x : X)
      size = std::max(size, (x - centre).norm());

    // Gram matrix of the velocities that the resisting directions see: zero eigenvalues are free motions.
    dealii::LAPACKFullMatrix<double> gram(6);
    double                           n_resisting = 0.;
    const auto                       resist      = [&](const NodeIndex k, const Vec3 &direction) {
      const Vec3            arm    = (X[k] - centre) / size;
      const Vec3            moment = cross(arm, direction);
      std::array<double, 6> row;
      for (unsigned int i = 0; i < 3; ++i)
      {
        row[i]     = direction[i];
        row[i + 3] = moment[i];
      }
      for (unsigned int i = 0; i < 6; ++i)
        for (unsigned int j = 0; j < 6; ++j)
          gram(i, j) += row[i] * row[j];
      n_resisting += 1.;
    };
    for (NodeIndex k = 0; k < X.size(); ++k)
      for (const Vec3 &direction : scene.topology.fixed_directions[k])
        resist(k, direction);
    for (unsigned int d = 0; d < scene.dies.size(); ++d)
    {
      double nearest = std::numeric_limits<double>::max();
      for (NodeIndex k = 0; k < X.size(); ++k)
        if (scene.topology.is_on_surface(k))
          nearest = std::min(nearest, scene.dies[d].signed_distance(X[k], physics.dies[d].displacement));
      for (NodeIndex k = 0; k < X.size(); ++k)
        if (scene.topology.is_on_surface(k))
        {
          const Vec3 &displacement = physics.dies[d].displacement;
          const auto  feature      = scene.dies[d].closest(X[k], displacement, nearest + touching * size);
          if (!feature.found())
            continue;
          const auto projection = scene.dies[d].project(X[k], displacement, feature);
          if (projection.delta > nearest + touching * size)
            continue;
          resist(k, projection.n);
          if (physics.dies[d].friction > 0.)
            for (unsigned int i = 0; i < 3; ++i)
            {
              Vec3 unit;
              unit[i] = 1.;
              resist(k, unit);
            }
        }
    }
    if (n_resisting == 0.)
      return 6;
    gram.compute_eigenvalues();
    unsigned int n_free = 0;
    for (unsigned int i = 0; i < 6; ++i)
      if (gram.eigenvalue(i).real() < unresisted * n_resisting)
        ++n_free;
    return n_free;
  }
} // namespace retroforge
