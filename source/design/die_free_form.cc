// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/design/die_free_form.h>
#include <retroforge/design/surface_modes.h>
#include <retroforge/objective/box.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  namespace
  {
    constexpr double along_plane = 1e-6; ///< the cosine below which a direction lies in a plane
    constexpr double on_plane    = 1e-6; ///< a distance from a plane, in the die's extent
    constexpr double on_surface  = 1e-2; ///< how near an image lies to the surface, in the die's extent

    /// Returns the mirrors that map the die onto itself: it moves in them, and faces along them.
    std::vector<Plane> mirrors_of(const DieParameters &die, const std::vector<Plane> &symmetry)
    {
      std::vector<Plane> mirrors;
      for (const Plane &plane : symmetry)
        if (std::abs(plane.normal * die.facing) < along_plane &&
            std::abs(plane.normal * die.velocity) <= along_plane * die.velocity.norm())
          mirrors.push_back(plane);
      return mirrors;
    }

    /// Two unit vectors across the die's axis; the first along x, or along y where the die faces along x.
    std::array<Vec3, 2> across_axis(const DieParameters &die)
    {
      const Vec3 along = std::abs(die.facing[0]) > 0.9 ? Vec3({0., 1., 0.}) : Vec3({1., 0., 0.});
      const Vec3 first = unit(along - (along * die.facing) * die.facing);
      return {{first, cross(die.facing, first)}};
    }

    /// The two that bound one sector between n planes through the die's axis: of the 2 n sectors, the first
    /// of those that are farthest inside of the other mirrors.
    std::vector<Plane>
    mirrors_through_axis(const DieParameters &die, const unsigned int n, const std::vector<Plane> &others)
    {
      const auto axes      = across_axis(die);
      const auto direction = [&](const double angle) {
        return std::cos(angle) * axes[0] + std::sin(angle) * axes[1];
      };
      const double angle = dealii::numbers::PI / n;
      unsigned int best  = 0;
      double       least = std::numeric_limits<double>::max();
      for (unsigned int k = 0; k < 2 * n; ++k)
      {
        double beyond = -1.;
        for (const Plane &plane : others)
          beyond = std::max(beyond, direction((k + 0.5) * angle) * plane.normal);
        if (beyond < least - 1e-9)
        {
          least = beyond;
          best  = k;
        }
      }
      constexpr double quarter = 0.5 * dealii::numbers::PI;
      return {{die.point, direction(best * angle - quarter)},
              {die.point, direction((best + 1) * angle + quarter)}};
    }

    /// The sector inside all planes, and the images of points there.
    class Sector
    {
    public:
      Sector(std::vector<Plane> planes, const double tolerance)
          : planes_(std::move(planes)), tolerance_(tolerance)
      {
      }

      /// Reflected at the plane it is farthest beyond until it is inside of all: planes that meet at part of
      /// half a turn fold all of space into their sector.
      Vec3 folded(Vec3 x) const
      {
        constexpr unsigned int most = 10000;
        for (unsigned int i = 0; i < most; ++i)
        {
          const Plane *farthest = nullptr;
          double       beyond   = tolerance_;
          for (const Plane &plane : planes_)
            if (const double distance = (x - plane.point) * plane.normal; distance > beyond)
            {
              beyond   = distance;
              farthest = &plane;
            }
          if (!farthest)
            break;
          x -= 2. * beyond * farthest->normal;
        }
        return x;
      }

      /// Normals of the planes that a point lies on.
      std::vector<Vec3> normals_at(const Vec3 &x) const
      {
        std::vector<Vec3> normals;
        for (const Plane &plane : planes_)
          if (std::abs((x - plane.point) * plane.normal) <= tolerance_)
            normals.push_back(plane.normal);
        return normals;
      }

    private:
      std::vector<Plane> planes_;
      double             tolerance_;
    };

    /// A point of a facet's plane, in its corners' values; of one beyond the facet, of the nearest one.
    std::array<double, 3> weights_on(const TriangleSurface &surface, const unsigned int facet, const Vec3 &x)
    {
      const Triangle &t = surface.triangles()[facet];
      const Vec3     &o = surface.vertices()[t[0]];
      const Vec3      a = surface.vertices()[t[1]] - o, b = surface.vertices()[t[2]] - o, v = cross(a, b);
      const double    l1 = v * cross(x - o, b) / (v * v), l2 = v * cross(a, x - o) / (v * v);
      std::array<double, 3> l   = {{1. - l1 - l2, l1, l2}};
      double                sum = 0.;
      for (double &weight : l)
      {
        // A vertex whose image is a vertex is tied to that one alone.
        constexpr double rounding = 1e-6;
        weight                    = weight < rounding ? 0. : weight;
        sum += weight;
      }
      for (double &weight : l)
        weight /= sum;
      return l;
    }

    /// Value of a vertex less that of its image.
    MovingSurface::Tie tie_to_image(const TriangleSurface &surface,
                                    const unsigned int     vertex,
                                    const DieFeature      &image,
                                    const Vec3            &x)
    {
      MovingSurface::Tie tie     = {{vertex, 1.}};
      const auto         weights = weights_on(surface, image.facet, x);
      for (unsigned int c = 0; c < 3; ++c)
        if (weights[c] > 0.)
          tie.emplace_back(surface.triangles()[image.facet][c], -weights[c]);
      return tie;
    }

    MovingSurface
    moving_surface(const TriangleSurface &surface, const DieFreeFormParameters &form, const Sector &sector)
    {
      // Images on a plane lie beside it by rounding.
      const double         rounding = on_plane * surface.diagonal();
      const Vec3           wider({rounding, rounding, rounding});
      const Box            region(form.from - wider, form.to + wider);
      const ClosestFeature closest(surface);
      MovingSurface        moving{surface.vertices(), surface.triangles(), {}, {}};
      moving.held.assign(surface.vertices().size(), false);
      for (unsigned int k = 0; k < surface.vertices().size(); ++k)
      {
        const Vec3 &x = surface.vertices()[k], image = sector.folded(x);
        moving.held[k] = surface.around(k).empty() || (form.has_region() && !is_inside(region, image));
        if (moving.held[k] || image == x)
          continue;
        if (const DieFeature feature = closest(image, on_surface * surface.diagonal()); feature.found())
          moving.ties.push_back(tie_to_image(surface, k, feature, image));
      }
      return moving;
    }

    /// Returns the direction in which each vertex moves.
    NodalVectors<double> directions(const TriangleSurface &surface,
                                    const DieParameters   &die,
                                    const bool             along_normals,
                                    const Sector          &sector)
    {
      NodalVectors<double> e(surface.vertices().size(), die.facing);
      if (!along_normals)
        return e;
      e.assign(e.size(), Vec3());
      const NodalVectors<double> &x = surface.vertices();
      for (const Triangle &t : surface.triangles())
        for (const unsigned int k : t)
          e[k] += facet_vector(x[t[0]], x[t[1]], x[t[2]]);
      for (unsigned int k = 0; k < e.size(); ++k)
      {
        e[k] = in_planes(e[k], sector.normals_at(x[k]));
        e[k] /= std::max(e[k].norm(), std::numeric_limits<double>::min());
      }
      return e;
    }

    void check_number(const std::string &section, const unsigned int modes, const MovingSurface &moving)
    {
      const unsigned int n = moving.n_moving(), free = n - moving.ties.size();
      if (modes > free)
        throw Error(section + "/free form modes",
                    "is " + std::to_string(modes) + ", and " + std::to_string(free) +
                      " of the die's vertices are free to move",
                    "a region has as many modes as vertices, mirror images counted once",
                    free == 0 ? "correct the region, whose coordinates are those of the die at the start"
                              : "ask for fewer modes, widen the region, or give the surface more facets");
      if (n > most_moving_points)
        throw Error(section + "/free form modes",
                    "is " + std::to_string(modes) + ", and " + std::to_string(n) +
                      " of the die's vertices move",
                    "there may be " + std::to_string(most_moving_points),
                    "give a smaller region, or make the surface of fewer facets");
    }
  } // namespace

  DieFreeForm::DieFreeForm(const DieParameters &die, const std::vector<Plane> &symmetry)
  {
    const DieFreeFormParameters *form = die.shape->free_form();
    if (!form || form->modes == 0)
      return;
    const Die              made    = die.die();
    const TriangleSurface &surface = *made.surface();
    section_                       = "Die " + die.name;
    vertices_                      = surface.vertices();
    triangles_                     = surface.triangles();
    std::vector<Plane> mirrors     = mirrors_of(die, symmetry);
    if (form->mirrors > 0)
      for (const Plane &plane : mirrors_through_axis(die, form->mirrors, mirrors))
        mirrors.push_back(plane);
    const Sector        sector(std::move(mirrors), on_plane * surface.diagonal());
    const MovingSurface moving = moving_surface(surface, *form, sector);
    check_number(section_, form->modes, moving);
    const NodalVectors<double> e =
      directions(surface, die, form->along == DieFreeFormParameters::Along::normal, sector);
    for (const std::vector<double> &mode : surface_modes(moving, form->modes, form->length))
    {
      moves_.push_back(e);
      for (unsigned int k = 0; k < e.size(); ++k)
        moves_.back()[k] *= mode[k];
    }
  }

  template <typename Number>
  void DieFreeForm::forward(const std::map<unsigned int, Number> &coefficients,
                            NodalVectors<Number>                 &vertices) const
  {
    NodalVectors<double> before, after;
    convert(vertices, before);
    for (const auto &[mode, coefficient] : coefficients)
      for (std::size_t k = 0; k < vertices.size(); ++k)
        for (unsigned int i = 0; i < 3; ++i)
          vertices[k][i] += coefficient * moves_[mode][k][i];
    convert(vertices, after);
    check_facets(before, after);
  }

  template void DieFreeForm::forward(const std::map<unsigned int, double> &, NodalVectors<double> &) const;
  template void DieFreeForm::forward(const std::map<unsigned int, Dual> &, NodalVectors<Dual> &) const;

  double DieFreeForm::reverse(const unsigned int mode, const NodalVectors<double> &vertices_bar) const
  {
    AssertIndexRange(mode, moves_.size());
    AssertDimension(vertices_bar.size(), vertices_.size());
    double sum = 0.;
    for (std::size_t k = 0; k < vertices_bar.size(); ++k)
      sum += moves_[mode][k] * vertices_bar[k];
    return sum;
  }

  void DieFreeForm::check_facets(const NodalVectors<double> &before, const NodalVectors<double> &x) const
  {
    for (unsigned int f = 0; f < triangles_.size(); ++f)
    {
      const Triangle &t = triangles_[f];
      if (!(facet_vector(x[t[0]], x[t[1]], x[t[2]]) * facet_vector(before[t[0]], before[t[1]], before[t[2]]) >
            0.))
        throw Error(section_ + "/free form",
                    "turns facet " + std::to_string(f) + " of its surface by a right angle or more",
                    "the die's surface must be able to follow",
                    "stay closer to the die as made, or move fewer and smoother modes");
    }
  }
} // namespace retroforge
