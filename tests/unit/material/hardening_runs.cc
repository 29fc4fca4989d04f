// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Whole runs of metals that harden with their accumulated strain, one of them made by the test: each cell has
// the law of its strain at the stage. Proved:
// - uniform frictionless upsetting, whose increments are known by hand, gives that energy for each law, and
//   more than metal that does not harden; with twice as many increments of the midpoint scheme the error
//   against the integral of the flow stress over the strain is a quarter;
// - under a tilted die with friction the backward sweep agrees with the direct method to 1e-10, and with
//   replayed differences to 1e-6, by node positions, speed and offset of the die, and the numbers K, m, a and
//   n of the metal, of both element pairs and both schemes, of the energy, and of an objective of the strain;
//   along each the remainder of Taylor's expansion falls with the square of the step;
// - so it does where the metal warms by its work, by the numbers of its heat and its temperature before the
//   stroke, of extremes of the temperature;
// - so it does where heat flows, in the metal, through skins to the dies and through films to the air, and a workpiece
//   is transferred and waits, by all numbers of heat and a die's temperature, of both element pairs, and of the temperature
//   of a die's surface;
// - so it does where the mesh is made anew in between, and the strain is carried over;
// - and so it does under friction after Tresca and Coulomb, whose flow stress is that of the strained metal behind the
//   point: as the metal hardens the power of friction grows with its flow stress.

#include <deal.II/base/mpi.h>

#include <retroforge/objective/cell_statistics.h>
#include <retroforge/objective/die_temperature.h>
#include <retroforge/objective/energy.h>
#include <retroforge/objective/temperatures.h>

#include "../adjoint/ways.h"
#include "hardening_metal.h"
#include "hot_metals.h"

#include <fstream>

using namespace retroforge;

namespace
{
  constexpr double a = 2., n = 0.4;

  void harden(Parameters &p)
  {
    p.material.type    = "hardening";
    p.material.numbers = {{"a", a}, {"n", n}};
  }

  /// Steel C45 at 1100 C by Hensel and Spittel.
  void harden_as_steel(Parameters &p)
  {
    p.material.type        = "Hansel-Spittel";
    p.material.numbers     = {{"A", 3268.49},
                              {"m1", -0.00267855},
                              {"m2", 0.34446},
                              {"m4", 0.000551814},
                              {"m5", -0.00132042},
                              {"m7", 0.0166334},
                              {"m8", 0.000149907},
                              {"q0", 0.05}};
    p.material.temperature = "1100";
  }

  /// A table of the curves (1 + q/2) (1 + q) e^0.2 at two rates, five strains and one temperature.
  void harden_by_table(Parameters &p)
  {
    std::ofstream out("curves.csv");
    out.precision(17);
    out << "strain,strain rate,temperature,flow stress\n";
    for (const double q : {0., 0.1, 0.25, 0.5, 1.})
      for (const double e : {0.5, 20.})
        out << q << ',' << e << ",20," << 10. * (1. + 0.5 * q) * (1. + q) * std::pow(e, 0.2) << '\n';
    p.material.type  = "table";
    p.material.table = "curves.csv";
  }

  struct Hardening
  {
    std::string name;
    void (*apply)(Parameters &);
  };

  const std::vector<Hardening> laws{{"power", harden_by_power},
                                    {"Hansel-Spittel", harden_as_steel},
                                    {"table", harden_by_table}};

  constexpr double height = 30., stroke = 12., speed = 100.;

  /// A quarter of a cube between frictionless dies.
  Parameters cube(const ElementPair element)
  {
    Parameters p;
    p.billet.size                = Vec3({height, height, height});
    p.billet.element_size        = height;
    p.billet.symmetry_planes     = {Vec3({-1., 0., 0.}), Vec3({0., -1., 0.})};
    p.dies                       = {DieParameters("lower"), DieParameters("upper")};
    p.dies[0].facing             = Vec3({0, 0, 1});
    p.dies[1].point              = Vec3({0, 0, height});
    p.dies[1].facing             = Vec3({0, 0, -1});
    p.dies[1].velocity           = Vec3({0, 0, -speed});
    p.material.law               = {1.7, 0.3, 0.05};
    p.press.stroke               = stroke;
    p.press.increments           = 12;
    p.press.largest_move         = 10.;
    p.press.largest_loss         = 0.1;
    p.contact.penetration        = 1e-9;
    p.newton.tolerance           = 1e-10;
    p.linear_solver.method       = LinearSolverParameters::Method::direct;
    p.discretization.choice.pair = element;
    return p;
  }

  /// Energy of the quarter by hand: in each stage of an increment the velocity is  speed/h (x/2, y/2, -z),
  /// its strain rate speed/h, and the strain follows as the position does.
  double energy_by_hand(const Scheme &scheme, const Parameters &p)
  {
    const Material<double> metal = p.material.metal(speed / height);
    const double           dt    = stroke / p.press.increments / speed;
    double                 w = height, h = height, q = 0., energy = 0.;
    for (unsigned int i = 0; i < p.press.increments; ++i)
    {
      std::vector<double> w_dot, q_dot;
      double              w_next = w, q_next = q;
      for (unsigned int s = 0; s < scheme.n_stages(); ++s)
      {
        double w_s = w, h_s = h, q_s = q;
        for (unsigned int r = 0; r < scheme.a[s].size(); ++r)
        {
          w_s += dt * scheme.a[s][r] * w_dot[r];
          h_s -= dt * scheme.a[s][r] * speed;
          q_s += dt * scheme.a[s][r] * q_dot[r];
        }
        const double e      = speed / h_s;
        const auto   law    = metal.at({q_s, metal.initial.temperature});
        const double stress = 3. * law.K * e * std::pow(3. * (e * e + law.e0 * law.e0), 0.5 * (law.m - 1.));
        energy += 0.25 * dt * scheme.b[s] * w_s * w_s * h_s * stress * e;
        w_dot.push_back(w_s * e / 2.);
        q_dot.push_back(e);
        w_next += dt * scheme.b[s] * w_dot.back();
        q_next += dt * scheme.b[s] * e;
      }
      w = w_next;
      q = q_next;
      h -= dt * speed;
    }
    return energy;
  }

  void check_upsetting(const ElementPair element, const Scheme &scheme)
  {
    Parameters   p    = cube(element);
    const double soft = energy_by_hand(scheme, p);
    harden(p);
    const RecordedRun run(p, {p.dies[0].die(), p.dies[1].die()}, {}, scheme);
    const double      by_hand = energy_by_hand(scheme, p);
    const double      error   = relative_error(run.state().energy.total(), by_hand);
    std::cout << "upsetting, " << (element == ElementPair::mini ? "mini" : "P2-P1") << ", " << scheme.name
              << ": increments " << run.records.size()
              << ", energy by hand within 1e-7: " << yes(error < 1e-7)
              << ", hardening adds a tenth or more: " << yes(by_hand > 1.1 * soft) << "\n";
  }

  /// Volume times the integral of the flow stress over the strain  ln(h_0/h),  by Simpson's rule.
  double energy_in_the_limit(const Parameters &p)
  {
    constexpr unsigned int n_points = 4001;
    const Material<double> metal    = p.material.metal(speed / height);
    const double           end = std::log(height / (height - stroke)), dq = end / (n_points - 1);
    double                 sum = 0.;
    for (unsigned int i = 0; i < n_points; ++i)
    {
      const double q = i * dq, e = speed / height * std::exp(q);
      const auto   law  = metal.at({q, metal.initial.temperature});
      const double mean = std::pow(3. * (e * e + law.e0 * law.e0), 0.5 * (law.m - 1.));
      sum += (i == 0 || i + 1 == n_points ? 1. : (i % 2 == 1 ? 4. : 2.)) * 3. * law.K * mean * e;
    }
    return 0.25 * height * height * height * sum * dq / 3.;
  }

  void check_law(const Hardening &hardening)
  {
    std::vector<double> errors;
    double              against_hand = 0.;
    for (const unsigned int increments : {12, 24})
    {
      Parameters p          = cube(ElementPair::mini);
      p.press.increments    = increments;
      p.contact.penetration = 1e-9;
      hardening.apply(p);
      const RecordedRun run(p, {p.dies[0].die(), p.dies[1].die()}, {}, Scheme::by_name("midpoint"));
      const double      energy = run.state().energy.total();
      against_hand =
        std::max(against_hand, relative_error(energy, energy_by_hand(Scheme::by_name("midpoint"), p)));
      errors.push_back(std::abs(energy / energy_in_the_limit(p) - 1.));
    }
    const double order = std::log2(errors[0] / errors[1]);
    std::cout << hardening.name << ": energy by hand within 1e-9: " << yes(against_hand < 1e-9)
              << ", order in time above 1.9: " << yes(order > 1.9) << "\n";
    if (against_hand >= 1e-9 || order <= 1.9)
      std::cout << "  " << against_hand << ", " << order << "\n";
  }

  Objectives objectives(const Heating heating)
  {
    const bool warms = heating != Heating::none;
    Objectives all;
    all.push_back(
      {"energy", 1., SymmetryScaling::none, invalid_index, std::make_unique<EnergyObjective>(), nullptr});
    all.push_back({"variance of the strain",
                   1.,
                   SymmetryScaling::none,
                   invalid_index,
                   nullptr,
                   std::make_unique<CellStatistics>(CellQuantity::strain, CellStatistic::variance)});
    for (const TemperatureExtreme extreme : {TemperatureExtreme::spread, TemperatureExtreme::largest})
      if (warms)
        all.push_back({"temperature",
                       1.,
                       SymmetryScaling::none,
                       invalid_index,
                       nullptr,
                       std::make_unique<TemperatureObjective>(extreme, 2.)});
    if (heating == Heating::conduction)
      all.push_back({"temperature of the upper die",
                     1.,
                     SymmetryScaling::none,
                     invalid_index,
                     nullptr,
                     std::make_unique<DieTemperature>(1, 20.)});
    return all;
  }

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

  void check_gradients(const std::string &name, const Parameters &p, const Meshes meshes)
  {
    const bool  warms = p.heat.heating != Heating::none;
    RecordedRun run(p, {p.dies[0].die(), p.dies[1].die()}, objectives(p.heat.heating), {}, meshes);
    const auto  sweep = run.sweep(each(run.objectives()));
    const NodalVectors<double> still(run.scene.mesh.n_nodes());
    using Dots            = std::function<void(Process<double> &)>;
    std::vector<Way> ways = {Way{{"random X_0", random_vectors(still.size()), 0., 0., {}}},
                             Way{{"speed", still, 1., 0., {}}},
                             Way{{"offset", still, 0., 1., {}}}};
    const auto       add  = [&](const std::string &name, const Dots &dots) {
      ways.push_back({{name, still, 0., 0., {}}, dots});
    };
    // Numbers of the metal: K, m, e0, those of its law, its strain and temperature before the stroke.
    const auto add_metal = [&](const std::string &name, const unsigned int i, const double dot = 1.) {
      add(name, [=](Process<double> &process) { number_of(process.material, i) = dot; });
    };
    add_metal("K", 0);
    add_metal("m", 1);
    add_metal("a", 3);
    add_metal("n", 4);
    if (warms)
    {
      // Steps that warm by a degree, and change the rest by parts alike.
      add_metal("beta", 5, 0.01);
      add_metal("T_0", 9, 100.);
      HeatLaw<double> law  = run.process().heat;
      const auto      info = law.info();
      for (unsigned int i = 0; i < info.size(); ++i)
        if (law.reads(info[i].name))
          add(info[i].name,
              [i, of = number_of(law, i)](Process<double> &process) { number_of(process.heat, i) = of; });
    }
    if (p.heat.heating == Heating::conduction)
    {
      add("transfer time", [](Process<double> &process) { process.operations[0].waiting.transfer = 0.3; });
      add("dwell time", [](Process<double> &process) { process.operations[0].waiting.dwell = 0.1; });
      for (unsigned int d = 0; d < 2; ++d)
        add("temperature of die " + run.scene.dies[d].name,
            [d](Process<double> &process) { process.dies[d].temperature = 100.; });
    }
    WorstErrors worst;
    for (const Way &way : ways)
    {
      // A slope that is little beside the value, as the largest temperature's by the film of the dwell, is measured by a part of that
      // of which differences over 1e-5 are exact to 1e-7.
      const auto errors = slope_errors(run, way, sweep.gradients, 1e-3, 1e-5);
      for (std::size_t o = 0; o < errors.size(); ++o)
        worst.take(errors[o], run.objectives()[o].name + " by " + way.direction.name);
    }
    worst.print(name + ": meshes made anew: " + (run.state().remeshed.empty() ? "none" : "some") + ", ");
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) > 0)
    std::cout.setstate(std::ios::failbit);
  add_hardening_metal();
  for (const ElementPair element : {ElementPair::mini, ElementPair::taylor_hood})
    for (const Scheme &scheme : Scheme::all())
      check_upsetting(element, scheme);
  for (const Hardening &hardening : laws)
    check_law(hardening);
  Parameters block = tilted_block();
  harden(block);
  Parameters quadratic                 = block;
  quadratic.discretization.choice.pair = ElementPair::taylor_hood;
  quadratic.billet.element_size        = 20.;
  Parameters krylov                    = block;
  krylov.linear_solver.method          = LinearSolverParameters::Method::automatic;
  check_gradients("tilted die", block, Meshes::one);
  check_gradients("tilted die, Krylov's method", krylov, Meshes::one);
  check_gradients("tilted die, quadratic velocities", quadratic, Meshes::one);
  check_gradients("tilted die, warming", warming(block), Meshes::one);
  check_gradients("tilted die, conduction", conducting(block), Meshes::one);
  check_gradients("tilted die, conduction, quadratic velocities", conducting(quadratic), Meshes::one);
  check_gradients("tilted die, Tresca", with_friction(block, "Tresca"), Meshes::one);
  check_gradients(
    "tilted die, Coulomb, quadratic velocities", with_friction(quadratic, "Coulomb"), Meshes::one);
  for (Parameters *p : {&block, &quadratic})
  {
    p->press.scheme     = "euler";
    p->remeshing.when   = RemesherParameters::When::increments;
    p->remeshing.every  = 2;
    p->remeshing.method = RemesherParameters::Method::rebuild;
    p->press.increments = 5;
  }
  check_gradients("remeshing", block, Meshes::anew);
  check_gradients("remeshing, warming", warming(block), Meshes::anew);
  check_gradients("remeshing, conduction", conducting(block), Meshes::anew);
  check_gradients("remeshing, Tresca", with_friction(block, "Tresca"), Meshes::anew);
  check_gradients("remeshing, quadratic velocities", quadratic, Meshes::anew);
}
