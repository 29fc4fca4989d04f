// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/dual.h>
#include <retroforge/discretization/strain_history.h>
#include <retroforge/element/cell_geometry.templates.h>

namespace retroforge
{
  template <typename Number>
  std::vector<Number> accumulate_strain(const Discretization<3>    &discretization,
                                        const NodalVectors<Number> &X,
                                        const Field<Number>        &W,
                                        const Number               &dt,
                                        const std::vector<Number>  &q_n)
  {
    Assert(X.size() == discretization.n_vertices(),
           dealii::ExcDimensionMismatch(X.size(), discretization.n_vertices()));
    Assert(q_n.size() == discretization.cells().range().n,
           dealii::ExcDimensionMismatch(q_n.size(), discretization.cells().range().n));
    Assert(W.belongs_to(discretization), dealii::ExcMessage("the velocities are of another discretisation"));
    std::vector<Number> q = q_n;
    dispatch_element(discretization, [&](const auto pair) {
      for (const CellIndex c : discretization.cells().owned())
        q[c] += dt * cell_strain_rate(cell_geometry(pair.positions(discretization, X, c)),
                                      pair.on_cell(discretization, W, c));
    });
    return q;
  }

  double reverse_accumulate_strain(const Discretization<3>    &discretization,
                                   const NodalVectors<double> &X,
                                   const Field<double>        &W,
                                   const double                dt,
                                   const std::vector<double>  &q_bar,
                                   Field<double>              &W_bar,
                                   NodalVectors<double>       &X_bar)
  {
    Assert(X.size() == discretization.n_vertices(),
           dealii::ExcDimensionMismatch(X.size(), discretization.n_vertices()));
    Assert(X_bar.size() == X.size(), dealii::ExcDimensionMismatch(X_bar.size(), X.size()));
    Assert(q_bar.size() == discretization.cells().range().n,
           dealii::ExcDimensionMismatch(q_bar.size(), discretization.cells().range().n));
    Assert(W.belongs_to(discretization) && W_bar.belongs_to(discretization),
           dealii::ExcMessage("the velocities are of another discretisation"));
    double dt_bar = 0.;
    dispatch_element(discretization, [&](const auto pair) {
      for (const CellIndex c : discretization.cells().owned())
      {
        if (q_bar[c] == 0.)
          continue;
        const auto w          = pair.on_cell(discretization, W, c);
        const auto geometry   = cell_geometry(pair.positions(discretization, X, c));
        auto       w_bar      = pair.no_values();
        auto       cell_X_bar = pair.no_positions();
        dt_bar += q_bar[c] * cell_strain_rate(geometry, w);
        reverse_cell_strain_rate(geometry, w, dt * q_bar[c], w_bar, cell_X_bar);
        pair.add(discretization, w_bar, c, W_bar);
        add_to_positions(discretization, cell_X_bar, c, X_bar);
      }
    });
    return dt_bar;
  }

#define RETROFORGE_INSTANTIATE(Number)                                         \
  template std::vector<Number> accumulate_strain(const Discretization<3> &,    \
                                                 const NodalVectors<Number> &, \
                                                 const Field<Number> &,        \
                                                 const Number &,               \
                                                 const std::vector<Number> &);
  RETROFORGE_INSTANTIATE(double)
  RETROFORGE_INSTANTIATE(Dual)
#undef RETROFORGE_INSTANTIATE
} // namespace retroforge
