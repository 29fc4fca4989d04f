// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/dual.h>
#include <retroforge/element/mini_element.templates.h>
#include <retroforge/element/strain_history.h>

namespace retroforge
{
  template <typename Number>
  Number cell_strain_rate(const CellGeometry<Number>  &geometry,
                          const Four<Vector3<Number>> &V,
                          const Vector3<Number>       &beta)
  {
    return mean_equivalent_rate(SubStrainRates<Number>(geometry, V, beta).eps);
  }

  void reverse_cell_strain_rate(const CellGeometry<double> &geometry,
                                const Four<Vec3>           &V,
                                const Vec3                 &beta,
                                const double                weight,
                                Four<Vec3>                 &V_bar,
                                Vec3                       &beta_bar,
                                Four<Vec3>                 &X_bar)
  {
    const PointRates<double> E =
      reverse_mean_equivalent_rate(SubStrainRates<double>(geometry, V, beta).eps, weight);
    const Symmetric<double> E_sum = sum(E);
    Four<Vec3>              g_bar;
    for (unsigned int c = 0; c < 4; ++c)
    {
      V_bar[c] += times(E_sum, geometry.g[c]);
      beta_bar += 4. * times(E[c], geometry.g[c]);
      g_bar[c] = times(E_sum, V[c]) + 4. * times(E[c], beta);
    }
    reverse_cell_geometry(geometry, 0., g_bar, X_bar);
  }

  template <typename Number>
  std::vector<Number> accumulate_strain(const TetMesh              &mesh,
                                        const NodalVectors<Number> &X,
                                        const Field<Number>        &W,
                                        const Number               &dt,
                                        const std::vector<Number>  &q_n)
  {
    std::vector<Number> q = q_n;
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    {
      const CellValues<Number> w = W.on_cell(mesh, c);
      q[c] += dt * cell_strain_rate(cell_geometry(positions_of_cell(mesh, X, c)), w.V, w.beta);
    }
    return q;
  }

  double reverse_accumulate_strain(const TetMesh              &mesh,
                                   const NodalVectors<double> &X,
                                   const Field<double>        &W,
                                   const double                dt,
                                   const std::vector<double>  &q_bar,
                                   Field<double>              &W_bar,
                                   NodalVectors<double>       &X_bar)
  {
    double dt_bar = 0.;
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    {
      if (q_bar[c] == 0.)
        continue;
      const CellValues<double>   w          = W.on_cell(mesh, c);
      const CellGeometry<double> geometry   = cell_geometry(positions_of_cell(mesh, X, c));
      Four<Vec3>                 cell_V_bar = {}, cell_X_bar = {};
      dt_bar += q_bar[c] * cell_strain_rate(geometry, w.V, w.beta);
      reverse_cell_strain_rate(geometry, w.V, w.beta, dt * q_bar[c], cell_V_bar, W_bar.beta[c], cell_X_bar);
      for (unsigned int a = 0; a < 4; ++a)
      {
        W_bar.V[mesh.cells[c][a]] += cell_V_bar[a];
        X_bar[mesh.cells[c][a]] += cell_X_bar[a];
      }
    }
    return dt_bar;
  }

#define RETROFORGE_INSTANTIATE(Number)                                                     \
  template Number cell_strain_rate(                                                        \
    const CellGeometry<Number> &, const Four<Vector3<Number>> &, const Vector3<Number> &); \
  template std::vector<Number> accumulate_strain(const TetMesh &,                          \
                                                 const NodalVectors<Number> &,             \
                                                 const Field<Number> &,                    \
                                                 const Number &,                           \
                                                 const std::vector<Number> &);
  RETROFORGE_INSTANTIATE(double)
  RETROFORGE_INSTANTIATE(Dual)
#undef RETROFORGE_INSTANTIATE
} // namespace retroforge
