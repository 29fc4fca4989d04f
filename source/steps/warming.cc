// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/discretization/element_pairs.h>
#include <retroforge/element/cell_geometry.templates.h>
#include <retroforge/steps/warming.h>

namespace retroforge
{
  namespace
  {
    template <typename Number>
    CellGeometry<Number> geometry_of(const TetMesh &mesh, const NodalVectors<Number> &X, const CellIndex c)
    {
      Four<Vector3<Number>> x;
      for (unsigned int a = 0; a < 4; ++a)
        x[a] = X[mesh.cells[c][a]];
      return cell_geometry(x);
    }
  } // namespace

  template <typename Number>
  NodeVolumes<Number>::NodeVolumes(const TetMesh &mesh, const NodalVectors<Number> &X)
      : of_cell(mesh.n_cells()), of_node(mesh.n_nodes(), Number(0.))
  {
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    {
      of_cell[c] = geometry_of(mesh, X, c).volume;
      for (const NodeIndex k : mesh.cells[c])
        of_node[k] += of_cell[c];
    }
  }

  template struct NodeVolumes<double>;
  template struct NodeVolumes<Dual>;

  void reverse_cell_volume(const TetMesh              &mesh,
                           const NodalVectors<double> &X,
                           const CellIndex             c,
                           const double                volume_bar,
                           NodalVectors<double>       &X_bar)
  {
    Four<Vec3> x_bar = {};
    reverse_cell_geometry(geometry_of(mesh, X, c), volume_bar, Four<Vec3>(), x_bar);
    for (unsigned int a = 0; a < 4; ++a)
      X_bar[mesh.cells[c][a]] += x_bar[a];
  }

  namespace
  {
    /// D_c of all cells [mJ/s]. Collective.
    template <typename Number>
    std::vector<Number> dissipation(const EquilibriumView<Number> &view)
    {
      const Equilibrium<Number> &stage          = view.stage;
      const Discretization<3>   &discretization = stage.scene.discretization;
      std::vector<Number>        D(stage.scene.mesh.n_cells(), Number(0.));
      dispatch_element(discretization, [&](const auto pair) {
        for (const CellIndex c : discretization.cells().owned())
          D[c] = cell_dissipation(cell_geometry(pair.positions(discretization, stage.X, c)),
                                  pair.on_cell(discretization, view.W, c),
                                  stage.law(c));
      });
      complete_entries(discretization.cells(), D.data(), 1);
      return D;
    }

    /// chi/(rho c), the warming per work and volume [K/MPa].
    template <typename Number>
    Number warming_per_work(const HeatLaw<Number> &heat)
    {
      return heat.fraction / heat.capacity;
    }
  } // namespace

  template <typename Number>
  void add_warming(const EquilibriumView<Number> &view, const Number &dt, std::vector<Number> &T)
  {
    const TetMesh &mesh = view.stage.scene.mesh;
    AssertDimension(T.size(), mesh.n_nodes());
    const NodeVolumes<Number> volumes(mesh, view.stage.X);
    const std::vector<Number> D = dissipation(view);
    std::vector<Number>       at_node(mesh.n_nodes(), Number(0.));
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
      for (const NodeIndex k : mesh.cells[c])
        at_node[k] += D[c];
    const Number factor = view.weight * dt * warming_per_work(view.stage.physics.heat);
    for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
      T[k] += factor * at_node[k] / volumes.of_node[k];
  }

  template void add_warming(const EquilibriumView<double> &, const double &, std::vector<double> &);
  template void add_warming(const EquilibriumView<Dual> &, const Dual &, std::vector<Dual> &);

  void reverse_add_warming(const EquilibriumView<double> &view,
                           const double                   dt,
                           const std::vector<double>     &T_bar,
                           EquilibriumBar                &bar)
  {
    const Equilibrium<double> &stage          = view.stage;
    const Discretization<3>   &discretization = stage.scene.discretization;
    const TetMesh             &mesh           = stage.scene.mesh;
    AssertDimension(T_bar.size(), mesh.n_nodes());
    const HeatLaw<double>    &heat = stage.physics.heat;
    const NodeVolumes<double> volumes(mesh, stage.X);
    const std::vector<double> D = dissipation(view);
    std::vector<double>       at_node(mesh.n_nodes(), 0.);
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
      for (const NodeIndex k : mesh.cells[c])
        at_node[k] += D[c];
    const double per_work = view.weight * warming_per_work(heat), factor = dt * per_work;
    double       work_bar = 0.; // of what the warming is proportional to
    dispatch_element(discretization, [&](const auto pair) {
      for (const CellIndex c : discretization.cells().owned())
      {
        double D_bar = 0., volume_bar = 0.;
        for (const NodeIndex k : mesh.cells[c])
        {
          const double share = T_bar[k] / volumes.of_node[k];
          D_bar += share;
          volume_bar -= share * at_node[k] / volumes.of_node[k];
        }
        work_bar += D_bar * D[c];
        const auto X     = pair.positions(discretization, stage.X, c);
        auto       w_bar = pair.no_values();
        auto       s     = reverse_cell_dissipation(
          cell_geometry(X), pair.on_cell(discretization, view.W, c), stage.law(c), factor * D_bar, w_bar);
        if (bar.shape.method != ShapeDerivatives::Method::exact)
          s.X = difference_cell_dissipation(
            X, pair.on_cell(discretization, view.W, c), stage.law(c), factor * D_bar, bar.shape);
        add_to_positions(discretization, s.X, c, bar.X);
        pair.add(discretization, w_bar, c, bar.W);
        reverse_law(stage, c, s.law, bar.physics);
        reverse_cell_volume(mesh, stage.X, c, factor * volume_bar, bar.X);
      }
    });
    bar.physics.dt += per_work * work_bar;
    bar.physics.heat.fraction += view.weight * dt * work_bar / heat.capacity;
    bar.physics.heat.capacity -= factor * work_bar / heat.capacity;
  }
} // namespace retroforge
