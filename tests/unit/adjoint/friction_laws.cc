// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Forgings with friction after Tresca, which follows the strain rate of the metal in the increment before, and after
// Coulomb, which follows the pressure, too, so that the tangent is not symmetric and the adjoint is that of the transposed
// system. Under a tilted die, with linear and with quadratic velocities, and under tripods, by node positions, the speed and
// the offset of the upper die, the coefficient of friction and its limit, and under the tilted die K, m and e0 of the metal. Proved:
// - the backward sweep agrees with the direct method to 1e-10, solved directly and by Krylov's method;
// - and with replayed central differences to 1e-6;
// - along each the remainder of Taylor's expansion falls with the square of the step;
// - by the coefficient also with a difference of whole runs that decide anew.

#include <deal.II/base/mpi.h>

#include "ways.h"

using namespace retroforge;

namespace
{
  /// The limit is near what Coulomb's friction comes to.
  Parameters with_friction(Parameters p, const std::string &law)
  {
    for (DieParameters &die : p.dies)
    {
      die.friction_law = law;
      die.friction     = 0.25;
      die.shear_limit  = 0.5;
    }
    return p;
  }

  Parameters tripod_scene()
  {
    Parameters p             = tilted_block();
    p.billet.shape           = BilletParameters::Shape::cylinder;
    p.billet.radius          = 20.;
    p.billet.height          = 24.;
    p.billet.symmetry_planes = {Vec3({0., -1., 0.}), Vec3({-std::sqrt(0.75), 0.5, 0.})};
    p.billet.element_size    = 6.;
    p.dies[1].point          = Vec3({0., 0., 24.});
    p.dies[1].facing         = Vec3({0., 0., -1.});
    for (DieParameters &die : p.dies)
    {
      auto &tripod           = die.shape.choose<TripodDie>();
      tripod.chord_error     = 0.3;
      tripod.feature_angle   = 40.; // for facets as coarse as these
      tripod.largest_sagitta = 1.;
      tripod.shape           = {{}, 10., 10., 46., 4., 60., {5., 20., 2., 2.}};
    }
    return p;
  }

  /// @param with_metal  whether by the metal's numbers, too
  double check(const std::string &name, const Parameters &parameters, const bool with_metal)
  {
    RecordedRun                run(parameters);
    const AdjointResult        bar = run.adjoint();
    const NodalVectors<double> still(run.state().workpiece.X.size());
    std::cout << name << "\n  friction works: "
              << yes(run.state().energy.friction > 1e-3 * run.state().energy.total()) << "\n";
    double     largest = 0.;
    const auto of_dies = [](double DieState<double>::*number) {
      return [number](Process<double> &dot) {
        for (auto &die : dot.dies)
          die.*number = 1.;
      };
    };
    std::vector<Way> ways{{{"random X_0", random_vectors(still.size()), 0., 0., {}}},
                          {{"speed", still, 1., 0., {}}},
                          {{"offset", still, 0., 1., {}}},
                          {{"friction", still, 0., 0., {}}, of_dies(&DieState<double>::friction)}};
    if (with_metal)
      for (unsigned int i = 0; i < 3; ++i)
        ways.push_back({{MaterialLaw<double>::info()[i].name, still, 0., 0., {}},
                        [i](Process<double> &dot) { number_of(dot.material.law, i) = 1.; }});
    if (parameters.dies[0].friction_law == "Coulomb")
      ways.push_back({{"limit", still, 0., 0., {}}, of_dies(&DieState<double>::shear_limit)});
    for (const Way &way : ways)
    {
      WorstErrors errors;
      errors.take(slope_errors(run, way, {bar})[0], way.direction.name);
      errors.print("  " + way.direction.name + ": ");
      largest = std::max(largest, errors.difference());
    }
    return largest;
  }

  /// By the coefficient, of runs that find contacts and active sets by themselves.
  void whole_runs(Parameters parameters)
  {
    RecordedRun  run(parameters);
    const double gradient = run.adjoint().process.dies[0].friction + run.adjoint().process.dies[1].friction;
    const auto   energy   = [&](const double change) {
      for (DieParameters &die : parameters.dies)
        die.friction = 0.25 + change;
      return RecordedRun(parameters).state().energy.total();
    };
    constexpr double h     = 1e-4;
    const double     error = relative_error((energy(h) - energy(-h)) / (2. * h), gradient);
    std::cout << "whole runs, by the coefficient: within 1e-5: " << yes(error < 1e-5) << "\n";
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const Parameters                         block  = tilted_block();
  Parameters                               krylov = block;
  krylov.linear_solver.method                     = LinearSolverParameters::Method::automatic;
  Parameters quadratic                            = block;
  quadratic.discretization.choice.pair            = ElementPair::taylor_hood;
  quadratic.billet.element_size                   = 20.;
  std::vector<double> errors;
  const auto          check_law =
    [&](const std::string &name, const Parameters &p, const std::string &law, const bool with_metal) {
      errors.push_back(check(law + ", " + name, with_friction(p, law), with_metal));
    };
  for (const std::string law : {"Tresca", "Coulomb"})
  {
    check_law("tilted die", block, law, true);
    check_law("tilted die, quadratic velocities", quadratic, law, true);
    check_law("tripods", tripod_scene(), law, false);
    whole_runs(with_friction(block, law));
  }
  check_law("tilted die, Krylov's method", krylov, "Coulomb", false);
  std::cout << "FIGURE friction_laws_gradient_error " << *std::max_element(errors.begin(), errors.end())
            << "\n";
}
