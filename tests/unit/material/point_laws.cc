// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// A metal whose consistency follows the accumulated strain, made by the test, and known by its name. Proved,
// on one rank and on two:
// - the law at a point and its reverse, by the numbers of the metal and by the strain, are those by hand; of
//   Norton-Hoff the law is the same at any strain, to the bit;
// - cells of different strains: the reverse of residual and power, by the strain of each cell and all numbers
//   of the metal, is the transpose of their derivative:  <A x, y> = <x, A^T y>,  with linear and with
//   quadratic velocities;
// - residual and tangent are those of cells that each have their own law: the tangent times w is the
//   derivative of the residual;
// - a law that is not known is refused by its name with those that are, and so are numbers that a law has
//   not, or that it forbids.

#include <deal.II/base/mpi.h>

#include <retroforge/core/error.h>
#include <retroforge/core/timer.h>
#include <retroforge/material/material_parameters.h>
#include <retroforge/solver/linear_system.h>

#include "../solver/corner_stage.h"
#include "hardening_metal.h"

using namespace retroforge;

namespace
{
  Material<double> metal_of(const MaterialLaw<double> &law)
  {
    Material<double> metal(law);
    metal.type    = find_material_type("hardening", "test");
    metal.numbers = {2.5, 0.3};
    return metal;
  }

  void check_point(Errors &errors)
  {
    const Material<double>    metal = metal_of({1.7, 0.2, 0.1});
    const PointState<double>  state{0.6, 20.};
    const double              base = 1. + 2.5 * 0.6, factor = std::pow(base, 0.3);
    const MaterialLaw<double> law = metal.at(state);
    errors.compare("law", {law.K, law.m, law.e0}, {1.7 * factor, 0.2, 0.1});
    Material<double>   bar;
    PointState<double> state_bar;
    reverse_at(metal, state, {0.7, -0.4, 0.9}, bar, state_bar);
    errors.compare(
      "reverse by the law's numbers", {bar.law.K, bar.law.m, bar.law.e0}, {0.7 * factor, -0.4, 0.9});
    const double by_base = 0.7 * 1.7 * 0.3 * factor / base;
    errors.compare("reverse by a and n", bar.numbers, {by_base * 0.6, 0.7 * 1.7 * factor * std::log(base)});
    errors.compare("reverse by the strain", state_bar.strain, by_base * 2.5);
    const Material<double>    same(metal.law);
    const MaterialLaw<double> there = same.at(state);
    errors.compare("Norton-Hoff, by bits",
                   there.K == 1.7 && there.m == 0.2 && there.e0 == 0.1 && !same.depends_on_state() ? 1. : 0.,
                   1.);
  }

  /// A corner stage of hardening metal.
  struct HardenedStage
  {
    CornerStage                     corner;
    std::vector<PointState<double>> points;

    HardenedStage(Random &random, const ElementPair pair)
        : corner(random, 2., pair, {{2, 3, 2}}), points(corner.scene.mesh.n_cells())
    {
      for (PointState<double> &point : points)
        point.strain = 0.5 + 0.5 * random.scalar();
      corner.physics.material = metal_of(corner.physics.material.law);
    }

    Equilibrium<double> stage() const
    {
      return {corner.scene, corner.physics, corner.contact, corner.X, points};
    }
  };

  Dual along(const double x, const double x_dot)
  {
    Dual dual(1, x);
    dual.fastAccessDx(0) = x_dot;
    return dual;
  }

  ContactSet<Dual>
  contact_of(const CornerStage &corner, const Physics<Dual> &physics, const NodalVectors<Dual> &X)
  {
    return make_contact_set<Dual>(corner.scene.view(physics.dies, X),
                                  corner.contact.pairs,
                                  {FrictionRamp{0.5, false}, Dual(0.4), 0.3, 0.3});
  }

  /// Residual and power along the strain of each cell and the numbers of the metal.
  void check_transpose(Random &random, const ElementPair pair, Errors &errors)
  {
    const HardenedStage       hardened(random, pair);
    const CornerStage        &corner         = hardened.corner;
    const auto               &discretization = corner.scene.discretization;
    const Equilibrium<double> stage          = hardened.stage();
    const std::vector<double> strain_dot     = random.scalars(hardened.points.size());
    std::vector<double>       numbers_dot;
    Physics<Dual>             physics = converted<Dual>(corner.physics);
    for_each_number(
      [&](Dual &x) {
        numbers_dot.push_back(random.scalar());
        x = along(x.val(), numbers_dot.back());
      },
      physics.material);
    std::vector<PointState<Dual>> points;
    NodalVectors<Dual>            X;
    Field<Dual>                   W(discretization);
    for (std::size_t c = 0; c < strain_dot.size(); ++c)
      points.push_back({along(hardened.points[c].strain, strain_dot[c]), Dual(0.)});
    convert(corner.X, X);
    for (unsigned int place = 0; place < W.V.size(); ++place)
      convert(corner.W.V.at_place(place), W.V.at_place(place));
    for (unsigned int place = 0; place < W.P.size(); ++place)
      W.P.at_place(place) = corner.W.P.at_place(place);
    const ContactSet<Dual>  contact = contact_of(corner, physics, X);
    const Equilibrium<Dual> moved(corner.scene, physics, contact, X, points);

    const Field<double> lambda  = corner.random_field(random);
    const Field<Dual>   r       = moved.residual(W, corner.active);
    double              forward = 0.;
    for (unsigned int place = 0; place < discretization.velocity_nodes()->n_owned(); ++place)
      for (unsigned int i = 0; i < 3; ++i)
        forward += lambda.V.at_place(place)[i] * r.V.at_place(place)[i].dx(0);
    const auto [deformation, friction] = moved.power(W, corner.active);
    const double power_forward         = 0.6 * deformation.dx(0) + 0.8 * friction.dx(0);

    const EquilibriumView<double> view{stage, corner.W, corner.active};
    const auto                    product = [&](const auto &pull_back) {
      Field<double>        W_bar(discretization);
      NodalVectors<double> X_bar(corner.X.size());
      ContactSetBar        contact_bar(corner.contact.pairs.size());
      PhysicsBar           bar(corner.scene.dies);
      EquilibriumBar       stage_bar{W_bar, X_bar, contact_bar, bar};
      pull_back(stage_bar);
      double sum  = 0.;
      auto   next = numbers_dot.begin();
      for_each_number([&](const double &x) { sum += x * *next++; }, bar.material);
      for (std::size_t c = 0; c < bar.points.size(); ++c)
        sum += bar.points[c].strain * strain_dot[c];
      return discretization.sum(sum);
    };
    errors.compare("residual, transposed",
                   product([&](EquilibriumBar &bar) { reverse_residual(view, lambda, bar); }),
                   discretization.sum(forward));
    errors.compare("power, transposed",
                   product([&](EquilibriumBar &bar) { reverse_power(view, 0.6, 0.8, bar); }),
                   discretization.sum(power_forward));
  }

  /// Of nodes but bubbles, and of pressures.
  double square(const Discretization<3> &spaces, const Field<double> &a)
  {
    double sum = 0.;
    for (unsigned int place = 0; place < spaces.condensed_nodes()->n_owned(); ++place)
      sum += a.V.at_place(place) * a.V.at_place(place);
    for (unsigned int place = 0; place < spaces.pressure_nodes()->n_owned(); ++place)
      sum += a.P.at_place(place) * a.P.at_place(place);
    return spaces.sum(sum);
  }

  /// The matrix, whose cells come in packs of four laws: M^-1 (dR/dW w) = w, dR/dW w by dual numbers.
  void check_tangent(Random &random, const ElementPair pair, Errors &errors)
  {
    const HardenedStage       hardened(random, pair);
    const CornerStage        &corner = hardened.corner;
    const auto               &spaces = corner.scene.discretization;
    const Equilibrium<double> stage  = hardened.stage();
    Field<double>             at     = corner.W;
    const Field<double>       w      = corner.random_field(random);
    solve_bubbles(stage, at);
    Physics<Dual>                 physics = converted<Dual>(corner.physics);
    std::vector<PointState<Dual>> points;
    NodalVectors<Dual>            X;
    convert(hardened.points, points);
    convert(corner.X, X);
    const auto              contact = contact_of(corner, physics, X);
    const Equilibrium<Dual> moved(corner.scene, physics, contact, X, points);
    Field<Dual>             W(spaces);
    for (unsigned int place = 0; place < W.V.size(); ++place)
      for (unsigned int i = 0; i < 3; ++i)
        W.V.at_place(place)[i] = along(at.V.at_place(place)[i], w.V.at_place(place)[i]);
    for (unsigned int place = 0; place < W.P.size(); ++place)
      W.P.at_place(place) = along(at.P.at_place(place), w.P.at_place(place));
    const Field<Dual> r = moved.residual(W, corner.active);
    Field<double>     image(spaces), x;
    for (unsigned int place = 0; place < r.V.size(); ++place)
      for (unsigned int i = 0; i < 3; ++i)
        image.V.at_place(place)[i] = r.V.at_place(place)[i].dx(0);
    for (unsigned int place = 0; place < r.P.size(); ++place)
      image.P.at_place(place) = r.P.at_place(place).dx(0);
    Timings                timings;
    LinearSolverParameters parameters;
    parameters.method = LinearSolverParameters::Method::direct;
    LinearSystem system(corner.scene, parameters, timings);
    system.assemble(stage, at, corner.active);
    system.solve_derivative(image, 1e-13, x);
    x.add(-1., w);
    errors.compare("M^-1 (dR/dW w) = w", std::sqrt(square(spaces, x) / square(spaces, w)), 0.);
  }

  void refuse(const MaterialParameters &parameters)
  {
    try
    {
      parameters.metal(1.);
      std::cout << "NOT REFUSED\n";
    }
    catch (const Error &error)
    {
      std::cout << error.what() << "\n";
    }
  }

  void check_messages()
  {
    MaterialParameters parameters;
    parameters.type = "hardenin";
    refuse(parameters);
    parameters.type = "hardening";
    refuse(parameters);
    for (const double n : {0., 1.5})
    {
      parameters.numbers = {{"a", 1.}, {"n", n}};
      refuse(parameters);
    }
    parameters.numbers = {{"a", 0.}, {"n", 0.2}};
    std::cout << "known: " << parameters.metal(1.).info().back().name << "\n";
    parameters.type = "Norton-Hoff";
    refuse(parameters);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) > 0)
    std::cout.setstate(std::ios::failbit);
  add_hardening_metal();
  Errors point;
  check_point(point);
  std::cout << "at a point\n";
  point.print(1e-14);
  for (const ElementPair pair : {ElementPair::mini, ElementPair::taylor_hood})
  {
    Random random;
    Errors errors;
    check_transpose(random, pair, errors);
    check_tangent(random, pair, errors);
    std::cout << (pair == ElementPair::mini ? "linear" : "quadratic") << " velocities\n";
    errors.print(1e-11);
  }
  check_messages();
}
