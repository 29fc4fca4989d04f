// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/discretization/element_pairs.h>
#include <retroforge/objective/volume.h>

namespace retroforge
{
  template <typename Number>
  Number cell_volume(const FinalView<Number> &view, const CellIndex c)
  {
    return cell_geometry(positions_of_cell(view.scene.mesh, view.X, c)).volume;
  }

  void reverse_cell_volume(const FinalView<double> &view,
                           const CellIndex          c,
                           const double             volume_bar,
                           NodalVectors<double>    &X_bar)
  {
    const TetMesh             &mesh     = view.scene.mesh;
    const CellGeometry<double> geometry = cell_geometry(positions_of_cell(mesh, view.X, c));
    for (unsigned int a = 0; a < 4; ++a)
      X_bar[mesh.cells[c][a]] += volume_bar * geometry.volume * geometry.g[a];
  }

  template <typename Number>
  std::vector<Number> VolumeObjective::compute_integrals(const FinalView<Number> &view) const
  {
    const Partition &partition = view.scene.partition;
    Number           volume(0.);
    for (const CellIndex c : partition.cells().owned())
      volume += cell_volume(view, c);
    return {volume};
  }

  void VolumeObjective::reverse_integrals(const FinalView<double>   &view,
                                          const std::vector<double> &weights,
                                          FinalBar                  &bar) const
  {
    const Partition &partition = view.scene.partition;
    for (const CellIndex c : partition.cells().owned())
      reverse_cell_volume(view, c, weights[0], bar.X);
  }

#define RETROFORGE_INSTANTIATE(Number)                                            \
  template Number              cell_volume(const FinalView<Number> &, CellIndex); \
  template std::vector<Number> VolumeObjective::compute_integrals(const FinalView<Number> &) const;
  RETROFORGE_INSTANTIATE(double)
  RETROFORGE_INSTANTIATE(Dual)
#undef RETROFORGE_INSTANTIATE
} // namespace retroforge
