// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Every term of the backward sweep is needed, and tests of this kind can see it: on a small block under a
// tilted die, with a soft penalty, the adjoint agrees with replayed central differences along three
// directions (all nodes at random, the nodes in contact lifted off their die, the speed of the die); and a
// sweep that leaves out any one term does not. The sweep with omissions is the test's own, built from the
// library's kernels: complete, it agrees with adjoint_sweep. The times of an increment depend on the speed
// alone, so their terms must show along that direction, all others along the two that move nodes. The same under friction
// after Tresca, for the strain rate that it follows, and with zones of friction on the dies, for the weight of a zone by
// the place on the die.

#include <deal.II/base/mpi.h>

#include "directions.h"
#include "sweep_with_omissions.h"

#include <retroforge/case/parameters.h>

#include <iostream>

using namespace retroforge;

namespace
{
  using Terms = std::vector<std::pair<Term, std::string>>;

  const Terms terms = {{Term::gap, "d delta/dX"},
                       {Term::area, "d S/dX"},
                       {Term::friction_area, "d S^f/dX"},
                       {Term::ramp, "w'(delta)"},
                       {Term::lambda_bubble, "bubble part of lambda"},
                       {Term::power_bubble, "dPhi/dbeta"},
                       {Term::closing, "the work on gaps that close"},
                       {Term::first_stage, "lambda of the first stage"},
                       {Term::dt, "d dt/d(speed)"},
                       {Term::tau, "d tau/d(speed)"}};

  const Terms terms_of_tresca = {{Term::rate, "d(e^2)"},
                                 {Term::rate_position, "d(e^2)/dX"},
                                 {Term::rate_velocity, "d(e^2)/d(velocity before)"}};

  const Terms terms_of_zones = {{Term::zone, "d w/dX of zones"}};

  std::vector<Direction> directions(const RecordedRun &run)
  {
    std::mt19937                           generator(3);
    std::uniform_real_distribution<double> uniform(-1., 1.);
    const NodalVectors<double>             still(run.state().workpiece.X.size());
    std::vector<Direction>                 list = {{"random X_0", still, 0., 0., {}},
                                                   {"contact nodes lifted", still, 0., 0., {}},
                                                   {"die speed", still, 1., 0., {}}};
    for (Vec3 &x : list[0].X_dot)
      for (unsigned int i = 0; i < 3; ++i)
        x[i] = uniform(generator);
    // Each by another amount: a common one would move the whole billet.
    for (const ContactPair &pair : run.records[0].pairs)
      if (pair.touching)
        list[1].X_dot[pair.point.nodes[0]] -=
          (1.5 + uniform(generator)) *
          run.scene.dies[pair.die].project(pair.point.position(run.scene.mesh.X), Vec3(), pair.feature).n;
    return list;
  }

  void check(RecordedRun &problem, const Terms &omitted)
  {
    const auto          along   = directions(problem);
    const AdjointResult library = problem.adjoint(), complete = sweep(problem, Term::none);
    std::vector<double> differences;
    std::cout << "complete sweep\n";
    for (const Direction &direction : along)
    {
      const double h = direction.speed_dot == 0. ? 1e-6 : 1e-5;
      differences.push_back(difference(problem, direction, h));
      const double adjoint = slope(problem, complete, direction);
      std::cout << "  " << direction.name
                << ": differences within 1e-7: " << yes(relative_error(adjoint, differences.back()) < 1e-7)
                << ", adjoint_sweep within 1e-13: "
                << yes(relative_error(adjoint, slope(problem, library, direction)) < 1e-13) << "\n";
    }
    for (const auto &[term, name] : omitted)
    {
      const AdjointResult without = sweep(problem, term);
      std::cout << "without " << name << "\n";
      for (std::size_t d = 0; d < along.size(); ++d)
      {
        const double found = relative_error(slope(problem, without, along[d]), differences[d]);
        const bool   times = term == Term::dt || term == Term::tau;
        if (times == (along[d].speed_dot != 0.))
          std::cout << "  " << along[d].name << ": error > 1e-6: " << yes(found > 1e-6) << "\n";
      }
    }
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  RecordedRun                              norton(tilted_block());
  check(norton, terms);
  Parameters parameters = tilted_block();
  for (DieParameters &die : parameters.dies)
    die.friction_law = "Tresca";
  RecordedRun tresca(parameters);
  std::cout << "friction after Tresca\n";
  check(tresca, terms_of_tresca);
  parameters = tilted_block();
  for (DieParameters &die : parameters.dies)
  {
    die.zone_edge           = 12.;
    DieZoneParameters &zone = die.zones.emplace_back("flash", die.section());
    zone.from               = Vec3({2., -3., -20.});
    zone.to                 = Vec3({40., 40., 50.});
    zone.friction_law       = "Tresca";
    zone.friction           = 0.9;
  }
  RecordedRun zones(parameters);
  std::cout << "zones of friction\n";
  check(zones, terms_of_zones);
}
