// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/discretization/element_pairs.h>
#include <retroforge/objective/volume.h>

namespace retroforge
{
  template <typename Number>
  Number cell_volume(const FinalView<Number> &view, const CellIndex c)
  {
    return cell_geometry(positions_of_cell(view.scene.discretization, view.X, c)).volume;
  }

  void reverse_cell_volume(const FinalView<double> &view,
                           const CellIndex          c,
                           const double             volume_bar,
                           NodalVectors<double>    &X_bar)
  {
    const auto          &discretization = view.scene.discretization;
    CellGeometry<double> geometry       = geometry_of_cell(discretization, view.X, c);
    for (Vec3 &g : geometry.g)
      g *= volume_bar * geometry.volume;
    add_to_positions(discretization, geometry.g, c, X_bar);
  }

  template <typename Number>
  std::vector<Number> VolumeObjective::compute_integrals(const FinalView<Number> &view) const
  {
    const Discretization<3> &discretization = view.scene.discretization;
    Number                   volume(0.);
    for (const CellIndex c : discretization.cells().owned())
      volume += cell_volume(view, c);
    return {volume};
  }

  void VolumeObjective::reverse_integrals(const FinalView<double>   &view,
                                          const std::vector<double> &weights,
                                          FinalBar                  &bar) const
  {
    const Discretization<3> &discretization = view.scene.discretization;
    for (const CellIndex c : discretization.cells().owned())
      reverse_cell_volume(view, c, weights[0], bar.X);
  }

#define RETROFORGE_INSTANTIATE(Number)                                            \
  template Number              cell_volume(const FinalView<Number> &, CellIndex); \
  template std::vector<Number> VolumeObjective::compute_integrals(const FinalView<Number> &) const;
  RETROFORGE_INSTANTIATE(double)
  RETROFORGE_INSTANTIATE(Dual)
#undef RETROFORGE_INSTANTIATE

  namespace
  {
    struct VolumeType : ObjectiveType
    {
      void make(const std::string &, const ObjectiveContext &, NamedObjective &objective) const override
      {
        objective.scaling = SymmetryScaling::part;
        objective.at_end  = std::make_unique<VolumeObjective>();
      }
    };
  } // namespace

  Choice<ObjectiveType>::Maker volume_type()
  {
    return {"volume", Choice<ObjectiveType>::make<VolumeType>};
  }
} // namespace retroforge
