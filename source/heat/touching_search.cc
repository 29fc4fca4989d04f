// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/heat/touching_search.h>

#include <map>

namespace retroforge
{
  namespace
  {
    template <typename Number>
    Vec3 values(const Vector3<Number> &x)
    {
      return Vec3({value_of(x[0]), value_of(x[1]), value_of(x[2])});
    }

    /// What a die is in reach of: nodes, ascending, and edges, their ends not known yet.
    template <typename Number>
    struct Seen
    {
      std::map<NodeIndex, DieFeature>   nodes;
      std::vector<TouchingEdge<Number>> edges;
    };

    template <typename Number>
    Seen<Number> seen_by(const ContactView<Number> &view, const unsigned int d, const ThermalReach &wanted)
    {
      const Die &die          = view.dies[d];
      const Vec3 displacement = values(view.states[d].displacement);
      const auto delta        = [&](const Vec3 &x, const DieFeature &feature) {
        return value_of(die.project(Vector3<Number>(x), view.states[d], feature).delta);
      };
      const Arrivals<Number> arrivals(wanted, view.states);
      Seen<Number>           seen;
      for (NodeIndex k = 0; k < view.mesh.n_nodes(); ++k)
        if (view.topology.is_on_surface(k))
        {
          const Vec3       x       = values(view.X[k]);
          const double     reach   = arrivals.reach(d, MetalVelocity<Number>(view, k).get());
          const DieFeature feature = die.closest(x, displacement, reach);
          if (!feature.found())
            continue;
          if (delta(x, feature) < reach)
            seen.nodes.emplace(k, feature);
        }
      for (std::size_t e = 0; e < view.topology.surface_edges.size() && die.surface(); ++e)
      {
        const auto      &nodes   = view.topology.surface_edges[e];
        const Vec3       x       = values(middle_of(view.X, nodes));
        const double     reach   = arrivals.reach(d, MetalVelocity<Number>(view, nodes).get());
        const DieFeature feature = die.closest(x, displacement, reach);
        if (!feature.found() || !(delta(x, feature) < reach))
          continue;
        double                    bulge = -delta(x, feature);
        std::array<DieFeature, 2> ends;
        for (unsigned int i = 0; i < 2; ++i)
        {
          const Vec3 end   = values(view.X[nodes[i]]);
          const auto found = seen.nodes.find(nodes[i]);
          ends[i]          = found != seen.nodes.end() ? found->second
                                                       : die.closest(end, displacement, reach + (end - x).norm());
          if (ends[i].found())
            bulge += 0.5 * delta(end, ends[i]);
        }
        // What comes nearer may be found with a bulge at the end of the increment.
        if (!ends[0].found() || !ends[1].found() || !(bulge > 0. || wanted.path > 0.))
          continue;
        for (unsigned int i = 0; i < 2; ++i)
          seen.nodes.emplace(nodes[i], ends[i]);
        const auto &images = view.topology.edge_images[e];
        seen.edges.push_back({d, feature, nodes, {{invalid_index, invalid_index}}, {{images[0], images[1]}}});
      }
      return seen;
    }
  } // namespace

  template <typename Number>
  ThermalSurface<Number>
  find_touching(const ContactView<Number> &view, const std::vector<bool> &touch, const ThermalReach &reach)
  {
    AssertDimension(touch.size(), view.dies.size());
    ThermalSurface<Number> surface{{}, {}, {}, std::vector<Number>(view.mesh.n_nodes(), Number(0.))};
    for (unsigned int d = 0; d < view.dies.size(); ++d)
      if (touch[d])
      {
        const Seen<Number>                seen = seen_by(view, d, reach);
        std::map<NodeIndex, unsigned int> entries;
        for (const auto &[k, feature] : seen.nodes)
        {
          entries.emplace(k, surface.touching.size());
          surface.touching.push_back({k, d, feature, Number(0.)});
        }
        for (TouchingEdge<Number> edge : seen.edges)
        {
          edge.ends = {{entries.at(edge.nodes[0]), entries.at(edge.nodes[1])}};
          surface.edges.push_back(edge);
        }
      }
    return surface;
  }

  template <typename Number>
  Sights<Number>::Sights(const ContactView<Number> &view, const ThermalSurface<Number> &surface)
  {
    for (const auto &at : surface.touching)
      of_nodes.push_back(view.dies[at.die].project(view.X[at.node], view.states[at.die], at.feature));
    for (const auto &edge : surface.edges)
      of_middles.push_back(
        view.dies[edge.die].project(middle_of(view.X, edge.nodes), view.states[edge.die], edge.feature));
  }

  void reverse_sights(const ContactView<double>     &view,
                      const ThermalSurface<double>  &surface,
                      const std::vector<SightBar>   &nodes_bar,
                      const std::vector<SightBar>   &middles_bar,
                      NodalVectors<double>          &X_bar,
                      std::vector<DieState<double>> &dies_bar)
  {
    const auto reverse =
      [&](const unsigned int d, const Vec3 &x, const DieFeature &feature, const SightBar &bar) {
        Vec3              x_bar;
        DieState<double> &die_bar = dies_bar[d];
        if (bar.delta != 0. || bar.n.norm_square() != 0.)
          view.dies[d].reverse_project(x,
                                       view.states[d].displacement,
                                       feature,
                                       bar.delta,
                                       bar.n,
                                       x_bar,
                                       die_bar.displacement,
                                       die_bar.vertices.empty() ? nullptr : &die_bar.vertices);
        return x_bar;
      };
    for (std::size_t i = 0; i < surface.touching.size(); ++i)
    {
      const auto &node = surface.touching[i];
      X_bar[node.node] += reverse(node.die, view.X[node.node], node.feature, nodes_bar[i]);
    }
    for (std::size_t e = 0; e < surface.edges.size(); ++e)
    {
      const auto &edge  = surface.edges[e];
      const Vec3  x_bar = reverse(edge.die, middle_of(view.X, edge.nodes), edge.feature, middles_bar[e]);
      for (const NodeIndex k : edge.nodes)
        X_bar[k] += 0.5 * x_bar;
    }
  }

#define RETROFORGE_INSTANTIATE(Number)                                             \
  template ThermalSurface<Number> find_touching(                                   \
    const ContactView<Number> &, const std::vector<bool> &, const ThermalReach &); \
  template struct Sights<Number>;
  RETROFORGE_INSTANTIATE(double)
  RETROFORGE_INSTANTIATE(Dual)
#undef RETROFORGE_INSTANTIATE
} // namespace retroforge
