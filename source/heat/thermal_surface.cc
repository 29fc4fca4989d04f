// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/heat/thermal_surface.h>
#include <retroforge/mesh/surface_areas.h>

#include <algorithm>
#include <map>

namespace retroforge
{
  namespace
  {
    FrictionRamp fading(const double gap)
    {
      FrictionRamp ramp;
      ramp.width = gap;
      return ramp;
    }

    /// A node off the die by a quarter of the gap, because an edge there holds it, touches as the edge does.
    constexpr double steepness = 4.;

    template <typename Number>
    Vector3<Number> middle_of(const NodalVectors<Number> &X, const std::array<NodeIndex, 2> &nodes)
    {
      return 0.5 * (X[nodes[0]] + X[nodes[1]]);
    }

    template <typename Number>
    Vec3 values(const Vector3<Number> &x)
    {
      return Vec3({value_of(x[0]), value_of(x[1]), value_of(x[2])});
    }

    /// What a die is in reach of: nodes, ascending, and edges, their ends not known yet.
    struct Seen
    {
      std::map<NodeIndex, DieFeature> nodes;
      std::vector<TouchingEdge>       edges;
    };

    template <typename Number>
    Seen seen_by(const ContactView<Number> &view, const unsigned int d, const double gap)
    {
      const Die &die          = view.dies[d];
      const Vec3 displacement = values(view.states[d].displacement);
      const auto delta        = [&](const Vec3 &x, const DieFeature &feature) {
        return value_of(die.project(Vector3<Number>(x), view.states[d], feature).delta);
      };
      Seen              seen;
      std::vector<bool> touches(view.mesh.n_nodes(), false); // by itself, as far as can be
      for (NodeIndex k = 0; k < view.mesh.n_nodes(); ++k)
        if (view.topology.is_on_surface(k))
        {
          const Vec3       x       = values(view.X[k]);
          const DieFeature feature = die.closest(x, displacement, gap);
          if (!feature.found())
            continue;
          const double off = delta(x, feature);
          if (off < gap)
            seen.nodes.emplace(k, feature);
          touches[k] = off <= 0.;
        }
      for (std::size_t e = 0; e < view.topology.surface_edges.size() && die.surface(); ++e)
      {
        const auto &nodes = view.topology.surface_edges[e];
        if (touches[nodes[0]] && touches[nodes[1]])
          continue;
        const Vec3       x       = values(middle_of(view.X, nodes));
        const DieFeature feature = die.closest(x, displacement, gap);
        if (!feature.found() || !(delta(x, feature) < gap))
          continue;
        double                    bulge = -delta(x, feature);
        std::array<DieFeature, 2> ends;
        for (unsigned int i = 0; i < 2; ++i)
        {
          const Vec3 end   = values(view.X[nodes[i]]);
          const auto found = seen.nodes.find(nodes[i]);
          ends[i]          = found != seen.nodes.end() ? found->second
                                                       : die.closest(end, displacement, gap + (end - x).norm());
          if (ends[i].found())
            bulge += 0.5 * delta(end, ends[i]);
        }
        if (!ends[0].found() || !ends[1].found() || !(bulge > 0.))
          continue;
        for (unsigned int i = 0; i < 2; ++i)
          seen.nodes.emplace(nodes[i], ends[i]);
        const auto &images = view.topology.edge_images[e];
        seen.edges.push_back({d, feature, nodes, {{invalid_index, invalid_index}}, {{images[0], images[1]}}});
      }
      return seen;
    }

    /// Gaps of what touches [mm].
    template <typename Number>
    struct Gaps
    {
      std::vector<Number> of_nodes, of_middles;

      Gaps(const ContactView<Number> &view, const ThermalSurface<Number> &surface)
      {
        const auto delta = [&](const unsigned int d, const Vector3<Number> &x, const DieFeature &feature) {
          return view.dies[d].project(x, view.states[d], feature).delta;
        };
        for (const auto &at : surface.touching)
          of_nodes.push_back(delta(at.die, view.X[at.node], at.feature));
        for (const auto &edge : surface.edges)
          of_middles.push_back(delta(edge.die, middle_of(view.X, edge.nodes), edge.feature));
      }

      /// Of the die into edge e.
      Number bulge(const TouchingEdge &edge, const unsigned int e) const
      {
        return 0.5 * (of_nodes[edge.ends[0]] + of_nodes[edge.ends[1]]) - of_middles[e];
      }

      /// As far as the ends of edge e count as where its middle is.
      Number part(const TouchingEdge &edge, const unsigned int e, const FrictionRamp &ramp) const
      {
        return 1. - ramp(Number(steepness * bulge(edge, e)), true);
      }
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
  } // namespace

  template <typename Number>
  ThermalSurface<Number>
  thermal_surface(const ContactView<Number> &view, const std::vector<bool> &touch, const double gap)
  {
    AssertDimension(touch.size(), view.dies.size());
    const std::size_t      n = view.mesh.n_nodes();
    ThermalSurface<Number> surface{{}, {}, {}, std::vector<Number>(n, Number(0.))};
    for (unsigned int d = 0; d < view.dies.size(); ++d)
      if (touch[d])
      {
        const Seen                        seen = seen_by(view, d, gap);
        std::map<NodeIndex, unsigned int> entries;
        for (const auto &[k, feature] : seen.nodes)
        {
          entries.emplace(k, surface.touching.size());
          surface.touching.push_back({k, d, feature, Number(0.)});
        }
        for (TouchingEdge edge : seen.edges)
        {
          edge.ends = {{entries.at(edge.nodes[0]), entries.at(edge.nodes[1])}};
          surface.edges.push_back(edge);
        }
      }
    const Gaps<Number> gaps(view, surface);
    const FrictionRamp ramp = fading(gap);
    for (unsigned int i = 0; i < surface.touching.size(); ++i)
      surface.touching[i].weight = ramp(gaps.of_nodes[i], true);
    for_each_factor(surface, [&](const unsigned int e, const unsigned int i) {
      Number &weight = surface.touching[i].weight;
      weight += (1. - weight) * gaps.part(surface.edges[e], e, ramp) * ramp(gaps.of_middles[e], true);
    });
    for_each_face(view.mesh,
                  entries_of(surface, view.dies.size(), n),
                  [&](const BoundaryFace &face, const std::vector<std::array<unsigned int, 3>> &at) {
                    const Number third = triangle_area(face.nodes, view.X) / 3.;
                    Number       free  = third;
                    for (const auto &corners : at)
                    {
                      const Number w = product(surface, corners);
                      surface.faces.push_back({corners, third * w});
                      for (const unsigned int i : corners)
                        surface.touching[i].area += third * w;
                      free *= 1. - w;
                    }
                    for (const NodeIndex k : face.nodes)
                      surface.free[k] += free;
                  });
    return surface;
  }

  template ThermalSurface<double>
  thermal_surface(const ContactView<double> &, const std::vector<bool> &, double);
  template ThermalSurface<Dual> thermal_surface(const ContactView<Dual> &, const std::vector<bool> &, double);

  void reverse_thermal_surface(const ContactView<double>     &view,
                               const ThermalSurface<double>  &surface,
                               const double                   gap,
                               const ThermalSurfaceBar       &bar,
                               NodalVectors<double>          &X_bar,
                               std::vector<DieState<double>> &dies_bar)
  {
    std::vector<double> weight_bar = bar.weight;
    unsigned int        face_index = 0;
    for_each_face(view.mesh,
                  entries_of(surface, view.dies.size(), view.mesh.n_nodes()),
                  [&](const BoundaryFace &face, const std::vector<std::array<unsigned int, 3>> &at) {
                    const double third    = triangle_area(face.nodes, view.X) / 3.;
                    double       area_bar = 0., free_bar = 0., free = 1.;
                    for (const NodeIndex k : face.nodes)
                      free_bar += bar.free[k];
                    for (const auto &corners : at)
                      free *= 1. - product(surface, corners);
                    area_bar += free * free_bar;
                    for (unsigned int j = 0; j < at.size(); ++j)
                    {
                      const double w     = product(surface, at[j]);
                      double       w_bar = third * bar.face_area[face_index++], others = 1.;
                      for (const unsigned int i : at[j])
                        w_bar += third * bar.touching_area[i];
                      area_bar += w_bar / third * w;
                      for (unsigned int l = 0; l < at.size(); ++l)
                        if (l != j)
                          others *= 1. - product(surface, at[l]);
                      w_bar -= third * others * free_bar;
                      for (unsigned int i = 0; i < 3; ++i)
                        weight_bar[at[j][i]] += w_bar * surface.touching[at[j][(i + 1) % 3]].weight *
                                                surface.touching[at[j][(i + 2) % 3]].weight;
                    }
                    reverse_triangle_area(face.nodes, view.X, area_bar / 3., X_bar);
                  });
    const Gaps<double>  gaps(view, surface);
    const FrictionRamp  ramp = fading(gap);
    std::vector<double> at, before, gaps_bar(surface.touching.size(), 0.),
      middles_bar(surface.edges.size(), 0.);
    for (const double gap_there : gaps.of_nodes)
      at.push_back(ramp(gap_there, true));
    std::vector<std::array<unsigned int, 2>> factors;
    for_each_factor(surface, [&](const unsigned int e, const unsigned int i) {
      factors.push_back({{e, i}});
      before.push_back(at[i]);
      at[i] += (1. - at[i]) * gaps.part(surface.edges[e], e, ramp) * ramp(gaps.of_middles[e], true);
    });
    for (std::size_t f = factors.size(); f-- > 0;)
    {
      const auto &[e, i]       = factors[f];
      const TouchingEdge &edge = surface.edges[e];
      const double        part = gaps.part(edge, e, ramp), w = ramp(gaps.of_middles[e], true),
                   missing_bar = (1. - before[f]) * weight_bar[i],
                   bulge_bar =
                     -missing_bar * w * steepness * ramp.derivative(steepness * gaps.bulge(edge, e));
      middles_bar[e] += missing_bar * part * ramp.derivative(gaps.of_middles[e]) - bulge_bar;
      for (const unsigned int end : edge.ends)
        gaps_bar[end] += 0.5 * bulge_bar;
      weight_bar[i] *= 1. - part * w;
    }
    const auto reverse_project =
      [&](const unsigned int d, const Vec3 &x, const DieFeature &feature, const double bar) {
        Vec3              x_bar;
        DieState<double> &die_bar = dies_bar[d];
        view.dies[d].reverse_project(x,
                                     view.states[d].displacement,
                                     feature,
                                     bar,
                                     Vec3(),
                                     x_bar,
                                     die_bar.displacement,
                                     die_bar.vertices.empty() ? nullptr : &die_bar.vertices);
        return x_bar;
      };
    for (unsigned int i = 0; i < surface.touching.size(); ++i)
    {
      const TouchingNode<double> &node      = surface.touching[i];
      const double                delta_bar = gaps_bar[i] + weight_bar[i] * ramp.derivative(gaps.of_nodes[i]);
      if (delta_bar != 0.)
        X_bar[node.node] += reverse_project(node.die, view.X[node.node], node.feature, delta_bar);
    }
    for (unsigned int e = 0; e < surface.edges.size(); ++e)
      if (const TouchingEdge &edge = surface.edges[e]; middles_bar[e] != 0.)
      {
        const Vec3 x_bar =
          reverse_project(edge.die, middle_of(view.X, edge.nodes), edge.feature, middles_bar[e]);
        for (const NodeIndex k : edge.nodes)
          X_bar[k] += 0.5 * x_bar;
      }
  }
} // namespace retroforge
