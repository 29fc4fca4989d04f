// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/text.h>
#include <retroforge/geometry/surface_repair.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

namespace retroforge
{
  namespace
  {
    /// A larger part of a surface's area that says something else than the rest is no slip of an exporter.
    constexpr double largest_minority = 0.2;

    /// Gives equal corners one number, by a grid of cells as wide as the distance that counts as equal.
    class Merger
    {
    public:
      explicit Merger(const double distance) : distance_(distance) {}

      unsigned int operator()(const Vec3 &x)
      {
        const Key    home = key(x);
        unsigned int best = invalid_index;
        for (int i = 0; i < 27; ++i)
        {
          const auto found =
            cells_.find({{home[0] + i % 3 - 1, home[1] + i / 3 % 3 - 1, home[2] + i / 9 - 1}});
          if (found != cells_.end())
            for (const unsigned int v : found->second)
              if ((vertices[v] - x).norm() <= distance_)
                best = std::min(best, v);
        }
        if (best != invalid_index)
          return best;
        vertices.push_back(x);
        cells_[home].push_back(vertices.size() - 1);
        return vertices.size() - 1;
      }

      NodalVectors<double> vertices;

    private:
      using Key = std::array<long long, 3>;

      Key key(const Vec3 &x) const
      {
        Key k;
        for (unsigned int i = 0; i < 3; ++i)
          k[i] = std::llround(std::floor(x[i] / distance_));
        return k;
      }

      const double                             distance_;
      std::map<Key, std::vector<unsigned int>> cells_;
    };

    using EdgeEnds = std::pair<unsigned int, unsigned int>;

    /// The facets at each edge, which is named by its vertices, the lower one first.
    std::map<EdgeEnds, std::vector<unsigned int>> facets_at_edges(const std::vector<Triangle> &triangles)
    {
      std::map<EdgeEnds, std::vector<unsigned int>> at;
      for (unsigned int f = 0; f < triangles.size(); ++f)
        for (unsigned int e = 0; e < 3; ++e)
          at[std::minmax(triangles[f][e], triangles[f][(e + 1) % 3])].push_back(f);
      return at;
    }

    bool has_equal_corners(const Triangle &t)
    {
      return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
    }

    /// @return how many are left out
    template <typename Condition>
    unsigned int leave_out(Facets &facets, const Condition &condition)
    {
      unsigned int kept = 0;
      for (unsigned int f = 0; f < facets.triangles.size(); ++f)
        if (!condition(facets.triangles[f]))
        {
          facets.triangles[kept] = facets.triangles[f];
          facets.normals[kept]   = facets.normals[f];
          ++kept;
        }
      const unsigned int n = facets.triangles.size() - kept;
      facets.triangles.resize(kept);
      facets.normals.resize(kept);
      return n;
    }

    unsigned int leave_out_equal_corners(Facets &facets)
    {
      return leave_out(facets, has_equal_corners);
    }

    /// Removes all but the first of facets with the same corners in the same order, from whichever on.
    unsigned int leave_out_doubles(Facets &facets)
    {
      std::set<Triangle> known;
      return leave_out(facets, [&](Triangle t) {
        std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
        return !known.insert(t).second;
      });
    }

    /// @return how many vertices of the rim were joined with another one
    unsigned int close_seams(Facets &facets, const double seam)
    {
      std::vector<bool> on_rim(facets.vertices.size(), false);
      for (const auto &[edge, at] : facets_at_edges(facets.triangles))
        if (at.size() == 1)
          on_rim[edge.first] = on_rim[edge.second] = true;
      Merger                    merge(seam);
      std::vector<unsigned int> first_of; // vertex that each merged one stands for
      std::vector<unsigned int> joined(facets.vertices.size());
      std::iota(joined.begin(), joined.end(), 0);
      unsigned int n = 0;
      for (unsigned int v = 0; v < facets.vertices.size(); ++v)
        if (on_rim[v])
        {
          const unsigned int number = merge(facets.vertices[v]);
          if (number == first_of.size())
            first_of.push_back(v);
          joined[v] = first_of[number];
          n += joined[v] != v;
        }
      for (Triangle &t : facets.triangles)
        for (unsigned int &v : t)
          v = joined[v];
      return n;
    }

    /// The corner that stands on the opposite edge, which then is the longest one, or 3.
    unsigned int flat_corner(const Facets &facets, const Triangle &t)
    {
      const auto  &x       = facets.vertices;
      unsigned int longest = 0;
      const auto   length  = [&](const unsigned int e) { return (x[t[(e + 1) % 3]] - x[t[e]]).norm(); };
      for (unsigned int e = 1; e < 3; ++e)
        if (length(e) > length(longest))
          longest = e;
      const double area = facet_vector(x[t[0]], x[t[1]], x[t[2]]).norm();
      return area > least_facet_height * length(longest) * length(longest) ? 3 : (longest + 2) % 3;
    }

    /// Puts the middle vertex b of the flat facet f into the facet beyond its longest edge from c to a.
    /// @return false if there are several of those, or it is flat
    bool divide_beyond(Facets &facets, const unsigned int f, const unsigned int corner)
    {
      std::vector<Triangle> &triangles = facets.triangles;
      const unsigned int     b = triangles[f][corner], c = triangles[f][(corner + 1) % 3],
                         a = triangles[f][(corner + 2) % 3];
      unsigned int other   = invalid_index;
      for (unsigned int g = 0; g < triangles.size(); ++g)
        if (g != f && std::count(triangles[g].begin(), triangles[g].end(), a) > 0 &&
            std::count(triangles[g].begin(), triangles[g].end(), c) > 0)
        {
          if (other != invalid_index)
            return false;
          other = g;
        }
      // A neighbour with the same corners is flat, too, and turned the other way; any other flat one waits
      // until it is gone itself.
      const bool is_same =
        other != invalid_index && std::count(triangles[other].begin(), triangles[other].end(), b) > 0;
      if (other != invalid_index && !is_same && flat_corner(facets, triangles[other]) < 3)
        return false;
      triangles[f] = {{b, b, b}};
      if (is_same)
        triangles[other] = triangles[f];
      if (is_same || other == invalid_index)
        return true;
      triangles[f]      = triangles[other];
      facets.normals[f] = facets.normals[other];
      std::replace(triangles[other].begin(), triangles[other].end(), a, b);
      std::replace(triangles[f].begin(), triangles[f].end(), c, b);
      return true;
    }

    /// @return how many facets without height there were; beyond a thousand the surface is left to be refused
    unsigned int leave_out_flat(Facets &facets)
    {
      constexpr unsigned int most = 1000;
      unsigned int           n    = 0;
      for (bool any = true; any;)
      {
        const unsigned int before = n;
        for (unsigned int f = 0; f < facets.triangles.size() && n < most; ++f)
          if (const Triangle &t = facets.triangles[f]; !has_equal_corners(t))
            if (const unsigned int corner = flat_corner(facets, t); corner < 3)
              n += divide_beyond(facets, f, corner);
        leave_out_equal_corners(facets);
        any = n > before;
      }
      return n;
    }

    double area_of(const Facets &facets, const unsigned int f)
    {
      const Triangle &t = facets.triangles[f];
      return facet_vector(facets.vertices[t[0]], facets.vertices[t[1]], facets.vertices[t[2]]).norm() / 2;
    }

    bool runs_from_to(const Triangle &t, const unsigned int a, const unsigned int b)
    {
      return (t[0] == a && t[1] == b) || (t[1] == a && t[2] == b) || (t[2] == a && t[0] == b);
    }

    /// Returns whether each facet shows another side than the first one of its piece; empty where a piece has
    /// no two sides, or edges of more than two facets.
    /// @param pieces  the piece of each facet
    std::vector<bool> turned_facets(const Facets &facets, std::vector<unsigned int> &pieces)
    {
      std::vector<std::vector<std::pair<unsigned int, bool>>> next(facets.triangles.size());
      for (const auto &[edge, at] : facets_at_edges(facets.triangles))
      {
        if (at.size() > 2)
          return {};
        if (at.size() < 2)
          continue;
        const bool is_turned = runs_from_to(facets.triangles[at[0]], edge.first, edge.second) ==
                               runs_from_to(facets.triangles[at[1]], edge.first, edge.second);
        next[at[0]].emplace_back(at[1], is_turned);
        next[at[1]].emplace_back(at[0], is_turned);
      }
      std::vector<bool> turned(facets.triangles.size(), false);
      pieces.assign(facets.triangles.size(), invalid_index);
      unsigned int n_pieces = 0;
      for (unsigned int first = 0; first < pieces.size(); ++first)
      {
        if (pieces[first] != invalid_index)
          continue;
        std::vector<unsigned int> front = {first};
        pieces[first]                   = n_pieces;
        while (!front.empty())
        {
          const unsigned int f = front.back();
          front.pop_back();
          for (const auto &[g, is_turned] : next[f])
            if (pieces[g] == invalid_index)
            {
              pieces[g] = n_pieces;
              turned[g] = turned[f] != is_turned;
              front.push_back(g);
            }
            else if (turned[g] != (turned[f] != is_turned))
              return {};
        }
        ++n_pieces;
      }
      return turned;
    }

    /// Turns round the facets that show another side than the rest of their piece, where these are by far
    /// the smaller part of its area: else nobody knows which side is meant, and all stay as they are.
    /// @return how many were turned
    unsigned int turn_minority(Facets &facets)
    {
      std::vector<unsigned int>                     pieces;
      const std::vector<bool>                       turned = turned_facets(facets, pieces);
      std::map<unsigned int, std::array<double, 2>> areas; // of the piece, by side
      for (unsigned int f = 0; f < turned.size(); ++f)
        areas.try_emplace(pieces[f], std::array<double, 2>{{0., 0.}}).first->second[turned[f] ? 1 : 0] +=
          area_of(facets, f);
      for (const auto &[piece, area] : areas)
        if (std::min(area[0], area[1]) > largest_minority * (area[0] + area[1]))
          return 0;
      unsigned int n = 0;
      for (unsigned int f = 0; f < turned.size(); ++f)
        if (const auto &area = areas.at(pieces[f]); turned[f] == (area[0] >= area[1]))
        {
          std::swap(facets.triangles[f][1], facets.triangles[f][2]);
          ++n;
        }
      return n;
    }

    void leave_out_unused(Facets &facets)
    {
      std::vector<unsigned int> number(facets.vertices.size(), 0);
      for (const Triangle &t : facets.triangles)
        for (const unsigned int v : t)
          number[v] = 1;
      NodalVectors<double> used;
      for (unsigned int v = 0; v < facets.vertices.size(); ++v)
        if (number[v] == 1)
        {
          number[v] = used.size();
          used.push_back(facets.vertices[v]);
        }
      for (Triangle &t : facets.triangles)
        for (unsigned int &v : t)
          v = number[v];
      facets.vertices = std::move(used);
    }
  } // namespace

  Facets merge_corners(const NodalVectors<double> &corners,
                       const NodalVectors<double> &normals,
                       const double                distance)
  {
    Merger merge(distance);
    Facets facets;
    facets.normals = normals;
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
      facets.triangles.push_back({{merge(corners[i]), merge(corners[i + 1]), merge(corners[i + 2])}});
    facets.vertices = merge.vertices;
    return facets;
  }

  std::vector<std::string> mend(Facets &facets, const double seam)
  {
    std::vector<std::string> done;
    const auto tell = [&](const unsigned int n, const std::string &one, const std::string &many) {
      if (n > 0)
        done.push_back(n == 1 ? "one " + one : std::to_string(n) + " " + many);
    };
    unsigned int n_collapsed = leave_out_equal_corners(facets);
    const auto   n_doubles   = leave_out_doubles(facets);
    const auto   n_joined    = close_seams(facets, seam);
    n_collapsed += leave_out_equal_corners(facets);
    n_collapsed += leave_out_flat(facets);
    leave_out_unused(facets);
    const auto n_turned = turn_minority(facets);
    tell(n_collapsed, "facet without area was left out", "facets without area were left out");
    tell(n_doubles, "facet that was there twice was left out", "facets that were there twice were left out");
    tell(n_joined,
         "vertex of the rim was joined with another, nearer to it than " + as_text(seam),
         "vertices of the rim were joined with others, nearer to them than " + as_text(seam));
    tell(n_turned,
         "facet that showed another side than its neighbours was turned",
         "facets that showed another side than their neighbours were turned");
    return done;
  }

  NormalsAgainst normals_against_corners(const Facets &facets)
  {
    NormalsAgainst found;
    double         area_with_normal = 0., area_against = 0.;
    for (unsigned int f = 0; f < facets.triangles.size(); ++f)
    {
      const Triangle &t      = facets.triangles[f];
      const Vec3     &normal = facets.normals[f];
      const Vec3      v = facet_vector(facets.vertices[t[0]], facets.vertices[t[1]], facets.vertices[t[2]]);
      if (!(normal.norm() > 0.))
        continue;
      area_with_normal += v.norm();
      // Near a right angle rounding decides.
      if (normal * v < -0.1 * normal.norm() * v.norm())
      {
        found.first = std::min(found.first, f);
        ++found.n;
        area_against += v.norm();
      }
    }
    found.are_few = area_against <= largest_minority * area_with_normal;
    return found;
  }
} // namespace retroforge
