// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/heat/node_skins.h>
#include <retroforge/heat/surface_temperature.h>

namespace retroforge
{
  namespace
  {
    /// For each entry the mean of its faces, by what of them touches, of the means of their corners.
    template <typename Number>
    std::vector<Number> mean_over_faces(const ThermalSurface<Number> &surface, const std::vector<Number> &x)
    {
      std::vector<Number> mean(x.size(), Number(0.));
      for (const auto &face : surface.faces)
      {
        Number of_face(0.);
        for (const unsigned int i : face.corners)
          of_face += x[i] / 3.;
        for (const unsigned int i : face.corners)
          mean[i] += face.area * of_face;
      }
      for (unsigned int i = 0; i < x.size(); ++i)
        if (const Number &area = surface.touching[i].area; value_of(area) > 0.)
          mean[i] /= area;
      return mean;
    }

    /// Reverse of mean_over_faces(): returns the derivatives in x.
    std::vector<double> reverse_mean_over_faces(const ThermalSurface<double> &surface,
                                                const std::vector<double>    &x,
                                                std::vector<double>           mean_bar,
                                                ThermalSurfaceBar            &surface_bar)
    {
      const std::vector<double> mean = mean_over_faces(surface, x);
      std::vector<double>       x_bar(x.size(), 0.);
      for (unsigned int i = 0; i < x.size(); ++i)
        if (const double area = surface.touching[i].area; area > 0.)
        {
          mean_bar[i] /= area;
          surface_bar.touching_area[i] -= mean_bar[i] * mean[i];
        }
      for (std::size_t f = 0; f < surface.faces.size(); ++f)
      {
        const auto &face = surface.faces[f];
        double      sums = 0., of_face = 0.;
        for (const unsigned int i : face.corners)
        {
          sums += mean_bar[i];
          of_face += x[i] / 3.;
        }
        surface_bar.face_area[f] += sums * of_face;
        for (const unsigned int i : face.corners)
          x_bar[i] += sums * face.area / 3.;
      }
      return x_bar;
    }

    /// At the nodes themselves.
    template <typename Number>
    std::vector<Number> nodal_dies_surfaces(const ThermalSurface<Number>        &surface,
                                            const std::vector<DieState<Number>> &dies,
                                            const NodeSkins<Number>             &skin)
    {
      std::vector<Number> t;
      for (const auto &at : surface.touching)
        t.push_back(dies[at.die].temperature + drop_of(skin.dies[at.die][at.node]));
      return t;
    }
  } // namespace

  template <typename Number>
  std::vector<Number> dies_surfaces(const ThermalSurface<Number>        &surface,
                                    const std::vector<DieState<Number>> &dies,
                                    const NodeSkins<Number>             &skin)
  {
    AssertDimension(skin.dies.size(), dies.size());
    return mean_over_faces(surface, nodal_dies_surfaces(surface, dies, skin));
  }

  template std::vector<double> dies_surfaces(const ThermalSurface<double> &,
                                             const std::vector<DieState<double>> &,
                                             const NodeSkins<double> &);
  template std::vector<Dual>
  dies_surfaces(const ThermalSurface<Dual> &, const std::vector<DieState<Dual>> &, const NodeSkins<Dual> &);

  void reverse_dies_surfaces(const ThermalSurface<double>        &surface,
                             const std::vector<DieState<double>> &dies,
                             const NodeSkins<double>             &skin,
                             const std::vector<double>           &temperatures_bar,
                             ThermalSurfaceBar                   &surface_bar,
                             std::vector<DieState<double>>       &dies_bar,
                             NodeSkins<double>                   &skin_bar)
  {
    const auto t_bar = reverse_mean_over_faces(
      surface, nodal_dies_surfaces(surface, dies, skin), temperatures_bar, surface_bar);
    for (unsigned int i = 0; i < t_bar.size(); ++i)
    {
      const auto &at = surface.touching[i];
      dies_bar[at.die].temperature += t_bar[i];
      add_to_modes(t_bar[i], skin_bar.dies[at.die][at.node]);
    }
  }

  std::vector<double> means_at_nodes(const ThermalSurface<double> &surface,
                                     const std::vector<double>    &of_entries,
                                     std::vector<double>           elsewhere)
  {
    std::vector<double> sum(elsewhere.size(), 0.), area(sum);
    for (unsigned int i = 0; i < of_entries.size(); ++i)
    {
      const auto &at = surface.touching[i];
      sum[at.node] += at.area * of_entries[i];
      area[at.node] += at.area;
    }
    for (NodeIndex k = 0; k < area.size(); ++k)
      if (area[k] > 0.)
        elsewhere[k] = sum[k] / area[k];
    return elsewhere;
  }

  std::vector<double>
  metals_surface(const HeatFlow<double> &flow, const std::vector<double> &T, const NodeSkins<double> &skin)
  {
    AssertDimension(T.size(), flow.network.volumes.size());
    AssertDimension(skin.metal.size(), T.size());
    const auto         &surface = flow.surface;
    std::vector<double> t = T, area = surface.free;
    // A node's part that touches; as contact fades, all of its surface.
    for (const auto &contact : node_contacts(flow))
      if (contact.has_film)
        area[contact.node] = contact.area + (1. - contact.weight) * surface.free[contact.node];
    for (NodeIndex k = 0; k < t.size(); ++k)
      if (area[k] > 0.)
      {
        const Skin<double> shown = parts_shown(flow.law, flow.network.volumes[k] / area[k]);
        t[k] += shown * skin.metal[k] - drop_of(skin.metal[k]);
      }
    std::vector<double> at_entries;
    for (const auto &at : surface.touching)
      at_entries.push_back(t[at.node]);
    return means_at_nodes(surface, mean_over_faces(surface, at_entries), std::move(t));
  }
} // namespace retroforge
