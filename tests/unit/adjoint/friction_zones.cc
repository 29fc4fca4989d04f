// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Zones of friction on a tilted die. Proved:
// - a zone that the whole billet is in gives the energy of a die with that friction, to rounding; two zones with a common
//   face and equal numbers give that of one; and a zone with other numbers changes it;
// - with laws that differ between zones and die the backward sweep agrees with the direct method to 1e-10, with replayed
//   central differences to 1e-6, and the remainder of Taylor's expansion is of second order: by the nodes, the speed and the offset
//   of the upper die, which takes its zones along, and coefficient and bound of a zone; with linear and with quadratic velocities;
// - by the coefficient of a zone also with a difference of whole runs that decide anew.

#include <deal.II/base/mpi.h>

#include "ways.h"

using namespace retroforge;

namespace
{
  const Vec3 everywhere_from({-100., -100., -100.}), everywhere_to({100., 100., 100.});

  void add_zone(DieParameters     &die,
                const std::string &name,
                const Vec3        &from,
                const Vec3        &to,
                const std::string &law,
                const double       friction)
  {
    DieZoneParameters &zone = die.zones.emplace_back(name, die.section());
    zone.from               = from;
    zone.to                 = to;
    zone.friction_law       = law;
    zone.friction           = friction;
    zone.shear_limit        = 0.5;
    die.zone_edge           = 12.;
  }

  Parameters with_own(const std::string &law, const double friction)
  {
    Parameters p = tilted_block();
    for (DieParameters &die : p.dies)
    {
      die.friction_law = law;
      die.friction     = friction;
    }
    return p;
  }

  /// Coulomb's friction on a part, Tresca's on another, which share a face; none on the rest of the upper die.
  Parameters with_zones(Parameters p)
  {
    for (DieParameters &die : p.dies)
    {
      die.friction_law = "Norton";
      die.friction     = die.name == "upper" ? 0. : 0.3;
      add_zone(die, "flash", Vec3({4., -50., -50.}), Vec3({100., 50., 60.}), "Coulomb", 0.25);
      add_zone(die, "land", Vec3({-5., -50., -50.}), Vec3({4., 2., 60.}), "Tresca", 0.4);
    }
    return p;
  }

  double energy_of(const Parameters &p)
  {
    return RecordedRun(p).state().energy.total();
  }

  void equal_friction()
  {
    const double own = energy_of(with_own("Tresca", 0.25));
    Parameters   one = with_own("Norton", 0.7), two = one, half = one;
    for (DieParameters &die : one.dies)
      add_zone(die, "all", everywhere_from, everywhere_to, "Tresca", 0.25);
    for (DieParameters &die : two.dies)
    {
      add_zone(die, "left", everywhere_from, Vec3({6., 100., 100.}), "Tresca", 0.25);
      add_zone(die, "right", Vec3({6., -100., -100.}), everywhere_to, "Tresca", 0.25);
    }
    for (DieParameters &die : half.dies)
      add_zone(die, "left", everywhere_from, Vec3({6., 100., 100.}), "Tresca", 0.25);
    std::cout << "a zone everywhere is as the die's own friction within 1e-12: "
              << yes(relative_error(energy_of(one), own) < 1e-12)
              << ", two as one: " << yes(relative_error(energy_of(two), own) < 1e-12)
              << ", half a zone is something else: " << yes(relative_error(energy_of(half), own) > 1e-3)
              << "\n";
  }

  void check(const std::string &name, const Parameters &parameters)
  {
    const RecordedRun          run(parameters);
    const AdjointResult        bar = run.adjoint();
    const NodalVectors<double> still(run.state().workpiece.X.size());
    std::cout << name << "\n";
    const auto set_zones = [](double ZoneFriction<double>::*number) {
      return [number](Process<double> &dot) {
        for (auto &die : dot.dies)
          die.zones[0].*number = 1.;
      };
    };
    const std::vector<Way> ways{
      {{"random X_0", random_vectors(still.size()), 0., 0., {}}},
      {{"speed", still, 1., 0., {}}},
      {{"offset", still, 0., 1., {}}},
      {{"friction of a zone", still, 0., 0., {}}, set_zones(&ZoneFriction<double>::friction)},
      {{"its limit", still, 0., 0., {}}, set_zones(&ZoneFriction<double>::shear_limit)}};
    for (const Way &way : ways)
    {
      WorstErrors errors;
      errors.take(slope_errors(run, way, {bar})[0], way.direction.name);
      errors.print("  " + way.direction.name + ": ");
    }
  }

  void whole_runs(Parameters parameters)
  {
    const RecordedRun   run(parameters);
    const AdjointResult bar = run.adjoint();
    const double gradient   = bar.process.dies[0].zones[1].friction + bar.process.dies[1].zones[1].friction;
    const auto   energy     = [&](const double change) {
      for (DieParameters &die : parameters.dies)
        die.zones[1].friction = 0.4 + change;
      return energy_of(parameters);
    };
    constexpr double h     = 1e-4;
    const double     error = relative_error((energy(h) - energy(-h)) / (2. * h), gradient);
    std::cout << "whole runs, by the coefficient of a zone: within 1e-5: " << yes(error < 1e-5) << "\n";
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  equal_friction();
  const Parameters block               = with_zones(tilted_block());
  Parameters       quadratic           = block;
  quadratic.discretization.choice.pair = ElementPair::taylor_hood;
  quadratic.billet.element_size        = 20.;
  check("tilted die", block);
  check("quadratic velocities", quadratic);
  whole_runs(block);
}
