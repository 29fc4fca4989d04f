// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/heat/thermal_surface.h>
#include <retroforge/mesh/surface_areas.h>

#include <algorithm>

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
    const std::size_t      n    = view.mesh.n_nodes();
    const FrictionRamp     ramp = fading(gap);
    ThermalSurface<Number> surface{{}, {}, std::vector<Number>(n, Number(0.))};
    for (unsigned int d = 0; d < view.dies.size(); ++d)
      for (NodeIndex k = 0; k < n && touch[d]; ++k)
      {
        if (!view.topology.is_on_surface(k))
          continue;
        Vec3 x, displacement;
        for (unsigned int i = 0; i < 3; ++i)
        {
          x[i]            = value_of(view.X[k][i]);
          displacement[i] = value_of(view.states[d].displacement[i]);
        }
        const DieFeature feature = view.dies[d].closest(x, displacement, gap);
        if (!feature.found())
          continue;
        const Number delta = view.dies[d].project(view.X[k], view.states[d], feature).delta;
        if (value_of(delta) < gap)
          surface.touching.push_back({k, d, feature, ramp(delta, true)});
      }
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
    const FrictionRamp ramp = fading(gap);
    for (unsigned int i = 0; i < surface.touching.size(); ++i)
    {
      const TouchingNode<double> &at = surface.touching[i];
      if (weight_bar[i] == 0.)
        continue;
      const DieState<double> &die = view.states[at.die];
      const double            delta_bar =
        weight_bar[i] * ramp.derivative(view.dies[at.die].project(view.X[at.node], die, at.feature).delta);
      if (delta_bar == 0.)
        continue;
      DieState<double> &die_bar = dies_bar[at.die];
      view.dies[at.die].reverse_project(view.X[at.node],
                                        die.displacement,
                                        at.feature,
                                        delta_bar,
                                        Vec3(),
                                        X_bar[at.node],
                                        die_bar.displacement,
                                        die_bar.vertices.empty() ? nullptr : &die_bar.vertices);
    }
  }
} // namespace retroforge
