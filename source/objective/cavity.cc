// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/mesh/whole_part.h>
#include <retroforge/objective/cavity.h>
#include <retroforge/objective/local_derivatives.h>

#include <algorithm>

namespace retroforge
{
  namespace
  {
    template <typename Number>
    Vector3<Number> constant(const Vec3 &x)
    {
      Vector3<Number> y;
      for (unsigned int i = 0; i < 3; ++i)
        y[i] = Number(x[i]);
      return y;
    }

    Vec3 corner(const Box &box, const unsigned int c)
    {
      Vec3 x;
      for (unsigned int i = 0; i < 3; ++i)
        x[i] = (c >> i & 1u) ? box.second[i] : box.first[i];
      return x;
    }

    /// The six tetrahedra of a box around its diagonal, by corners numbered in bits.
    constexpr unsigned int tetrahedra_of_box[6][4] =
      {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};

    template <typename Number>
    Number volume_of_box(const Box                            &box,
                         const Vector3<Number>                &shift,
                         const std::vector<HalfSpace<Number>> &half_spaces)
    {
      Number sum(0.);
      for (const auto &corners : tetrahedra_of_box)
      {
        Tetrahedron<Number> x;
        for (unsigned int k = 0; k < 4; ++k)
          x[k] = constant<Number>(corner(box, corners[k])) + shift;
        sum += clipped_volume(x, half_spaces.data(), half_spaces.data() + half_spaces.size());
      }
      return sum;
    }

    /// s_t and the half-spaces of the shadow of a facet; no sign where it is seen edge-on.
    template <typename Number>
    int make_shadow(const Vector3<Number>                &eye,
                    const std::array<Vector3<Number>, 3> &facet,
                    std::vector<HalfSpace<Number>>       &half_spaces)
    {
      const Vector3<Number> normal = cross<Number>(facet[1] - facet[0], facet[2] - facet[0]);
      const Number          depth  = normal * (facet[0] - eye);
      const int             sign   = value_of(depth) > 0. ? 1 : value_of(depth) < 0. ? -1 : 0;
      for (unsigned int e = 0; e < 3 && sign != 0; ++e)
      {
        const Vector3<Number> side =
          cross<Number>(facet[e] - eye, facet[(e + 1) % 3] - eye) * Number(-double(sign));
        half_spaces.push_back({side, side * eye});
      }
      const Vector3<Number> back = normal * Number(-double(sign));
      half_spaces.push_back({back, back * facet[0]});
      return sign;
    }

    /// The mean normal of an open surface, without what it has across symmetry planes that it reaches, where
    /// it was cut; nothing of a closed one.
    Vec3 facing_of(const TriangleSurface &surface, const Vec3 &displacement, const std::vector<Plane> &sector)
    {
      Vec3 mean = mean_normal(surface);
      for (const Plane &plane : sector)
      {
        double nearest = std::numeric_limits<double>::max(), farthest = -nearest;
        for (const Vec3 &x : surface.vertices())
        {
          const double depth = (x + displacement - plane.point) * plane.normal;
          nearest            = std::min(nearest, depth);
          farthest           = std::max(farthest, depth);
        }
        const double rounding = 1e-6 * surface.diagonal();
        if (nearest <= rounding && farthest >= -rounding)
          mean -= (mean * plane.normal) * plane.normal;
      }
      return mean.norm() > 1e-3 ? Vec3(mean / mean.norm()) : Vec3();
    }

    void add_mouth(const TriangleSurface &surface, const Vec3 &facing, Region &region)
    {
      region.axis     = -facing;
      const auto &x   = surface.vertices();
      double      low = std::numeric_limits<double>::max(), high = -low;
      for (unsigned int v = 0; v < x.size(); ++v)
      {
        const double height = region.axis * x[v];
        high                = std::max(high, height);
        if (height < low)
        {
          low                 = height;
          region.mouth_vertex = v;
        }
      }
      region.mouth_depth = 1e-3 * (high - low);
    }

    /// Moves sides of the box that lie in a symmetry plane away, so that the plane alone cuts there.
    void leave_to_sector(Region &region)
    {
      const double size = (region.box.second - region.box.first).norm();
      for (const Plane &plane : region.sector)
        for (unsigned int i = 0; i < 3; ++i)
          for (double *side : {&region.box.first[i], &region.box.second[i]})
            if (std::abs(plane.normal[i]) > 1. - 1e-12 && std::abs(*side - plane.point[i]) < 1e-5 * size)
              *side += (plane.normal[i] > 0. ? 1e-4 : -1e-4) * size;
    }

    /// The point of the region that is farthest from the surface, of a few.
    void choose_eye(const Die &die, const Vec3 &displacement, Region &region)
    {
      const auto   place    = region.place(die.surface()->vertices(), displacement);
      const auto   inside   = region.half_spaces(place);
      const Vec3   size     = region.box.second - region.box.first;
      const double parts[5] = {0.0713, 0.2891, 0.5137, 0.7319, 0.9437}; // on no plane of symmetry of a scene
      double       best     = -1.;
      for (unsigned int g = 0; g < 125; ++g)
      {
        const unsigned int at[3] = {g % 5, g / 5 % 5, g / 25};
        Vec3               x     = region.box.first;
        for (unsigned int i = 0; i < 3; ++i)
          x[i] += (parts[at[i]] + 0.0071 * i) * size[i];
        if (std::any_of(inside.begin(), inside.end(), [&](const auto &space) {
              return space.excess(x + place.shift) > 0.;
            }))
          continue;
        const double distance = die.facet_distance(x + place.shift, displacement);
        if (std::isfinite(distance) && std::abs(distance) > best)
        {
          best                = std::abs(distance);
          region.eye          = x;
          region.eye_in_front = distance > 0.;
        }
      }
      if (best < 0.)
        throw Error("Unfilled volume",
                    "the target is not seen from within its region",
                    "a cavity lies before the target's surface",
                    "let the region be the box around the cavity where the die ends");
    }
  } // namespace

  template <typename Number>
  std::vector<HalfSpace<Number>> Region::mouth_and_sector(const RegionPlace<Number> &place) const
  {
    std::vector<HalfSpace<Number>> half_spaces;
    if (mouth_vertex != invalid_index)
    {
      const Vector3<Number> outwards = constant<Number>(-axis);
      half_spaces.push_back({outwards, outwards * place.shift - place.mouth - mouth_depth});
    }
    for (const Plane &plane : sector)
      half_spaces.push_back({constant<Number>(plane.normal), Number(plane.normal * plane.point)});
    return half_spaces;
  }

  template <typename Number>
  std::vector<HalfSpace<Number>> Region::half_spaces(const RegionPlace<Number> &place) const
  {
    std::vector<HalfSpace<Number>> half_spaces;
    for (unsigned int i = 0; i < 3; ++i)
      for (const double sign : {-1., 1.})
      {
        Vec3 normal;
        normal[i] = sign;
        half_spaces.push_back(
          {constant<Number>(normal), sign * (place.shift[i] + (sign > 0. ? box.second[i] : box.first[i]))});
      }
    for (auto &space : mouth_and_sector(place))
      half_spaces.push_back(space);
    return half_spaces;
  }

  template <typename Number>
  Number Region::volume(const RegionPlace<Number> &place) const
  {
    return volume_of_box(box, place.shift, mouth_and_sector(place));
  }

  template <typename Number>
  Number Region::shadow(const RegionPlace<Number> &place, const std::array<Vector3<Number>, 3> &facet) const
  {
    std::vector<HalfSpace<Number>> half_spaces;
    const int sign = make_shadow<Number>(constant<Number>(eye) + place.shift, facet, half_spaces);
    if (sign == 0)
      return Number(0.);
    for (auto &space : mouth_and_sector(place))
      half_spaces.push_back(space);
    return double(sign) * volume_of_box(box, place.shift, half_spaces);
  }

  template <typename Number>
  Number shadow_in_tetrahedron(const Tetrahedron<Number>            &x,
                               const Vector3<Number>                &eye,
                               const std::array<Vector3<Number>, 3> &facet,
                               const std::vector<HalfSpace<Number>> &half_spaces)
  {
    std::vector<HalfSpace<Number>> all;
    const int                      sign = make_shadow(eye, facet, all);
    if (sign == 0)
      return Number(0.);
    all.insert(all.end(), half_spaces.begin(), half_spaces.end());
    return double(sign) * clipped_volume(x, all.data(), all.data() + all.size());
  }

  Region
  make_region(const Die &die, const Vec3 &displacement, const std::optional<Box> &box, const TetMesh &mesh)
  {
    const TriangleSurface &surface = *die.surface();
    Region                 region;
    region.sector = symmetry_planes(mesh);
    if (box)
    {
      region.box = *box;
      leave_to_sector(region);
    }
    else
    {
      region.follows_die = true;
      region.box         = bounding_box(surface.vertices());
      const Vec3 facing  = facing_of(surface, displacement, region.sector);
      if (facing.norm() > 0.)
        add_mouth(surface, facing, region);
      for (unsigned int i = 0; i < 3; ++i)
      {
        region.box.first[i] -= 1e-3 * surface.diagonal();
        region.box.second[i] += 1e-3 * surface.diagonal();
      }
    }
    const Vec3 size = region.box.second - region.box.first;
    if (!(region.volume(region.place(surface.vertices(), displacement)) > 1e-9 * size[0] * size[1] * size[2]))
      throw Error("Unfilled volume",
                  "the target lies behind a symmetry plane",
                  "only what faces the model is compared with it",
                  "move the target, or turn the plane's normal round");
    choose_eye(die, displacement, region);
    return region;
  }

#define RETROFORGE_INSTANTIATE(Number)                                                                       \
  template std::vector<HalfSpace<Number>> Region::mouth_and_sector(const RegionPlace<Number> &) const;       \
  template std::vector<HalfSpace<Number>> Region::half_spaces(const RegionPlace<Number> &) const;            \
  template Number                         Region::volume(const RegionPlace<Number> &) const;                 \
  template Number Region::shadow(const RegionPlace<Number> &, const std::array<Vector3<Number>, 3> &) const; \
  template Number shadow_in_tetrahedron(const Tetrahedron<Number> &,                                         \
                                        const Vector3<Number> &,                                             \
                                        const std::array<Vector3<Number>, 3> &,                              \
                                        const std::vector<HalfSpace<Number>> &);
  RETROFORGE_INSTANTIATE(double)
  RETROFORGE_INSTANTIATE(Dual)
  RETROFORGE_INSTANTIATE(Partials<n_partials>)
#undef RETROFORGE_INSTANTIATE
} // namespace retroforge
