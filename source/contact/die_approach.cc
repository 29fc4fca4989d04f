// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/contact/die_approach.h>
#include <retroforge/contact/facet_corners.h>
#include <retroforge/geometry/vector_algebra.h>
#include <retroforge/mesh/point_location.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace retroforge
{
  namespace
  {
    constexpr double infinite = std::numeric_limits<double>::infinity();

    /// Coordinates across a way and along it.
    class Frame
    {
    public:
      explicit Frame(const Vec3 &way) : along_(way / way.norm()), across_(directions_across(along_)) {}

      Vec3    operator()(const Vec3 &x) const { return Vec3({across_[0] * x, across_[1] * x, along_ * x}); }
      Corners operator()(const Corners &x) const { return {{(*this)(x[0]), (*this)(x[1]), (*this)(x[2])}}; }
      Vec3    back(const Vec3 &y) const { return y[0] * across_[0] + y[1] * across_[1] + y[2] * along_; }

    private:
      Vec3                along_;
      std::array<Vec3, 2> across_;
    };

    /// Least part of a triangle's normal along the way, for the triangle to count.
    constexpr double least_inclination = 1e-7;

    /// +1: it looks along the way, -1: back, 0: along neither.
    int looks_along(const Corners &y)
    {
      const Vec3 n = facet_vector(y[0], y[1], y[2]);
      return n[2] > least_inclination * n.norm() ? 1 : n[2] < -least_inclination * n.norm() ? -1 : 0;
    }

    /// Height over the plane of coordinates across: linear over a triangle.
    double height(const Corners &y, const Vec3 &x)
    {
      const Vec3 n = facet_vector(y[0], y[1], y[2]);
      return y[0][2] - (n[0] * (x[0] - y[0][0]) + n[1] * (x[1] - y[0][1])) / n[2];
    }

    /// Least and largest of how much farther along the way the metal is than the die where both lie over one
    /// another.
    struct Clearance
    {
      double least = infinite, largest = -infinite;
      Vec3   place; ///< in the frame, of the least, on the metal
    };

    /// A triangle cut by another one, looked at along the way: a polygon of up to six corners.
    class Shadow
    {
    public:
      explicit Shadow(const Corners &y) : n_(3) { std::copy(y.begin(), y.end(), x_.begin()); }

      /// Leaves what is to the left of a, b.
      void cut(const Vec3 &a, const Vec3 &b)
      {
        std::array<Vec3, 9> left;
        unsigned int        n    = 0;
        const auto          side = [&](const Vec3 &x) {
          return (b[0] - a[0]) * (x[1] - a[1]) - (b[1] - a[1]) * (x[0] - a[0]);
        };
        for (unsigned int i = 0; i < n_; ++i)
        {
          const Vec3  &p = x_[i], &q = x_[(i + 1) % n_];
          const double at_p = side(p), at_q = side(q);
          if (at_p >= 0.)
            left[n++] = p;
          if ((at_p > 0. && at_q < 0.) || (at_p < 0. && at_q > 0.))
            left[n++] = p + (at_p / (at_p - at_q)) * (q - p);
        }
        n_ = n;
        x_ = left;
      }

      double area() const
      {
        double twice = 0.;
        for (unsigned int i = 0; i < n_; ++i)
          twice += x_[i][0] * x_[(i + 1) % n_][1] - x_[i][1] * x_[(i + 1) % n_][0];
        return 0.5 * std::abs(twice);
      }

      unsigned int size() const { return n_; }
      const Vec3  &operator[](const unsigned int i) const { return x_[i]; }

    private:
      unsigned int        n_;
      std::array<Vec3, 9> x_;
    };

    /// Areas far from the origin have no digits.
    Corners seen_from(const Vec3 &origin, Corners y)
    {
      for (Vec3 &corner : y)
        corner -= origin;
      return y;
    }

    /// What of a face of the metal lies over a facet of a die, both near the origin.
    Shadow shadow_on(const Corners &metal, const Corners &die)
    {
      Shadow shadow(metal);
      for (unsigned int c = 0; c < 3 && shadow.size() > 2; ++c)
        shadow.cut(die[c], die[(c + 1) % 3]); // the die looks along the way: its corners turn left
      return shadow;
    }

    Clearance clearance(const Corners &of_metal, const Corners &of_die)
    {
      const Vec3       origin = of_metal[0];
      const Corners    m = seen_from(origin, of_metal), d = seen_from(origin, of_die);
      const Shadow     shadow = shadow_on(m, d);
      Clearance        found;
      constexpr double least_area = 1e-10; // of squared lengths: less than that only lie side by side
      if (shadow.size() < 3 || !(shadow.area() > least_area * (m[1] - m[0]).norm_square()))
        return found;
      for (unsigned int i = 0; i < shadow.size(); ++i)
      {
        const double z = height(m, shadow[i]), between = z - height(d, shadow[i]);
        if (between < found.least)
        {
          found.least = between;
          found.place = origin + Vec3({shadow[i][0], shadow[i][1], z});
        }
        found.largest = std::max(found.largest, between);
      }
      return found;
    }

    /// Facets of a die that look along the way, in a frame.
    struct LookingFacets
    {
      std::vector<Corners> facets;
      BoxTree              tree;

      LookingFacets(const TriangleSurface &surface, const Vec3 &displacement, const Frame &frame)
      {
        std::vector<BoundingBox> boxes;
        for (unsigned int f = 0; f < surface.n_facets(); ++f)
          if (const Corners y = frame(facet_corners(surface, f, displacement)); looks_along(y) > 0)
          {
            facets.push_back(y);
            boxes.emplace_back(y);
          }
        tree = BoxTree(boxes);
      }
    };

    bool lie_apart(const BoundingBox &a, const BoundingBox &b)
    {
      return a.lower[0] > b.upper[0] || b.lower[0] > a.upper[0] || a.lower[1] > b.upper[1] ||
             b.lower[1] > a.upper[1];
    }

    /// The least travel of all pairs of a face of the metal and a facet of the die over one another.
    /// @param least   of the least and the largest clearance that a branch of facets may have under a face:
    /// no travel in it is less
    /// @param travel  of a pair's clearance; infinite where it does not count
    template <typename Least, typename Travel>
    std::optional<Meeting> least_travel(const LookingFacets &die,
                                        const MetalSurface  &metal,
                                        const Frame         &frame,
                                        const Least         &least,
                                        const Travel        &travel)
    {
      constexpr double most = std::numeric_limits<double>::max();
      Meeting          best{infinite, Vec3()};
      for (unsigned int t = 0; t < metal.triangles().size(); ++t)
      {
        const Corners y = frame(metal.corners(t));
        if (looks_along(y) >= 0)
          continue;
        const BoundingBox box(y);
        die.tree.minimise(
          [&](const unsigned int branch) {
            const BoundingBox &facets = die.tree.box(branch);
            return lie_apart(facets, box)
                     ? infinite
                     : least(box.lower[2] - facets.upper[2], box.upper[2] - facets.lower[2]);
          },
          [&](const unsigned int f) {
            const Clearance found = clearance(y, die.facets[f]);
            if (const double way = found.least < infinite ? travel(found) : infinite; way < best.travel)
              best = {way, frame.back(found.place)};
            return std::min(best.travel, most);
          },
          std::min(best.travel, most));
      }
      return best.travel < infinite ? std::optional<Meeting>(best) : std::nullopt;
    }

    /// Returns the component of a plane's normal into the die along a way.
    double slope_of_plane(const Die &plane, const Vec3 &way)
    {
      return plane.project(Vec3(), Vec3(), DieFeature()).n * way / way.norm();
    }

    std::optional<Meeting> first_meeting_of_plane(const Die          &die,
                                                  const Vec3         &displacement,
                                                  const Vec3         &way,
                                                  const MetalSurface &metal,
                                                  const double        touching)
    {
      const double slope = slope_of_plane(die, way);
      if (!(slope < -least_inclination))
        return {};
      double nearest = infinite, farthest = -infinite;
      Vec3   place;
      for (const Vec3 &x : metal.vertices())
      {
        const double delta = die.signed_distance(x, displacement);
        farthest           = std::max(farthest, delta);
        if (delta < nearest)
        {
          nearest = delta;
          place   = x;
        }
      }
      return nearest >= -touching || farthest > 0.
               ? std::optional<Meeting>(Meeting{std::max(0., nearest) / -slope, place})
               : std::nullopt;
    }
  } // namespace

  std::optional<Meeting> first_meeting(const Die          &die,
                                       const Vec3         &displacement,
                                       const Vec3         &way,
                                       const MetalSurface &metal,
                                       const double        touching)
  {
    if (!die.surface())
      return first_meeting_of_plane(die, displacement, way, metal, touching);
    const Frame         frame(way);
    const LookingFacets facets(*die.surface(), displacement, frame);
    return least_travel(
      facets,
      metal,
      frame,
      [&](const double least, const double largest) {
        return largest < -touching ? infinite : std::max(0., least);
      },
      [&](const Clearance &found) {
        // A pair that is apart on one side and not on the other cuts through one another.
        return found.least >= -touching || found.largest > 0. ? std::max(0., found.least) : infinite;
      });
  }

  double
  travel_to_be_free(const Die &die, const Vec3 &displacement, const Vec3 &way, const MetalSurface &metal)
  {
    if (!die.surface())
    {
      double deepest = 0.;
      for (const Vec3 &x : metal.vertices())
        deepest = std::max(deepest, -die.signed_distance(x, displacement));
      const double slope = slope_of_plane(die, way);
      return deepest == 0. ? 0. : slope > least_inclination ? deepest / slope : infinite;
    }
    // As the die comes from far away: it stops where the last of the pairs parts.
    const Frame         frame(-way);
    const LookingFacets facets(*die.surface(), displacement, frame);
    const auto          last = least_travel(
      facets,
      metal,
      frame,
      [](const double least, const double) { return least; },
      [](const Clearance &found) { return found.least; });
    return last ? std::max(0., -last->travel) : 0.;
  }

  double covered_part(const Die &die, const Vec3 &displacement, const Vec3 &way, const MetalSurface &metal)
  {
    if (!die.surface())
      return slope_of_plane(die, way) < -least_inclination ? 1. : 0.;
    const Frame         frame(way);
    const LookingFacets facets(*die.surface(), displacement, frame);
    double              covered = 0., all = 0.;
    for (unsigned int t = 0; t < metal.triangles().size(); ++t)
    {
      const Corners y = frame(metal.corners(t));
      if (looks_along(y) >= 0)
        continue;
      const Corners m    = seen_from(y[0], y);
      const double  area = Shadow(m).area();
      BoundingBox   column(y);
      column.lower[2] = -infinite;
      column.upper[2] = infinite;
      double over     = 0.;
      for (const unsigned int f : facets.tree.intersecting(column))
        over += shadow_on(m, seen_from(y[0], facets.facets[f])).area();
      covered += std::min(over, area);
      all += area;
    }
    return all > 0. ? covered / all : 0.;
  }

  namespace
  {
    /// Closest points of the segments from a along u and from b along v, as parts of these.
    std::pair<double, double> closest_on_segments(const Vec3 &a, const Vec3 &u, const Vec3 &b, const Vec3 &v)
    {
      const Vec3   r  = a - b;
      const double uu = u * u, vv = v * v, uv = u * v, ur = u * r, vr = v * r, det = uu * vv - uv * uv;
      double       s = det > 1e-14 * uu * vv ? std::clamp((uv * vr - vv * ur) / det, 0., 1.) : 0.;
      const double t = std::clamp((uv * s + vr) / vv, 0., 1.);
      s              = std::clamp((uv * t - ur) / uu, 0., 1.);
      return {s, t};
    }

    /// Keeps the shortest distance between two triangles that do not cross, and the end of it on the first.
    void keep_shortest(const Corners &x, const Corners &y, double &square, Vec3 &place)
    {
      const auto keep = [&](const Vec3 &p, const Vec3 &q) {
        if (const double found = (p - q).norm_square(); found < square)
        {
          square = found;
          place  = p;
        }
      };
      const auto point = [](const std::array<double, 3> &w, const Corners &p) {
        return Vec3(w[0] * p[0] + w[1] * p[1] + w[2] * p[2]);
      };
      for (unsigned int c = 0; c < 3; ++c)
      {
        keep(x[c], point(closest_on_triangle(x[c], y), y));
        keep(point(closest_on_triangle(y[c], x), x), y[c]);
        for (unsigned int e = 0; e < 3; ++e)
        {
          const Vec3 u = x[(c + 1) % 3] - x[c], v = y[(e + 1) % 3] - y[e];
          const auto [s, t] = closest_on_segments(x[c], u, y[e], v);
          keep(x[c] + s * u, y[e] + t * v);
        }
      }
    }

    double square_distance(const BoundingBox &a, const BoundingBox &b)
    {
      double square = 0.;
      for (unsigned int i = 0; i < 3; ++i)
      {
        const double apart = std::max({a.lower[i] - b.upper[i], b.lower[i] - a.upper[i], 0.});
        square += apart * apart;
      }
      return square;
    }
  } // namespace

  std::pair<double, Vec3>
  shortest_distance(const Die &die, const Vec3 &displacement, const MetalSurface &metal)
  {
    if (!die.surface())
    {
      std::pair<double, Vec3> nearest{infinite, Vec3()};
      for (const Vec3 &x : metal.vertices())
        if (const double delta = die.signed_distance(x, displacement); delta < nearest.first)
          nearest = {delta, x};
      return {std::max(0., nearest.first), nearest.second};
    }
    const TriangleSurface &surface = *die.surface();
    double                 square  = std::numeric_limits<double>::max();
    Vec3                   place;
    for (unsigned int f = 0; f < surface.n_facets(); ++f)
    {
      const Corners     x = facet_corners(surface, f, displacement);
      const BoundingBox box(x);
      metal.tree().minimise(
        [&](const unsigned int branch) { return square_distance(box, metal.tree().box(branch)); },
        [&](const unsigned int t) {
          keep_shortest(metal.corners(t), x, square, place);
          return square;
        },
        square);
    }
    return {std::sqrt(square), place};
  }

  namespace
  {
    /// The shortest of the moves along some ways that frees a die.
    Vec3 shortest_move(const Die               &die,
                       const Vec3              &displacement,
                       const std::vector<Vec3> &ways,
                       const MetalSurface      &metal)
    {
      double shortest = infinite;
      Vec3   move;
      for (const Vec3 &way : ways)
        if (const double travel = travel_to_be_free(die, displacement, way / way.norm(), metal);
            travel < shortest * (1. - 1e-9))
        {
          shortest = travel;
          move     = travel / way.norm() * way;
        }
      return move;
    }

    /// Out of the metal, where they overlap most; zero where there is none.
    Vec3 way_out(const Die &die, const Vec3 &displacement, const MetalSurface &metal, const Overlap &overlap)
    {
      if (overlap.is_of_die)
        return metal.closest(overlap.place).place - overlap.place;
      const DieFeature feature = die.closest(overlap.place, displacement);
      return feature.found() ? die.project(overlap.place, displacement, feature).n : Vec3();
    }
  } // namespace

  DieApproach find_approach(const Die          &die,
                            const Vec3         &displacement,
                            const Vec3         &velocity,
                            const Vec3         &facing,
                            const MetalSurface &metal,
                            const double        touching)
  {
    DieApproach approach;
    approach.overlap = find_overlap(die, displacement, metal);
    const bool moves = velocity.norm() > 0.;
    if (approach.overlap.depth > 0.)
    {
      std::vector<Vec3> ways;
      if (moves)
        ways.push_back(-velocity);
      ways.push_back(-facing);
      // A die that moves across a plane of symmetry is another one in its mirror image.
      const Vec3 way = metal.along_symmetry(way_out(die, displacement, metal, approach.overlap));
      if (way.norm() > 0.)
        ways.push_back(way);
      approach.freeing   = shortest_move(die, displacement, ways, metal);
      approach.gap_place = approach.overlap.place;
    }
    else
      std::tie(approach.gap, approach.gap_place) = shortest_distance(die, displacement, metal);
    if (moves)
    {
      const double near   = std::max(touching, 1.01 * approach.overlap.depth); // what overlaps has met
      approach.meeting    = first_meeting(die, displacement, velocity, metal, near);
      approach.moves_away = !approach.meeting && first_meeting(die, displacement, -velocity, metal, near);
    }
    return approach;
  }
} // namespace retroforge
