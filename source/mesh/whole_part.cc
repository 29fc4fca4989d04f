// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/mesh/whole_part.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace retroforge
{
  namespace
  {
    constexpr double tolerance = 1e-6;

    /// Inside of the material, from one plane to the other [rad].
    double angle_between(const Plane &a, const Plane &b)
    {
      return dealii::numbers::PI - std::acos(std::clamp(a.normal * b.normal, -1., 1.));
    }
  } // namespace

  std::vector<Plane> symmetry_planes(const TetMesh &mesh, const std::vector<unsigned int> &patches)
  {
    std::vector<Plane> planes;
    for (const unsigned int p : patches)
      if (const Patch &patch = mesh.patches[p];
          patch.symmetry && std::none_of(planes.begin(), planes.end(), [&](const Plane &other) {
            return (other.normal - patch.symmetry->normal).norm() < tolerance;
          }))
        planes.push_back(*patch.symmetry);
    return planes;
  }

  std::vector<Plane> symmetry_planes(const TetMesh &mesh)
  {
    std::vector<unsigned int> all(mesh.patches.size());
    std::iota(all.begin(), all.end(), 0);
    return symmetry_planes(mesh, all);
  }

  double n_copies(const std::vector<Plane> &planes)
  {
    using dealii::numbers::PI;
    double copies = std::numeric_limits<double>::quiet_NaN();
    if (planes.size() < 2)
      copies = planes.empty() ? 1. : 2.;
    else if (planes.size() == 2 && angle_between(planes[0], planes[1]) > tolerance)
      copies = 2. * PI / angle_between(planes[0], planes[1]);
    else if (planes.size() == 3 && std::abs(dealii::cross_product_3d(planes[0].normal, planes[1].normal) *
                                            planes[2].normal) > tolerance)
      copies = 4. * PI /
               (angle_between(planes[0], planes[1]) + angle_between(planes[1], planes[2]) +
                angle_between(planes[2], planes[0]) - PI);
    // Angles of a whole number of copies are whole but for the rounding of normals in files.
    return std::abs(copies - std::round(copies)) < 1e-4 ? std::round(copies) : copies;
  }

  WholePart whole_part(const TetMesh &mesh, const Vec3 &path)
  {
    const std::vector<Plane> planes = symmetry_planes(mesh);
    std::vector<Plane>       along;
    bool                     oblique = false;
    for (const Plane &plane : planes)
    {
      const double cosine = std::abs(plane.normal * path) / path.norm();
      if (cosine < tolerance)
        along.push_back(plane);
      else
        oblique |= cosine < 1. - tolerance;
    }
    return {n_copies(planes), oblique ? std::numeric_limits<double>::quiet_NaN() : n_copies(along)};
  }
} // namespace retroforge
