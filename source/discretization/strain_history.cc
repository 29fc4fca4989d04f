// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/dual.h>
#include <retroforge/discretization/strain_history.h>
#include <retroforge/element/cell_geometry.templates.h>

namespace retroforge
{
  template <typename Number, int dim>
  std::vector<Number> accumulate_strain(const Discretization<dim>      &discretization,
                                        const CellVectors<dim, Number> &X,
                                        const FlowField<dim, Number>   &W,
                                        const Number                   &dt,
                                        const std::vector<Number>      &q_n)
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

  template <int dim>
  double reverse_accumulate_strain(const Discretization<dim>      &discretization,
                                   const CellVectors<dim, double> &X,
                                   const FlowField<dim, double>   &W,
                                   const double                    dt,
                                   const std::vector<double>      &q_bar,
                                   FlowField<dim, double>         &W_bar,
                                   CellVectors<dim, double>       &X_bar)
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

#define RETROFORGE_INSTANTIATE_VALUES(dim, Number)                                 \
  template std::vector<Number> accumulate_strain(const Discretization<dim> &,      \
                                                 const CellVectors<dim, Number> &, \
                                                 const FlowField<dim, Number> &,   \
                                                 const Number &,                   \
                                                 const std::vector<Number> &);
#define RETROFORGE_INSTANTIATE(dim)                                           \
  RETROFORGE_INSTANTIATE_VALUES(dim, double)                                  \
  RETROFORGE_INSTANTIATE_VALUES(dim, Dual)                                    \
  template double reverse_accumulate_strain(const Discretization<dim> &,      \
                                            const CellVectors<dim, double> &, \
                                            const FlowField<dim, double> &,   \
                                            double,                           \
                                            const std::vector<double> &,      \
                                            FlowField<dim, double> &,         \
                                            CellVectors<dim, double> &);
  RETROFORGE_INSTANTIATE(2)
  RETROFORGE_INSTANTIATE(3)
#undef RETROFORGE_INSTANTIATE
#undef RETROFORGE_INSTANTIATE_VALUES
} // namespace retroforge
