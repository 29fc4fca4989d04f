// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/element/cell_stress.h>
#include <retroforge/output/cell_fields.h>

namespace retroforge
{
  template <int dim>
  CellFields cell_fields(const Discretization<dim>                             &discretization,
                         const CellVectors<dim, double>                        &X,
                         const FlowField<dim, double>                          &W,
                         const std::function<MaterialLaw<double>(CellIndex c)> &law)
  {
    Assert(W.belongs_to(discretization), dealii::ExcMessage("the flow is of another discretisation"));
    const ReplicatedEntries &cells = discretization.cells();
    const unsigned int       n     = cells.range().n;
    CellFields fields{std::vector<double>(n), std::vector<double>(n), {}, std::vector<double>(n)};
    fields.stress.resize(n);
    dispatch_element(discretization, [&](const auto pair) {
      for (const CellIndex c : cells.owned())
      {
        const auto geometry   = cell_geometry(pair.positions(discretization, X, c));
        const auto w          = pair.on_cell(discretization, W, c);
        fields.strain_rate[c] = cell_strain_rate(geometry, w);
        fields.stress[c]      = cell_deviatoric_stress(geometry, w, law(c));
        fields.flow_stress[c] =
          std::sqrt(3.) * law(c).shear_stress(fields.strain_rate[c] * fields.strain_rate[c]);
      }
    });
    cells.complete(fields.strain_rate.data(), 1);
    cells.complete(fields.stress.data()->data(), 6);
    cells.complete(fields.flow_stress.data(), 1);
    for (CellIndex c = 0; c < n; ++c)
      fields.von_mises[c] = von_mises(fields.stress[c]);
    return fields;
  }

#define RETROFORGE_INSTANTIATE(dim)                                 \
  template CellFields cell_fields(const Discretization<dim> &,      \
                                  const CellVectors<dim, double> &, \
                                  const FlowField<dim, double> &,   \
                                  const std::function<MaterialLaw<double>(CellIndex)> &);
  RETROFORGE_INSTANTIATE(2)
  RETROFORGE_INSTANTIATE(3)
#undef RETROFORGE_INSTANTIATE
} // namespace retroforge
