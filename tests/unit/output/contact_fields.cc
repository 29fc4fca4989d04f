// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// What the dies do to the surface.
// - By hand: a block 30 x 30 x 30, a quarter of it, upset at 100 mm/s without friction flows as
//   V = r (x/2, y/2, -z), r = 100/h, under the pressure sigma = K 3^((m+1)/2) r^m. Nodes inside a die's face
//   press with sigma (at its rim half their area is that of a free side, and so is their pressure). Those
//   below press with die 1, those above with die 2, and slip as they move, V without its part along z.
// - With friction, on tilted die and edge, the integral of the pressure is the force that the dies push with.

#include <deal.II/base/mpi.h>

#include <retroforge/mesh/surface_areas.h>
#include <retroforge/output/contact_fields.h>

#include "../adjoint/recorded_run.h"
#include "../element/element_test_tools.h"

using namespace retroforge;

constexpr double size = 30., speed = 100.;

Parameters frictionless_block()
{
  Parameters p;
  p.billet.size            = Vec3({size, size, size});
  p.billet.element_size    = 11;
  p.billet.symmetry_planes = {Vec3({-1, 0, 0}), Vec3({0, -1, 0})};
  p.dies                   = {DieParameters("lower"), DieParameters("upper")};
  p.dies[0].facing         = Vec3({0, 0, 1});
  p.dies[1].point          = Vec3({0, 0, size});
  p.dies[1].facing         = Vec3({0, 0, -1});
  p.dies[1].velocity       = Vec3({0, 0, -speed});
  p.material.law.e0        = 1e-6;
  p.press.scheme           = "euler";
  p.press.stroke           = 1.;
  p.press.increments       = 1;
  p.contact.approach       = 1.;
  p.contact.penetration    = 1e-8;
  p.contact.counts_closing = false; // forces are then those that pressures add up to
  p.newton.tolerance       = 1e-11;
  p.linear_solver.method   = LinearSolverParameters::Method::direct;
  return p;
}

/// The fields of the last increment of a run, and what they are compared with.
struct LastFields
{
  explicit LastFields(const Parameters &p)
      : run(p)
      , record(run.records.back())
      , X(positions_before(run))
      , solved(run.first_epoch().increment.mechanics.recorded(run.process(), {X, {}}, record))
      , last(solved.last())
      , W(last.W)
      , fields(contact_fields(last.stage, W, last.active))
  {
  }

  static NodalVectors<double> positions_before(const RecordedRun &run)
  {
    NodalVectors<double> X = run.scene.mesh.X;
    for (std::size_t i = 0; i + 1 < run.records.size(); ++i)
      X = run.first_epoch().increment.mechanics.recorded(run.process(), {X, {}}, run.records[i]).X;
    return X;
  }

  RecordedRun            run;
  const IncrementRecord &record;
  NodalVectors<double>   X;
  SolvedIncrement        solved;
  const SolvedStage     &last;
  const Field<double>   &W;
  ContactFields          fields;
};

void homogeneous()
{
  const LastFields          f(frictionless_block());
  const NortonHoff<double> &law = f.run.process().material.law;
  const double r = speed / size, sigma = law.K * std::pow(3., (law.m + 1.) / 2.) * std::pow(r, law.m);
  Errors       errors;
  unsigned int inside = 0;
  for (NodeIndex k = 0; k < f.X.size(); ++k)
  {
    const Vec3  &x   = f.X[k];
    const double die = x[2] == 0. ? 1. : x[2] == size ? 2. : 0.;
    errors.compare("touching die", f.fields.die[k], die);
    errors.compare("slip", (f.fields.slip[k] - (die > 0.) * r / 2 * Vec3({x[0], x[1], 0})).norm(), 0.);
    if (die == 0.)
      errors.compare("pressure of the others", f.fields.pressure[k], 0.);
    else if (x[0] < size / 2 - 1e-6 && x[1] < size / 2 - 1e-6)
    {
      errors.compare("pressure inside the faces", f.fields.pressure[k], sigma);
      ++inside;
    }
  }
  std::cout << "upset evenly, nodes inside the faces: " << inside << std::endl;
  errors.print(1e-5);
}

/// Of the dies, without what friction adds.
double pushing_force(const LastFields &f)
{
  double force = 0.;
  for (unsigned int p = 0; p < f.record.pairs.size(); ++p)
    if (const auto node = f.last.stage.contact_node(p, f.W, f.record.solves.back().active); node.active)
      force += f.run.process().contact.rho * node.S * approach_excess(node);
  return force;
}

void integral(const std::string &name, const Parameters &p)
{
  const LastFields f(p);
  const auto       areas = lumped_areas(surface_triangles(f.run.scene.mesh), f.last.stage.X);
  double           sum   = 0.;
  for (NodeIndex k = 0; k < areas.size(); ++k)
    sum += f.fields.pressure[k] * areas[k];
  Errors errors;
  errors.compare("integral of the pressure", sum, pushing_force(f));
  if (name == "flat") // no friction: all of it is along z
    errors.compare("force of both dies", sum, f.record.forces[0][2] - f.record.forces[1][2]);
  std::cout << name << std::endl;
  errors.print(1e-12);
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  homogeneous();
  integral("flat", frictionless_block());
  integral("tilted", tilted_block());
}
