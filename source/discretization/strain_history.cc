// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/dual.h>
#include <retroforge/discretization/strain_history.h>
#include <retroforge/element/cell_geometry.templates.h>

#include <numeric>

namespace retroforge
{
  template <typename Number>
  std::vector<Number> accumulate_strain(const TetMesh              &mesh,
                                        const Spaces               &spaces,
                                        const NodalVectors<Number> &X,
                                        const Field<Number>        &W,
                                        const Number               &dt,
                                        const std::vector<Number>  &q_n)
  {
    std::vector<CellIndex> all(mesh.n_cells());
    std::iota(all.begin(), all.end(), 0);
    return accumulate_strain(mesh, spaces, X, W, dt, q_n, all);
  }

  template <typename Number>
  std::vector<Number> accumulate_strain(const TetMesh                &mesh,
                                        const Spaces                 &spaces,
                                        const NodalVectors<Number>   &X,
                                        const Field<Number>          &W,
                                        const Number                 &dt,
                                        const std::vector<Number>    &q_n,
                                        const std::vector<CellIndex> &cells)
  {
    std::vector<Number> q = q_n;
    with_pair(spaces, [&](const auto pair) {
      for (const CellIndex c : cells)
        q[c] += dt * cell_strain_rate(geometry_of_cell(mesh, X, c), pair.on_cell(spaces, W, c));
    });
    return q;
  }

  double reverse_accumulate_strain(const TetMesh              &mesh,
                                   const Spaces               &spaces,
                                   const NodalVectors<double> &X,
                                   const Field<double>        &W,
                                   const double                dt,
                                   const std::vector<double>  &q_bar,
                                   Field<double>              &W_bar,
                                   NodalVectors<double>       &X_bar)
  {
    double dt_bar = 0.;
    with_pair(spaces, [&](const auto pair) {
      for (CellIndex c = 0; c < mesh.n_cells(); ++c)
      {
        if (q_bar[c] == 0.)
          continue;
        const auto                                       w          = pair.on_cell(spaces, W, c);
        const auto                                       geometry   = geometry_of_cell(mesh, X, c);
        typename decltype(pair)::template Values<double> w_bar      = {};
        Four<Vec3>                                       cell_X_bar = {};
        dt_bar += q_bar[c] * cell_strain_rate(geometry, w);
        reverse_cell_strain_rate(geometry, w, dt * q_bar[c], w_bar, cell_X_bar);
        pair.add(spaces, w_bar, c, W_bar);
        for (unsigned int a = 0; a < 4; ++a)
          X_bar[mesh.cells[c][a]] += cell_X_bar[a];
      }
    });
    return dt_bar;
  }

#define RETROFORGE_INSTANTIATE(Number)                                         \
  template std::vector<Number> accumulate_strain(const TetMesh &,              \
                                                 const Spaces &,               \
                                                 const NodalVectors<Number> &, \
                                                 const Field<Number> &,        \
                                                 const Number &,               \
                                                 const std::vector<Number> &); \
  template std::vector<Number> accumulate_strain(const TetMesh &,              \
                                                 const Spaces &,               \
                                                 const NodalVectors<Number> &, \
                                                 const Field<Number> &,        \
                                                 const Number &,               \
                                                 const std::vector<Number> &,  \
                                                 const std::vector<CellIndex> &);
  RETROFORGE_INSTANTIATE(double)
  RETROFORGE_INSTANTIATE(Dual)
#undef RETROFORGE_INSTANTIATE
} // namespace retroforge
