// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// What a new objective needs, from nothing to its test: copy this file. The objective is the height of the
// workpiece's centre of mass, whose value on a block is known by hand and whose reverse is compared with dual
// numbers and with the Taylor expansion. To put it into parameter files, give it a type in objective_type.cc.

#include <deal.II/base/mpi.h>

#include <retroforge/billet/billet.h>
#include <retroforge/objective/volume.h>

#include "objective_test_tools.h"

using namespace retroforge;

/// Height of the centre of mass [mm],  int z dV / V.
class CentreHeight : public FinalObjectiveOf<CentreHeight>
{
public:
  std::string name() const override { return "centre height"; }
  std::string unit() const override { return "mm"; }

  /// What must be summed over the workpiece: V and int z dV, of the cells this rank owns.
  template <typename Number>
  std::vector<Number> compute_integrals(const FinalView<Number> &view) const
  {
    std::vector<Number> sums(2, Number(0.));
    for (const CellIndex c : view.scene.discretization.cells().owned())
    {
      const Number volume = cell_volume(view, c);
      sums[0] += volume;
      sums[1] += volume * height(view, c);
    }
    return sums;
  }

  /// The value from the completed sums; its derivatives come from dual numbers.
  template <typename Number>
  Number combine(const std::vector<Number> &sums) const
  {
    return sums[1] / sums[0];
  }

  /// The same loop in reverse: what of weights·sums depends on the positions.
  void
  reverse_integrals(const FinalView<double> &view, const std::vector<double> &weights, FinalBar &bar) const
  {
    for (const CellIndex c : view.scene.discretization.cells().owned())
    {
      reverse_cell_volume(view, c, weights[0] + weights[1] * height(view, c), bar.X);
      for (const NodeIndex k : view.scene.mesh.cells[c])
        bar.X[k][2] += 0.25 * weights[1] * cell_volume(view, c);
    }
  }

private:
  template <typename Number>
  static Number height(const FinalView<Number> &view, const CellIndex c)
  {
    Number sum(0.);
    for (const NodeIndex k : view.scene.mesh.cells[c])
      sum += 0.25 * view.X[k][2];
    return sum;
  }
};

/// The objective at positions X of a scene.
template <typename Number>
Number value(const Scene &scene, const CentreHeight &objective, const NodalVectors<Number> &X)
{
  const std::vector<Number>           strain(scene.mesh.n_cells(), Number(0.));
  const std::vector<DieState<Number>> dies;
  const FinalDecisions                none = NoDecisions();
  return objective.value(objective.integrals(FinalView<Number>{scene, X, strain, dies}, none).complete(),
                         none);
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  BilletParameters                         block;
  block.size         = Vec3({2., 3., 4.});
  block.element_size = 1.;
  const Scene        scene(make_billet(block, MPI_COMM_SELF), {}, {}, MPI_COMM_SELF);
  const CentreHeight objective;
  const double       start = value(scene, objective, scene.mesh.X);
  std::cout << "value on a block of height 4: " << (std::abs(start - 2.) < 1e-14 ? "2" : "wrong")
            << std::endl;

  const std::vector<double>           strain(scene.mesh.n_cells(), 0.);
  const std::vector<DieState<double>> dies;
  const FinalView<double>             view{scene, scene.mesh.X, strain, dies};
  const FinalDecisions                decisions = objective.decide(view); // none, here
  const auto                          sums      = objective.integrals(view, decisions).complete();
  const FinalBar                      bar =
    objective.derivatives(view, decisions, objective.reverse_value(sums, decisions)).complete();

  Random               random;
  NodalVectors<double> direction(scene.mesh.n_nodes());
  NodalVectors<Dual>   X(scene.mesh.n_nodes());
  double               slope = 0.;
  for (NodeIndex k = 0; k < X.size(); ++k)
  {
    direction[k] = random.vector();
    slope += direction[k] * bar.X[k];
    for (unsigned int i = 0; i < 3; ++i)
    {
      X[k][i]                 = Dual(scene.mesh.X[k][i]);
      X[k][i].fastAccessDx(0) = direction[k][i];
    }
  }
  const double dual = value(scene, objective, X).dx(0);
  std::cout << "reverse against dual numbers: "
            << (std::abs(slope / dual - 1.) < 1e-12 ? "below 1e-12" : "wrong") << std::endl;

  double last = 0.;
  for (const double step : {2e-3, 1e-3})
  {
    NodalVectors<double> moved = scene.mesh.X;
    for (NodeIndex k = 0; k < moved.size(); ++k)
      moved[k] += step * direction[k];
    const double remainder = std::abs(value(scene, objective, moved) - start - step * slope);
    if (last > 0.)
      std::cout << "Taylor order: " << std::round(10. * std::log2(last / remainder)) / 10. << std::endl;
    last = remainder;
  }
}
