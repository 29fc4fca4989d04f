// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/objective/shape_distance.h>
#include <retroforge/objective/surface_areas.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  template <typename Number>
  std::vector<Number> ShapeDistance::compute_integrals(const FinalView<Number> &view) const
  {
    std::vector<Number> sums(2, Number(0.));
    const auto          S = lumped_areas(surface_triangles(view.scene.mesh), view.X);
    for (const SeenFeature &seen : seen_)
      if (view.scene.partition.owns(seen.point))
      {
        const Number delta = target_.distance(view, view.X[seen.point], seen.feature);
        sums[0] += S[seen.point];
        sums[1] += S[seen.point] * delta * delta;
      }
    return sums;
  }

  void ShapeDistance::reverse_integrals(const FinalView<double>   &view,
                                        const std::vector<double> &weights,
                                        FinalBar                  &bar) const
  {
    const auto            triangles = surface_triangles(view.scene.mesh);
    const auto            S         = lumped_areas(triangles, view.X);
    const TriangleSurface moved     = target_.moved(view);
    std::vector<double>   S_bar(S.size(), 0.);
    for (const SeenFeature &seen : seen_)
      if (view.scene.partition.owns(seen.point))
      {
        const double delta = target_.distance(view, view.X[seen.point], seen.feature);
        S_bar[seen.point]  = weights[0] + weights[1] * delta * delta;
        target_.reverse_distance(view,
                                 moved,
                                 view.X[seen.point],
                                 seen.feature,
                                 weights[1] * 2. * delta * S[seen.point],
                                 bar.X[seen.point],
                                 bar);
      }
    reverse_lumped_areas(triangles, view.X, S_bar, bar.X);
  }

  CylinderDistance::CylinderDistance(std::vector<std::string> patches, const Vec3 &point, const Vec3 &axis)
      : patches_(std::move(patches)), point_(point), axis_(axis / axis.norm())
  {
    if (!(axis.norm() > 0. && std::isfinite(axis.norm())))
      throw Error("Cylinder distance",
                  "the axis has length " + as_text(axis.norm()),
                  "it is a direction",
                  "use 0, 0, 1");
    if (patches_.empty())
      throw Error("Cylinder distance",
                  "no patch is named",
                  "some part of the surface must be compared",
                  "name the patches of the free side");
  }

  std::vector<Triangle> CylinderDistance::triangles(const TetMesh &mesh) const
  {
    std::vector<Triangle> chosen;
    for (const BoundaryFace &face : mesh.faces)
      if (std::count(patches_.begin(), patches_.end(), mesh.patches[face.patch].name) > 0)
        chosen.push_back(face.nodes);
    return chosen;
  }

  void CylinderDistance::decide(const FinalView<double> &view)
  {
    const TetMesh &mesh = view.scene.mesh;
    const auto     S    = lumped_areas(triangles(mesh), view.X);
    double         sum = 0., total = 0.;
    for (NodeIndex k = 0; k < S.size(); ++k)
    {
      sum += S[k] * from_axis(view.X[k]).norm();
      total += S[k];
    }
    reference_ = sum / total;
  }

  template <typename Number>
  Vector3<Number> CylinderDistance::from_axis(const Vector3<Number> &x) const
  {
    Vector3<Number> d;
    Number          along(0.);
    for (unsigned int i = 0; i < 3; ++i)
    {
      d[i] = x[i] - point_[i];
      along += d[i] * axis_[i];
    }
    for (unsigned int i = 0; i < 3; ++i)
      d[i] -= along * axis_[i];
    return d;
  }

  template <typename Number>
  std::vector<Number> CylinderDistance::compute_integrals(const FinalView<Number> &view) const
  {
    using std::sqrt;
    std::vector<Number> sums(3, Number(0.));
    const Partition    &partition = view.scene.partition;
    const auto          S         = lumped_areas(triangles(view.scene.mesh), view.X);
    for (const NodeIndex k : partition.nodes().owned())
      if (value_of(S[k]) > 0.)
      {
        const Vector3<Number> d  = from_axis(view.X[k]);
        const Number          d2 = d * d;
        const Number          x  = (value_of(d2) > 0. ? Number(sqrt(d2)) : Number(0.)) - reference_;
        sums[0] += S[k];
        sums[1] += S[k] * x;
        sums[2] += S[k] * x * x;
      }
    return sums;
  }

  void CylinderDistance::reverse_integrals(const FinalView<double>   &view,
                                           const std::vector<double> &weights,
                                           FinalBar                  &bar) const
  {
    const Partition    &partition = view.scene.partition;
    const auto          faces     = triangles(view.scene.mesh);
    const auto          S         = lumped_areas(faces, view.X);
    std::vector<double> S_bar(S.size(), 0.);
    for (const NodeIndex k : partition.nodes().owned())
      if (S[k] > 0.)
      {
        const Vec3   d = from_axis(view.X[k]);
        const double x = d.norm() - reference_;
        S_bar[k]       = weights[0] + weights[1] * x + weights[2] * x * x;
        if (d.norm() > 0.)
          bar.X[k] += S[k] * (weights[1] + 2. * weights[2] * x) / d.norm() * d;
      }
    reverse_lumped_areas(faces, view.X, S_bar, bar.X);
  }

#define RETROFORGE_INSTANTIATE(Number)                                                            \
  template std::vector<Number> ShapeDistance::compute_integrals(const FinalView<Number> &) const; \
  template std::vector<Number> CylinderDistance::compute_integrals(const FinalView<Number> &) const;
  RETROFORGE_INSTANTIATE(double)
  RETROFORGE_INSTANTIATE(Dual)
#undef RETROFORGE_INSTANTIATE
} // namespace retroforge
