// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/mesh/point_location.h>
#include <retroforge/remeshing/size_field.h>

#include <cmath>
#include <sstream>

namespace retroforge
{
  namespace
  {
    void check(const TriangleSurface     &surface,
               const std::vector<double> &size_of_facet,
               const double               largest,
               const double               growth)
    {
      const auto positive = [](const double x) { return x > 0 && std::isfinite(x); };
      if (size_of_facet.size() == surface.n_facets() && positive(largest) && positive(growth) &&
          std::all_of(size_of_facet.begin(), size_of_facet.end(), positive))
        return;
      std::ostringstream what;
      what << size_of_facet.size() << " sizes for " << surface.n_facets() << " facets, the largest size is "
           << largest << ", the growth " << growth;
      throw Error("size field",
                  what.str(),
                  "each facet has a size, and sizes and growth are positive",
                  "set positive sizes and growth");
    }

    double distance(const Vec3 &x, const std::array<Vec3, 3> &facet)
    {
      const auto w = closest_on_triangle(x, facet);
      return (w[0] * facet[0] + w[1] * facet[1] + w[2] * facet[2] - x).norm();
    }
  } // namespace

  GradedSize::GradedSize(const TriangleSurface                    &surface,
                         const std::vector<double>                &size_of_facet,
                         const double                              largest,
                         const double                              growth,
                         const std::vector<TriangleSurface::Edge> &ridges,
                         const double                              size_of_ridges)
      : largest_(largest), growth_(growth)
  {
    check(surface, size_of_facet, largest, growth);
    const std::vector<BoundingBox> all = boxes_of_facets(surface);
    std::vector<BoundingBox>       boxes;
    for (unsigned int f = 0; f < surface.n_facets(); ++f)
      if (size_of_facet[f] < largest)
      {
        const Triangle &corner = surface.triangles()[f];
        const auto     &x      = surface.vertices();
        facets_.push_back({{x[corner[0]], x[corner[1]], x[corner[2]]}});
        size_.push_back(size_of_facet[f]);
        boxes.push_back(all[f]);
      }
    // An edge is a facet with hardly any height.
    for (const auto &edge : ridges)
    {
      const Triangle &corner = surface.triangles()[edge.facet];
      const auto     &x      = surface.vertices();
      const Vec3     &a = x[corner[edge.edge]], &b = x[corner[(edge.edge + 1) % 3]],
                 &c = x[corner[(edge.edge + 2) % 3]];
      facets_.push_back({{a, b, 0.5 * (a + b) + 1e-3 * (c - 0.5 * (a + b))}});
      size_.push_back(size_of_ridges);
      BoundingBox box(a);
      box.include(b);
      box.include(facets_.back()[2]);
      boxes.push_back(box);
    }
    tree_  = BoxTree(boxes);
    least_ = tree_.minima(size_);
  }

  double GradedSize::operator()(const Vec3 &x, const SizeQuery &query) const
  {
    double size = std::min(largest_, query.upper);
    tree_.minimise(
      [&](const unsigned int branch) {
        return least_[branch] + growth_ * std::sqrt(tree_.box(branch).square_distance(x));
      },
      [&](const unsigned int f) {
        if (size_[f] < size)
          size = std::min(size, size_[f] + growth_ * distance(x, facets_[f]));
        return size < query.lower ? -1. : size;
      },
      size);
    return size;
  }
} // namespace retroforge
