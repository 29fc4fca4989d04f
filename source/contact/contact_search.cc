// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/contact/contact_search.h>
#include <retroforge/core/shares.h>

#include <algorithm>

namespace retroforge
{
  /// Relative difference of squared speeds up to which the choice between two velocities is not left to
  /// rounding.
  constexpr double as_fast = 1e-9;

  template <typename Number>
  Number FrictionRamp::operator()(const Number &delta, const bool touching) const
  {
    if (sharp)
      return Number(touching ? 1. : 0.);
    const double d = value_of(delta);
    if (d <= 0. || d >= width)
      return Number(d <= 0. ? 1. : 0.);
    const Number t = delta / width;
    return 1. - t * t * t * (10. - t * (15. - 6. * t));
  }

  double FrictionRamp::derivative(const double delta) const
  {
    if (sharp || delta <= 0. || delta >= width)
      return 0.;
    const double t = delta / width;
    return -30. * t * t * (1. - t) * (1. - t) / width;
  }

  template <typename Number>
  RampScales<Number>::RampScales(const FrictionRamp &ramp, const std::vector<DieState<Number>> &states)
      : states_(states), wall_(ramp.wall)
  {
    Assert(wall_ > 0. && wall_ <= 1., dealii::ExcMessage("walls have a part of the ramp's width"));
    if (wall_ == 1.)
      return;
    for (unsigned int d = 0; d < states.size(); ++d)
    {
      Closing fastest{states[d].velocity};
      for (unsigned int b = 0; b < states.size(); ++b)
      {
        const Vector3<Number> relative = states[d].velocity - states[b].velocity;
        if (b != d &&
            value_of(relative * relative) > value_of(fastest.velocity * fastest.velocity) * (1. + as_fast))
          fastest = {relative, b};
      }
      closing_.push_back(fastest);
    }
  }

  template <typename Number>
  Number RampScales<Number>::operator()(const unsigned int     die,
                                        const Vector3<Number> &n,
                                        const Vector3<Number> *metal) const
  {
    using std::sqrt;
    if (closing_.empty())
      return Number(1.);
    const Vector3<Number> &c  = closing_[die].velocity;
    const Number           c2 = c * c;
    if (value_of(c2) == 0.)
      return Number(1.);
    const Number nearer = metal ? (*metal - states_[die].velocity) * n : n * c;
    if (metal && value_of(nearer) <= 0.)
      return Number(wall_);
    return sqrt(Number(wall_ * wall_ + (1. - wall_ * wall_) * (nearer * nearer / c2)));
  }

  template <typename Number>
  void RampScales<Number>::reverse(const unsigned int             die,
                                   const Vector3<Number>         &n,
                                   const Vector3<Number>         *metal,
                                   const double                   s_bar,
                                   Vector3<Number>               &n_bar,
                                   Vector3<Number>               &metal_bar,
                                   std::vector<DieState<Number>> &states_bar) const
  {
    if (closing_.empty() || s_bar == 0.)
      return;
    const Vector3<Number> &c  = closing_[die].velocity;
    const Number           c2 = c * c;
    if (value_of(c2) == 0.)
      return;
    const Vector3<Number> u      = metal ? *metal - states_[die].velocity : c;
    const Number          nearer = u * n;
    if (metal && value_of(nearer) <= 0.)
      return;
    // First in (u·n), then in c, of (u·n)^2/c^2.
    const Number nearer_bar = s_bar * (1. - wall_ * wall_) * nearer / (c2 * (*this)(die, n, metal));
    n_bar += nearer_bar * u;
    Vector3<Number> c_bar = -(nearer_bar * nearer / c2) * c;
    if (metal)
    {
      metal_bar += nearer_bar * n;
      states_bar[die].velocity -= nearer_bar * n;
    }
    else
      c_bar += nearer_bar * n;
    states_bar[die].velocity += c_bar;
    if (closing_[die].other != invalid_index)
      states_bar[closing_[die].other].velocity -= c_bar;
  }

  namespace
  {
    /// Least bulge of a die into an edge that counts, as a part of the edge's length, as seen from its ends.
    constexpr double least_bulge = 1e-6;

    /// One of the points looked at, as it sees a die.
    struct Seen
    {
      unsigned int point;
      DieFeature   feature;
      double       delta;
      bool         touching; ///< delta <= width of the ramp there
    };

    /// Returns the features of die d that points 0 … n - 1 see within reach, ascending. Each rank looks at
    /// its share of them.
    /// @param point  returns one of them
    template <typename Point>
    std::vector<Seen> seen_by(const ContactView<double> &view,
                              const FrictionRamp        &ramp,
                              const unsigned int         d,
                              const std::size_t          n,
                              const double               reach,
                              const Point               &point)
    {
      const RampScales<double> scales(ramp, view.states);
      std::vector<Seen>        seen;
      const auto [begin, end] = share_of_rank(n, view.comm);
      for (std::size_t i = begin; i < end; ++i)
      {
        const ContactPoint at = point(i);
        const Vec3         x  = at.position(view.X);
        if (const DieFeature feature = view.dies[d].closest(x, view.states[d].displacement, reach);
            feature.found())
        {
          const auto [delta, normal] = view.dies[d].project(x, view.states[d], feature);
          const auto metal           = view.velocity_of(at);
          const bool touching        = delta <= ramp.width * scales(d, normal, metal ? &*metal : nullptr);
          seen.push_back({static_cast<unsigned int>(i), feature, delta, touching});
        }
      }
      return joined(std::move(seen), view.comm);
    }

    /// Adds the middles of edges in reach of die d that are deeper in it than their ends.
    /// @param delta  of each node to this die; infinite out of reach
    void add_edges(const ContactView<double> &view,
                   const unsigned int         d,
                   const std::vector<double> &delta,
                   const FrictionRamp        &ramp,
                   const double               reach,
                   std::vector<ContactPair>  &pairs)
    {
      const auto            &X     = view.X;
      const auto            &edges = view.topology.surface_edges;
      std::vector<NodeIndex> ends;
      const auto middle = [&](const std::size_t e) { return ContactPoint::middle(edges[e][0], edges[e][1]); };
      for (const auto &[e, feature, at_middle, touching] :
           seen_by(view, ramp, d, edges.size(), reach, middle))
      {
        const auto &[a, b] = edges[e];
        if (at_middle <= reach &&
            at_middle < 0.5 * (delta[a] + delta[b]) - least_bulge * (X[a] - X[b]).norm())
        {
          pairs.push_back({ContactPoint::middle(a, b), d, touching, feature});
          for (const NodeIndex k : edges[e])
            if (!(delta[k] <= reach))
              ends.push_back(k);
        }
      }
      std::sort(ends.begin(), ends.end());
      ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
      const auto     node      = [&](const std::size_t i) { return ContactPoint::node(ends[i]); };
      constexpr auto any_reach = std::numeric_limits<double>::max();
      for (const Seen &seen : seen_by(view, ramp, d, ends.size(), any_reach, node))
        pairs.push_back({ContactPoint::node(ends[seen.point]), d, false, seen.feature});
    }
  } // namespace

  std::vector<ContactPair> find_contact_pairs(const ContactView<double> &view,
                                              const FrictionRamp        &ramp,
                                              const double               reach,
                                              const bool                 with_edges)
  {
    AssertDimension(view.X.size(), view.mesh.n_nodes());
    AssertDimension(view.states.size(), view.dies.size());
    Assert(reach >= 0., dealii::ExcMessage("the reach is a distance"));
    const auto              &X     = view.X;
    const auto              &edges = view.topology.surface_edges;
    std::vector<NodeIndex>   nodes;
    std::vector<ContactPair> pairs;
    for (NodeIndex k = 0; k < X.size(); ++k)
      if (view.topology.is_on_surface(k))
        nodes.push_back(k);
    const auto node   = [&](const std::size_t i) { return ContactPoint::node(nodes[i]); };
    const auto middle = [&](const std::size_t e) {
      const auto &[a, b] = edges[e];
      return ContactPoint::middle(a, b, view.edges->between(a, b));
    };
    for (unsigned int d = 0; d < view.dies.size(); ++d)
    {
      if (view.states[d].in_press == 0)
        continue;
      const auto add = [&](const ContactPoint &point, const Seen &seen) {
        if (seen.delta <= reach)
          pairs.push_back({point, d, seen.touching, seen.feature});
      };
      std::vector<double> delta(X.size(), std::numeric_limits<double>::infinity());
      for (const Seen &seen : seen_by(view, ramp, d, nodes.size(), reach, node))
      {
        delta[nodes[seen.point]] = seen.delta;
        add(ContactPoint::node(nodes[seen.point]), seen);
      }
      if (view.edges)
        for (const Seen &seen : seen_by(view, ramp, d, edges.size(), reach, middle))
          add(middle(seen.point), seen);
      else if (with_edges && view.dies[d].surface())
        add_edges(view, d, delta, ramp, reach, pairs);
    }
    return pairs;
  }

  template double FrictionRamp::operator()(const double &, bool) const;
  template Dual FrictionRamp::operator()(const Dual &, bool) const;
  template RampScales<double>::RampScales(const FrictionRamp &, const std::vector<DieState<double>> &);
  template RampScales<Dual>::RampScales(const FrictionRamp &, const std::vector<DieState<Dual>> &);
  template double RampScales<double>::operator()(unsigned int, const Vec3 &, const Vec3 *) const;
  template Dual
  RampScales<Dual>::operator()(unsigned int, const Vector3<Dual> &, const Vector3<Dual> *) const;
} // namespace retroforge
