// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/heat/touching_search.h>
#include <retroforge/mesh/surface_areas.h>

#include <algorithm>
#include <map>

namespace retroforge
{
  namespace
  {
    /// As far as nodes and middles touch by themselves.
    template <typename Number>
    struct OwnWeights
    {
      std::vector<Number> of_nodes, of_middles;
    };

    /// The factors of weights, in a fixed order: `use(edge, entry of an end)`.
    template <typename Number, typename Use>
    void for_each_factor(const ThermalSurface<Number> &surface, const Use &use)
    {
      for (unsigned int e = 0; e < surface.edges.size(); ++e)
        for (unsigned int i = 0; i < 2; ++i)
          for (unsigned int image = 0; image < surface.edges[e].images[i]; ++image)
            use(e, surface.edges[e].ends[i]);
    }

    /// For each die, the entry of each node in `touching`; none: invalid_index.
    template <typename Number>
    std::vector<std::vector<unsigned int>>
    entries_of(const ThermalSurface<Number> &surface, const std::size_t n_dies, const std::size_t n_nodes)
    {
      std::vector<std::vector<unsigned int>> entries(n_dies);
      for (unsigned int i = 0; i < surface.touching.size(); ++i)
      {
        auto &of_die = entries[surface.touching[i].die];
        of_die.resize(n_nodes, invalid_index);
        of_die[surface.touching[i].node] = i;
      }
      return entries;
    }

    /// The faces of the surface, and of each the dies that all its nodes reach, by their entries:
    /// `use(face, entries)`.
    template <typename Use>
    void
    for_each_face(const TetMesh &mesh, const std::vector<std::vector<unsigned int>> &entries, const Use &use)
    {
      std::vector<std::array<unsigned int, 3>> at;
      for (const BoundaryFace &face : mesh.faces)
      {
        if (!mesh.is_surface(face))
          continue;
        at.clear();
        for (const auto &of_die : entries)
          if (!of_die.empty())
          {
            const std::array<unsigned int, 3> corners{
              {of_die[face.nodes[0]], of_die[face.nodes[1]], of_die[face.nodes[2]]}};
            if (std::find(corners.begin(), corners.end(), invalid_index) == corners.end())
              at.push_back(corners);
          }
        use(face, at);
      }
    }

    template <typename Number>
    Number product(const ThermalSurface<Number> &surface, const std::array<unsigned int, 3> &corners)
    {
      return surface.touching[corners[0]].weight * surface.touching[corners[1]].weight *
             surface.touching[corners[2]].weight;
    }

    /// Sets all that follows from what nodes and middles do by themselves.
    template <typename Number>
    void complete(const ContactView<Number> &view,
                  const Sights<Number>      &at,
                  const OwnWeights<Number>  &own,
                  const FrictionRamp        &w,
                  ThermalSurface<Number>    &surface)
    {
      for (unsigned int i = 0; i < surface.touching.size(); ++i)
        surface.touching[i].weight = own.of_nodes[i];
      for_each_factor(surface, [&](const unsigned int e, const unsigned int i) {
        Number &weight = surface.touching[i].weight;
        weight += (1. - weight) * w.part_of_edge(at.bulge(surface.edges[e], e)) * own.of_middles[e];
      });
      for_each_face(
        view.mesh,
        entries_of(surface, view.dies.size(), view.mesh.n_nodes()),
        [&](const BoundaryFace &face, const std::vector<std::array<unsigned int, 3>> &corners_at) {
          const Number third = triangle_area(face.nodes, view.X) / 3.;
          Number       free  = third;
          for (const auto &corners : corners_at)
          {
            const Number touches = product(surface, corners);
            surface.faces.push_back({corners, third * touches});
            for (const unsigned int i : corners)
              surface.touching[i].area += third * touches;
            free *= 1. - touches;
          }
          for (const NodeIndex k : face.nodes)
            surface.free[k] += free;
        });
    }

    /// Reverse of complete(): adds to X_bar and to the sights'.
    /// @return derivatives in what nodes and middles do by themselves
    OwnWeights<double> reverse_complete(const ContactView<double>    &view,
                                        const Sights<double>         &at,
                                        const OwnWeights<double>     &own,
                                        const FrictionRamp           &w,
                                        const ThermalSurface<double> &surface,
                                        const ThermalSurfaceBar      &bar,
                                        NodalVectors<double>         &X_bar,
                                        std::vector<SightBar>        &nodes_bar,
                                        std::vector<SightBar>        &middles_bar)
    {
      std::vector<double> weight_bar = bar.weight;
      unsigned int        face_index = 0;
      for_each_face(
        view.mesh,
        entries_of(surface, view.dies.size(), view.mesh.n_nodes()),
        [&](const BoundaryFace &face, const std::vector<std::array<unsigned int, 3>> &corners_at) {
          const double third    = triangle_area(face.nodes, view.X) / 3.;
          double       area_bar = 0., free_bar = 0., free = 1.;
          for (const NodeIndex k : face.nodes)
            free_bar += bar.free[k];
          for (const auto &corners : corners_at)
            free *= 1. - product(surface, corners);
          area_bar += free * free_bar;
          for (unsigned int j = 0; j < corners_at.size(); ++j)
          {
            const double touches     = product(surface, corners_at[j]);
            double       touches_bar = third * bar.face_area[face_index++], others = 1.;
            for (const unsigned int i : corners_at[j])
              touches_bar += third * bar.touching_area[i];
            area_bar += touches_bar / third * touches;
            for (unsigned int l = 0; l < corners_at.size(); ++l)
              if (l != j)
                others *= 1. - product(surface, corners_at[l]);
            touches_bar -= third * others * free_bar;
            for (unsigned int i = 0; i < 3; ++i)
              weight_bar[corners_at[j][i]] += touches_bar *
                                              surface.touching[corners_at[j][(i + 1) % 3]].weight *
                                              surface.touching[corners_at[j][(i + 2) % 3]].weight;
          }
          reverse_triangle_area(face.nodes, view.X, area_bar / 3., X_bar);
        });
      OwnWeights<double>                       own_bar{{}, std::vector<double>(surface.edges.size(), 0.)};
      std::vector<double>                      weight = own.of_nodes, before;
      std::vector<std::array<unsigned int, 2>> factors;
      for_each_factor(surface, [&](const unsigned int e, const unsigned int i) {
        factors.push_back({{e, i}});
        before.push_back(weight[i]);
        weight[i] += (1. - weight[i]) * w.part_of_edge(at.bulge(surface.edges[e], e)) * own.of_middles[e];
      });
      for (std::size_t f = factors.size(); f-- > 0;)
      {
        const auto &[e, i] = factors[f];
        const auto  &edge  = surface.edges[e];
        const double part = w.part_of_edge(at.bulge(edge, e)), missing_bar = (1. - before[f]) * weight_bar[i];
        const double bulge_bar = missing_bar * own.of_middles[e] * w.slope_of_edge(at.bulge(edge, e));
        own_bar.of_middles[e] += missing_bar * part;
        middles_bar[e].delta -= bulge_bar;
        for (const unsigned int end : edge.ends)
          nodes_bar[end].delta += 0.5 * bulge_bar;
        weight_bar[i] *= 1. - part * own.of_middles[e];
      }
      own_bar.of_nodes = std::move(weight_bar);
      return own_bar;
    }

    /// What is known from the start of an increment of what its second half finds.
    class Earlier
    {
    public:
      template <typename Number>
      explicit Earlier(const ThermalSurface<Number> &start)
      {
        for (unsigned int i = 0; i < start.touching.size(); ++i)
          nodes_.emplace(std::make_pair(start.touching[i].die, start.touching[i].node), i);
        for (unsigned int e = 0; e < start.edges.size(); ++e)
          edges_.emplace(std::make_pair(start.edges[e].die, start.edges[e].nodes), e);
      }

      /// Returns the entry of a node in `touching`, or invalid_index.
      unsigned int node(const unsigned int die, const NodeIndex k) const
      {
        const auto found = nodes_.find({die, k});
        return found == nodes_.end() ? invalid_index : found->second;
      }
      template <typename Number>
      unsigned int edge(const TouchingEdge<Number> &edge) const
      {
        const auto found = edges_.find({edge.die, edge.nodes});
        return found == edges_.end() ? invalid_index : found->second;
      }

    private:
      std::map<std::pair<unsigned int, NodeIndex>, unsigned int>                nodes_;
      std::map<std::pair<unsigned int, std::array<NodeIndex, 2>>, unsigned int> edges_;
    };

    template <typename Number>
    struct Expectations
    {
      std::vector<Expected<Number>> of_nodes, of_middles;
    };

    /// Of what touches at the end: what was out of reach at the start has no part.
    template <typename Number>
    Expectations<Number> expectations(const Earlier                &earlier,
                                      const ThermalSurface<Number> &start,
                                      const ThermalSurface<Number> &surface)
    {
      Expectations<Number> later;
      for (const auto &at : surface.touching)
      {
        const unsigned int i = earlier.node(at.die, at.node);
        later.of_nodes.push_back(i == invalid_index ? Expected<Number>() : start.touching[i].later);
      }
      for (const auto &edge : surface.edges)
      {
        const unsigned int e = earlier.edge(edge);
        later.of_middles.push_back(e == invalid_index ? Expected<Number>() : start.edges[e].later);
      }
      return later;
    }

    /// What touches in the second half is nearer than the gap and the gap that was expected, itself below the first.
    ThermalReach reach_at_end(const double gap)
    {
      return {2. * gap};
    }

    /// As far as a point at a gap touches in the second half.
    template <typename Number>
    Number touches(const Number &delta, const Expected<Number> &later, const FrictionRamp &w)
    {
      return later.part * w(Number(delta - later.gap), true);
    }

    /// Reverse of touches().
    Expected<double> reverse_touches(const double            delta,
                                     const Expected<double> &later,
                                     const FrictionRamp     &w,
                                     const double            bar,
                                     double                 &delta_bar)
    {
      const double farther = delta - later.gap, farther_bar = bar * later.part * w.derivative(farther);
      delta_bar += farther_bar;
      return {bar * w(farther, true), -farther_bar};
    }

    template <typename Number>
    OwnWeights<Number>
    at_end(const Sights<Number> &at, const Expectations<Number> &later, const FrictionRamp &w)
    {
      OwnWeights<Number> own;
      for (std::size_t i = 0; i < later.of_nodes.size(); ++i)
        own.of_nodes.push_back(touches(at.of_nodes[i].delta, later.of_nodes[i], w));
      for (std::size_t e = 0; e < later.of_middles.size(); ++e)
        own.of_middles.push_back(touches(at.of_middles[e].delta, later.of_middles[e], w));
      return own;
    }

    /// How all points arrive.
    template <typename Number>
    struct AllArrivals
    {
      std::vector<Arrival<Number>> of_nodes, of_middles;

      AllArrivals(const ContactView<Number>    &view,
                  const ThermalSurface<Number> &surface,
                  const Arrivals<Number>       &arrivals,
                  const Sights<Number>         &at)
      {
        for (std::size_t i = 0; i < surface.touching.size(); ++i)
        {
          const auto &node = surface.touching[i];
          of_nodes.push_back(
            arrivals(node.die, at.of_nodes[i], MetalVelocity<Number>(view, node.node).get()));
        }
        for (std::size_t e = 0; e < surface.edges.size(); ++e)
        {
          const auto &edge = surface.edges[e];
          of_middles.push_back(
            arrivals(edge.die, at.of_middles[e], MetalVelocity<Number>(view, edge.nodes).get()));
        }
      }

      OwnWeights<Number> first_half() const
      {
        OwnWeights<Number> own;
        for (const auto &arrival : of_nodes)
          own.of_nodes.push_back(arrival.first);
        for (const auto &arrival : of_middles)
          own.of_middles.push_back(arrival.first);
        return own;
      }
    };
  } // namespace

  template <typename Number>
  ThermalSurface<Number>
  thermal_surface(const ContactView<Number> &view, const std::vector<bool> &touch, const ThermalReach &reach)
  {
    ThermalSurface<Number>    surface = find_touching(view, touch, reach);
    const Sights<Number>      at(view, surface);
    const AllArrivals<Number> arrivals(view, surface, Arrivals<Number>(reach, view.states), at);
    for (std::size_t i = 0; i < surface.touching.size(); ++i)
      surface.touching[i].later = {arrivals.of_nodes[i].second, arrivals.of_nodes[i].gap};
    for (std::size_t e = 0; e < surface.edges.size(); ++e)
      surface.edges[e].later = {arrivals.of_middles[e].second, arrivals.of_middles[e].gap};
    complete(view, at, arrivals.first_half(), reach.fading(), surface);
    return surface;
  }

  template <typename Number>
  ThermalSurface<Number> thermal_surface_after(const ThermalSurface<Number> &start,
                                               const ContactView<Number>    &view,
                                               const std::vector<bool>      &touch,
                                               const double                  gap)
  {
    ThermalSurface<Number> surface = find_touching(view, touch, reach_at_end(gap));
    const Sights<Number>   at(view, surface);
    const FrictionRamp     w = ThermalReach(gap).fading();
    complete(view, at, at_end(at, expectations(Earlier(start), start, surface), w), w, surface);
    return surface;
  }

  void reverse_thermal_surface(const ContactView<double>     &view,
                               const ThermalSurface<double>  &surface,
                               const ThermalReach            &reach,
                               const ThermalSurfaceBar       &bar,
                               NodalVectors<double>          &X_bar,
                               std::vector<DieState<double>> &dies_bar,
                               NodalVectors<double>          *velocity_bar)
  {
    const Sights<double>   at(view, surface);
    const Arrivals<double> arrivals(reach, view.states);
    std::vector<SightBar>  nodes_bar(surface.touching.size()), middles_bar(surface.edges.size());
    const auto             own_bar         = reverse_complete(view,
                                          at,
                                          AllArrivals<double>(view, surface, arrivals, at).first_half(),
                                          reach.fading(),
                                          surface,
                                          bar,
                                          X_bar,
                                          nodes_bar,
                                          middles_bar);
    const auto             reverse_arrival = [&](const unsigned int           die,
                                     const Projection<double>    &sight,
                                     const MetalVelocity<double> &metal,
                                     const double                 first_bar,
                                     const Expected<double>      &later_bar,
                                     SightBar                    &sight_bar) {
      Vec3 metal_bar;
      if (first_bar != 0. || later_bar.part != 0. || later_bar.gap != 0.)
        arrivals.reverse(die,
                         sight,
                         metal.get(),
                         {first_bar, later_bar.part, later_bar.gap},
                         sight_bar.delta,
                         sight_bar.n,
                         metal_bar,
                         dies_bar);
      return metal_bar;
    };
    for (std::size_t i = 0; i < surface.touching.size(); ++i)
    {
      const auto &node      = surface.touching[i];
      const Vec3  metal_bar = reverse_arrival(
        node.die, at.of_nodes[i], {view, node.node}, own_bar.of_nodes[i], bar.later[i], nodes_bar[i]);
      if (velocity_bar)
        (*velocity_bar)[node.node] += metal_bar;
    }
    for (std::size_t e = 0; e < surface.edges.size(); ++e)
    {
      const auto &edge      = surface.edges[e];
      const Vec3  metal_bar = reverse_arrival(edge.die,
                                             at.of_middles[e],
                                             {view, edge.nodes},
                                             own_bar.of_middles[e],
                                             bar.later_of_edge[e],
                                             middles_bar[e]);
      if (velocity_bar)
        for (const NodeIndex k : edge.nodes)
          (*velocity_bar)[k] += 0.5 * metal_bar;
    }
    reverse_sights(view, surface, nodes_bar, middles_bar, X_bar, dies_bar);
  }

  void reverse_thermal_surface_after(const ThermalSurface<double>  &start,
                                     const ContactView<double>     &view,
                                     const ThermalSurface<double>  &surface,
                                     const double                   gap,
                                     const ThermalSurfaceBar       &bar,
                                     ThermalSurfaceBar             &start_bar,
                                     NodalVectors<double>          &X_bar,
                                     std::vector<DieState<double>> &dies_bar)
  {
    const Earlier              earlier(start);
    const Sights<double>       at(view, surface);
    const FrictionRamp         w     = ThermalReach(gap).fading();
    const Expectations<double> later = expectations(earlier, start, surface);
    std::vector<SightBar>      nodes_bar(surface.touching.size()), middles_bar(surface.edges.size());
    const auto                 own_bar =
      reverse_complete(view, at, at_end(at, later, w), w, surface, bar, X_bar, nodes_bar, middles_bar);
    const auto add = [](const Expected<double> &from, Expected<double> &to) {
      to.part += from.part;
      to.gap += from.gap;
    };
    for (unsigned int i = 0; i < surface.touching.size(); ++i)
    {
      const auto &node = surface.touching[i];
      const auto  later_bar =
        reverse_touches(at.of_nodes[i].delta, later.of_nodes[i], w, own_bar.of_nodes[i], nodes_bar[i].delta);
      if (const unsigned int entry = earlier.node(node.die, node.node); entry != invalid_index)
        add(later_bar, start_bar.later[entry]);
    }
    for (unsigned int e = 0; e < surface.edges.size(); ++e)
    {
      const auto &edge      = surface.edges[e];
      const auto  later_bar = reverse_touches(
        at.of_middles[e].delta, later.of_middles[e], w, own_bar.of_middles[e], middles_bar[e].delta);
      if (const unsigned int entry = earlier.edge(edge); entry != invalid_index)
        add(later_bar, start_bar.later_of_edge[entry]);
    }
    reverse_sights(view, surface, nodes_bar, middles_bar, X_bar, dies_bar);
  }

#define RETROFORGE_INSTANTIATE(Number)                                             \
  template ThermalSurface<Number> thermal_surface(                                 \
    const ContactView<Number> &, const std::vector<bool> &, const ThermalReach &); \
  template ThermalSurface<Number> thermal_surface_after(                           \
    const ThermalSurface<Number> &, const ContactView<Number> &, const std::vector<bool> &, double);
  RETROFORGE_INSTANTIATE(double)
  RETROFORGE_INSTANTIATE(Dual)
#undef RETROFORGE_INSTANTIATE
} // namespace retroforge
