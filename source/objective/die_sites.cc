// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/geometry/vector_algebra.h>
#include <retroforge/mesh/whole_part.h>
#include <retroforge/objective/die_sites.h>
#include <retroforge/objective/sector.h>

#include <cmath>
#include <map>

namespace retroforge
{
  namespace
  {
    /// Images in the planes of a wedge end after a turn; those in two parallel planes never do.
    constexpr std::size_t most_images = 400;

    BoundingBox wider_box(const TetMesh &billet)
    {
      BoundingBox box(billet.X[0]);
      for (const Vec3 &x : billet.X)
        box.include(x);
      const Vec3   edges   = box.upper - box.lower;
      const double longest = std::max({edges[0], edges[1], edges[2]});
      for (unsigned int i = 0; i < 3; ++i)
      {
        box.lower[i] -= DieSites::spread * longest;
        box.upper[i] += DieSites::spread * longest;
      }
      return box;
    }

    /// Points of a plane on a square lattice, as far as the box reaches. The lattice does not move with the box, so that
    /// designs have the same sites.
    NodalVectors<double> sites_on_plane(const Die &die, const BoundingBox &box, const double spacing)
    {
      const Vec3   middle = 0.5 * (box.lower + box.upper);
      const auto   at     = die.project<double>(middle, Vec3(), DieFeature());
      const auto   across = directions_across(at.n);
      const Vec3   foot   = die.project<double>(Vec3(), Vec3(), DieFeature()).delta * at.n; // of the origin
      const double half   = 0.5 * (box.upper - box.lower).norm();

      std::array<int, 2> first = {}, last = {};
      for (unsigned int i = 0; i < 2; ++i)
      {
        first[i] = static_cast<int>(std::floor((across[i] * middle - half) / spacing));
        last[i]  = static_cast<int>(std::ceil((across[i] * middle + half) / spacing));
      }
      NodalVectors<double> sites;
      for (int a = first[0]; a <= last[0]; ++a)
        for (int b = first[1]; b <= last[1]; ++b)
          sites.push_back(foot + a * spacing * across[0] + b * spacing * across[1]);
      return sites;
    }

    /// Points on facets, one in each cube of a lattice that the surface passes: the one nearest to its middle, of points that are
    /// close together.
    NodalVectors<double>
    sites_on_facets(const TriangleSurface &surface, const BoundingBox &box, const double spacing)
    {
      struct Nearest
      {
        Vec3   x;
        double square;
      };
      std::map<std::array<int, 3>, Nearest> cubes;
      const auto                            offer = [&](const Vec3 &x) {
        std::array<int, 3> cube = {};
        Vec3               middle;
        for (unsigned int i = 0; i < 3; ++i)
        {
          if (x[i] < box.lower[i] || x[i] > box.upper[i])
            return;
          cube[i]   = static_cast<int>(std::floor(x[i] / spacing));
          middle[i] = (cube[i] + 0.5) * spacing;
        }
        const double square        = (x - middle).norm_square();
        const auto [there, is_new] = cubes.insert({cube, {x, square}});
        if (!is_new && square < there->second.square)
          there->second = {x, square};
      };
      for (const Triangle &triangle : surface.triangles())
      {
        const Vec3 &x = surface.vertices()[triangle[0]], a = surface.vertices()[triangle[1]] - x,
                   b           = surface.vertices()[triangle[2]] - x;
        const double   longest = std::max({a.norm(), b.norm(), (a - b).norm()});
        constexpr auto finer   = 3.; // points to a cube's edge
        const int      n       = std::max(1, static_cast<int>(std::ceil(finer * longest / spacing)));
        for (int i = 0; i < n; ++i)
          for (int j = 0; i + j < n; ++j)
            offer(x + (i + 1. / 3.) / n * a + (j + 1. / 3.) / n * b);
      }
      NodalVectors<double> sites;
      for (const auto &[cube, nearest] : cubes)
        sites.push_back(nearest.x);
      return sites;
    }

    std::vector<BoundingBox> boxes_around(const NodalVectors<double> &sites)
    {
      std::vector<BoundingBox> boxes;
      for (const Vec3 &x : sites)
        boxes.emplace_back(x);
      return boxes;
    }
  } // namespace

  std::vector<DieSites::Isometry> DieSites::images_of(const TetMesh &billet, const Vec3 &path)
  {
    constexpr double      along = 1e-6;
    std::vector<Isometry> images{{dealii::unit_symmetric_tensor<3>(), Vec3()}}, mirrors;
    for (const Plane &plane : symmetry_planes(billet))
      if (std::abs(plane.normal * path) <= along * path.norm())
      {
        Isometry mirror = images[0];
        mirror.R -= 2. * outer_product(plane.normal, plane.normal);
        mirror.t = 2. * (plane.point * plane.normal) * plane.normal;
        mirrors.push_back(mirror);
      }
    const auto is_known = [&](const Isometry &image) {
      return std::any_of(images.begin(), images.end(), [&](const Isometry &other) {
        return (image.R - other.R).norm() < along &&
               (image.t - other.t).norm() < along * (1. + image.t.norm());
      });
    };
    for (std::size_t i = 0; i < images.size() && images.size() < most_images; ++i)
      for (const Isometry &mirror : mirrors)
      {
        const Isometry image{mirror.R * images[i].R, mirror.R * images[i].t + mirror.t};
        if (!is_known(image))
          images.push_back(image);
      }
    return images;
  }

  DieSites::DieSites(const Die &die, const TetMesh &billet, const Vec3 &path, const double reach)
      : reach_(reach), images_(images_of(billet, path))
  {
    Assert(reach > 0., dealii::ExcMessage("sites reach some way"));
    const BoundingBox box = wider_box(billet);
    const Sector      sector(billet);
    const auto        all = die.surface() ? sites_on_facets(*die.surface(), box, 0.5 * reach)
                                          : sites_on_plane(die, box, 0.5 * reach);
    std::copy_if(
      all.begin(), all.end(), std::back_inserter(sites_), [&](const Vec3 &x) { return sector.contains(x); });
    tree_ = BoxTree(boxes_around(sites_));
  }

  namespace
  {
    template <typename Number>
    Vec3 values_of_vector(const Vector3<Number> &x)
    {
      return Vec3({value_of(x[0]), value_of(x[1]), value_of(x[2])});
    }
  } // namespace

  template <typename Number, typename F>
  void DieSites::for_each_near(const Vector3<Number> &y, const F &f) const
  {
    for (const Isometry &image : images_)
    {
      Vector3<Number> there;
      for (unsigned int i = 0; i < 3; ++i)
      {
        there[i] = Number(image.t[i]);
        for (unsigned int j = 0; j < 3; ++j)
          there[i] += image.R[i][j] * y[j];
      }
      BoundingBox box(values_of_vector(there));
      for (unsigned int i = 0; i < 3; ++i)
      {
        box.lower[i] -= reach_;
        box.upper[i] += reach_;
      }
      for (const unsigned int site : tree_.intersecting(box))
        f(site, there, image.R);
    }
  }

  namespace
  {
    /// The peak of K [1/mm^2].
    double peak(const double reach)
    {
      return 3. / (dealii::numbers::PI * reach * reach);
    }
  } // namespace

  template <typename Number>
  void DieSites::gather(const Vector3<Number> &y, const Number &amount, std::vector<Number> &densities) const
  {
    AssertDimension(densities.size(), size());
    for_each_near<Number>(y, [&](const unsigned int site, const Vector3<Number> &there, const auto &) {
      const Vector3<Number> d    = there - sites_[site];
      const Number          left = 1. - d * d / (reach_ * reach_);
      if (value_of(left) > 0.)
        densities[site] += peak(reach_) * left * left * amount;
    });
  }

  template void DieSites::gather(const Vector3<double> &, const double &, std::vector<double> &) const;
  template void DieSites::gather(const Vector3<Dual> &, const Dual &, std::vector<Dual> &) const;

  DieSites::Sum DieSites::sum(const Vec3 &y, const std::vector<double> &weights) const
  {
    AssertDimension(weights.size(), size());
    Sum sum;
    for_each_near<double>(y, [&](const unsigned int site, const Vec3 &there, const dealii::Tensor<2, 3> &R) {
      const Vec3   d    = there - sites_[site];
      const double left = 1. - d * d / (reach_ * reach_);
      if (!(left > 0.) || weights[site] == 0.)
        return;
      sum.value += weights[site] * peak(reach_) * left * left;
      sum.gradient -= 4. * weights[site] * peak(reach_) * left / (reach_ * reach_) * (d * R);
    });
    return sum;
  }
} // namespace retroforge
