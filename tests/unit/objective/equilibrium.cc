// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Objectives on solved increments: a block with friction, m = 0.3, upset between flat dies.
// - The energy is the one that the run itself counts.
// - The mean effort, power over die speed, is the mean of the die's reaction, up to what the penalty lets the
//   die sink in: ten times the penetration, ten times the difference. That ratio is the test.

#include <deal.II/base/mpi.h>

#include <retroforge/objective/effort.h>
#include <retroforge/objective/energy.h>

#include "../adjoint/recorded_run.h"
#include "objective_test_tools.h"

using namespace retroforge;

Parameters flat_dies(const double penetration)
{
  Parameters p;
  p.billet.size         = Vec3({30, 30, 30});
  p.billet.element_size = 14;
  p.dies                = {DieParameters("lower"), DieParameters("upper")};
  p.dies[0].facing      = Vec3({0, 0, 1});
  p.dies[1].point       = Vec3({0, 0, 30});
  p.dies[1].facing      = Vec3({0, 0, -1});
  p.dies[1].velocity    = Vec3({0, 0, -100});
  for (DieParameters &die : p.dies)
    die.friction = 0.4;
  p.material.law.m         = 0.3;
  p.material.law.e0        = 0.01;
  p.press.stroke           = 3.;
  p.press.increments       = 4;
  p.contact.penetration    = penetration;
  p.contact.counts_closing = false; // with it the two are one number (unit/steps/closing_gap)
  p.newton.tolerance       = 1e-12;
  p.linear_solver.method   = LinearSolverParameters::Method::direct;
  return p;
}

/// The run's increments as an objective sees them.
PathRows<double> rows(const RecordedRun &run, const PathObjective &objective)
{
  PathRows<double>     rows;
  NodalVectors<double> X = run.scene.mesh.X;
  for (const IncrementRecord &record : run.records)
  {
    const SolvedIncrement solved =
      run.first_epoch().increment.mechanics.recorded(run.process(), {X, {}}, record);
    rows.push_back(row_of(record, run.process()));
    add_integrals(objective, solved.last().view(), rows.back());
    X = solved.X;
  }
  return rows;
}

/// Relative difference of the two mean efforts over the last two thirds of the stroke.
double difference(const double penetration)
{
  const RecordedRun     run(flat_dies(penetration));
  const EnergyObjective energy;
  const auto            energy_rows  = rows(run, energy);
  const auto            energy_parts = EnergyObjective::split(energy_rows);
  Errors                errors;
  errors.compare("deformation energy", energy_parts.deformation, run.state().energy.deformation);
  errors.compare("friction energy", energy_parts.friction, run.state().energy.friction);
  errors.compare("energy", energy.value(energy_rows), run.state().energy.total());
  std::cout << "penetration " << penetration << std::endl;
  errors.print(1e-12);
  const unsigned int upper = run.process().operations[0].leading_die;
  const PathWindow   window{PathWindow::Over::stroke, 1., 3.};
  const MeanEffort   by_power(Effort(upper), window), by_force(Effort(upper, Effort::By::force), window);
  const double       power = by_power.value(rows(run, by_power)), force = by_force.value(rows(run, by_force));
  return force / power - 1.;
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const double                             soft = difference(1e-3), hard = difference(1e-4);
  std::cout << "die's reaction against power over speed" << std::endl
            << "  within 1e-4 and 1e-5: " << (std::abs(soft) < 1e-4 && std::abs(hard) < 1e-5 ? "yes" : "NO")
            << std::endl
            << "  ratio between 9.5 and 10.5: " << (soft / hard > 9.5 && soft / hard < 10.5 ? "yes" : "NO")
            << std::endl
            << "FIGURE effort_against_reaction " << std::abs(hard) << std::endl;
}
