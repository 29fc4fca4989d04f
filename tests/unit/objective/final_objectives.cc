// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Objectives of the final shape and strain.
// - By hand: a box of 2 x 3 x 4 has the volume 24; strain 0.3 everywhere has the mean 0.3, no variance and
//   the maximum 0.3; strain 0.2 on part of the cells and 0.7 on the rest, of volume fraction f, has mean 0.2
//   + 0.5 f and variance 0.25 f (1 - f), and damage likewise. A cube of edge 1 within a target that is larger by d all round:
//   every surface node is d away, every corner of the target sqrt(3) d, so the two projections give 6 d and
//   sqrt(3) d 6 (1 + 2d)^2 and the mean square is d^2; it vanishes on the cube itself. Side faces of a
//   cylinder of radius 5 stretched by 1.2: radius 6, no variance.
// - The reverse against dual numbers in positions, strains, damages, displacements of the dies and vertices of the
//   target, each alone, and the Taylor order along all, the closest features kept: under an open, wavy die
//   that follows its displacement and inside a closed, bumpy surface.

#include <deal.II/base/mpi.h>

#include <retroforge/core/error.h>
#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/mesh/surface_areas.h>
#include <retroforge/objective/cell_statistics.h>
#include <retroforge/objective/filling.h>
#include <retroforge/objective/radius.h>
#include <retroforge/objective/shape_distance.h>
#include <retroforge/objective/unfilled_volume.h>
#include <retroforge/objective/volume.h>

#include "../geometry/geometry_test_tools.h"
#include "final_problem.h"

using namespace retroforge;

void check_volume_and_strain(Errors &errors)
{
  FinalProblem    problem(box(Vec3(), Vec3({2., 3., 4.}), 1.), {});
  VolumeObjective volume;
  const auto      strain = CellQuantity::strain;
  CellStatistics  mean(strain, CellStatistic::mean), variance(strain, CellStatistic::variance);
  CellStatistics  p_norm(strain, CellStatistic::largest, {SmoothMaximum::Kind::p_norm, 30.});
  CellStatistics  exponential(strain, CellStatistic::largest, {SmoothMaximum::Kind::log_sum_exp, 100.});
  errors.compare("volume", problem.value(volume), 24.);
  errors.compare("even strain, mean", problem.value(mean), 0.3);
  errors.compare("even strain, variance", problem.value(variance), 0.);
  errors.compare("even strain, p-norm", problem.value(p_norm), 0.3);
  errors.compare("even strain, log-sum-exp", problem.value(exponential), 0.3);
  double fraction = 0.;
  for (CellIndex c = 0; c < problem.scene.mesh.n_cells(); ++c)
  {
    problem.at.q[c] = c % 3 ? 0.2 : 0.7;
    fraction += c % 3 ? 0. : tet_volume(corners(problem.scene.mesh.cells[c], problem.at.X)) / 24.;
  }
  errors.compare("two strains, mean", problem.value(mean), 0.2 + 0.5 * fraction);
  errors.compare("two strains, variance", problem.value(variance), 0.25 * fraction * (1. - fraction));
  errors.compare("two strains, p-norm",
                 problem.value(p_norm),
                 std::pow(fraction * std::pow(0.7, 30.) + (1. - fraction) * std::pow(0.2, 30.), 1. / 30.));
  errors.compare("two strains, log-sum-exp",
                 problem.value(exponential),
                 std::log(fraction * std::exp(70.) + (1. - fraction) * std::exp(20.)) / 100.);
  errors.compare("two strains, true maximum", problem.detail(exponential, "true maximum"), 0.7);
  const CellStatistics mean_damage(CellQuantity::damage, CellStatistic::mean),
    damage(CellQuantity::damage, CellStatistic::largest, {SmoothMaximum::Kind::p_norm, 30.});
  problem.at.damage = problem.at.q;
  errors.compare("two damages, mean", problem.value(mean_damage), 0.2 + 0.5 * fraction);
  errors.compare("two damages, p-norm", problem.value(damage), problem.value(p_norm));
  errors.compare("two damages, true maximum", problem.detail(damage, "true maximum"), 0.7);
  std::fill(problem.at.damage.begin(), problem.at.damage.end(), 0.);
  errors.compare("no damage, p-norm", problem.value(damage), 0.);
  for (double &q : problem.at.q)
    q = 0.;
  errors.compare("no strain, p-norm", problem.value(p_norm), 0.);
  bool                 finite    = true;
  const FinalDecisions decisions = p_norm.decide(problem.view(problem.at));
  for (const double bar : problem.reverse(p_norm, decisions, problem.at).q)
    finite = finite && std::isfinite(bar);
  for (const double bar : problem.reverse(damage, damage.decide(problem.view(problem.at)), problem.at).damage)
    finite = finite && std::isfinite(bar);
  std::cout << "  no strain, derivatives finite: " << yes(finite) << std::endl;
}

void check_shapes(Errors &errors)
{
  const double d = 0.07;
  FinalProblem problem(box(Vec3({0.5, 0.5, 0.}), Vec3({1., 1., 1.}), 0.4), {});
  const auto   larger = scaled(cube(), 1. + 2. * d, Vec3({-d, -d, -d}));
  for (const double rounding : {0., 0.02})
  {
    FillingObjective filling{TargetSurface(larger), rounding};
    const auto       sums = problem.integrals(filling);
    const auto rounded    = [&](const double x) { return std::sqrt(x * x + rounding * rounding) - rounding; };
    errors.compare("workpiece to target", sums[0], 6. * rounded(d));
    errors.compare(
      "target to workpiece", sums[1], rounded(std::sqrt(3.) * d) * 6. * (1. + 2. * d) * (1. + 2. * d));
  }
  ShapeDistance    distance{TargetSurface(larger)};
  FillingObjective full{TargetSurface(scaled(cube(), 1., Vec3()))};
  ShapeDistance    same{TargetSurface(scaled(cube(), 1., Vec3()))};
  errors.compare("mean square distance", problem.value(distance), d * d);
  errors.compare("filled", problem.value(full), 0.);
  errors.compare("same shape", problem.value(same), 0.);
}

/// A sheet 0.1 below a box, and half of the box: the projection of the sheet is 0.1 times its area, and half
/// of that, as only the half of the sheet counts that faces the half of the box.
void check_filling_of_half(Errors &errors)
{
  const auto   flat = scaled(sheet(8, [](double, double) { return 0.; }), 1., Vec3());
  const Vec3   size({2.4, 2.4, 1.}), base({0., 0., 0.1});
  FinalProblem whole(box(base, size, 0.5), {}), half(box(base, size, 0.5, true), {});
  for (FinalProblem *problem : {&whole, &half})
  {
    FillingObjective filling{TargetSurface(flat, 0)};
    const double     all = problem == &whole ? 4. : 2.;
    errors.compare("sheet to a box", problem->integrals(filling)[1], 0.1 * all);
  }
}

/// A cube on a plane, within a target larger by d all round: what of its surface belongs to nodes above the
/// plane counts, or also half of the rest, where the plane is half of the ramp below the cube.
void check_filling_of_free_nodes(Errors &errors)
{
  const double d = 0.07, width = 0.02;
  const auto   larger = scaled(cube(), 1. + 2. * d, Vec3({-d, -d, -d}));
  FinalProblem problem(box(Vec3({0.5, 0.5, 0.}), Vec3({1., 1., 1.}), 0.4), {});
  double       above = 0.;
  for (const auto &nodes : surface_triangles(problem.scene.mesh))
  {
    const auto  &X    = problem.at.X;
    const double area = 0.5 * cross(X[nodes[1]] - X[nodes[0]], X[nodes[2]] - X[nodes[0]]).norm();
    for (const NodeIndex k : nodes)
      above += X[k][2] > 0. ? area / 3. : 0.;
  }
  for (const double part : {0., 0.5, 1.})
  {
    problem.at.dies[0].displacement = Vec3({0., 0., -part * width});
    FillingObjective filling(TargetSurface(larger), 0., FreeNodes(FrictionRamp{width, false}));
    errors.compare(
      "cube on a plane, free nodes", problem.integrals(filling)[0], d * (above + part * (6. - above)));
  }
}

void check_cylinder(Errors &errors)
{
  BilletParameters parameters;
  parameters.shape        = BilletParameters::Shape::cylinder;
  parameters.radius       = 5.;
  parameters.height       = 8.;
  parameters.element_size = 3.;
  FinalProblem    problem(make_billet(parameters, MPI_COMM_WORLD), {});
  RadiusObjective distance(RadiusStatistic::variance, {"side"}, Vec3({0., 0., 3.}), Vec3({0., 0., 2.}));
  for (Vec3 &x : problem.at.X)
    x = Vec3({1.2 * x[0], 1.2 * x[1], x[2]});
  errors.compare("cylinder", problem.value(distance), 0.);
  errors.compare("radius", problem.detail(distance, "radius [mm]"), 6.);
  const double change = 0.1;
  for (Vec3 &x : problem.at.X)
    x *= 1. + change;
  errors.compare("larger cylinder", problem.value(distance), 0.);
  errors.compare("larger radius", problem.detail(distance, "radius [mm]"), 6.6);
  RadiusObjective mean(RadiusStatistic::mean, {"side"}, Vec3({0., 0., 3.}), Vec3({0., 0., 2.}));
  errors.compare("its mean radius", problem.value(mean), 6.6);
}

double check_all_derivatives()
{
  Random     random;
  double     worst = 0.;
  const auto check =
    [&](const std::string &name, const FinalObjective &objective, const FinalProblem &problem) {
      const auto decisions = objective.decide(problem.view(problem.at));
      const auto evaluate  = [&](const auto &inputs) { return problem.value(objective, decisions, inputs); };
      const auto reverse = [&](const auto &inputs) { return problem.reverse(objective, decisions, inputs); };
      worst              = std::max(
        worst,
        check_derivatives<FinalInputs>(name, problem.at, evaluate, reverse, problem.dual_shape(), random));
    };
  const auto shake = [&](FinalProblem &problem) {
    for (Vec3 &x : problem.at.X)
      x += 0.03 * random.vector();
    for (double &q : problem.at.q)
      q = 0.5 + 0.4 * random.scalar();
  };
  const auto wave = [](const double x, const double y) {
    return 0.1 + 0.1 * std::sin(4. * x) * std::cos(3. * y);
  };
  const auto die   = scaled(sheet(9, wave), 1.5, Vec3());
  const auto bumpy = scaled(bumpy_sphere(2), 1.1, Vec3());

  FinalProblem under_die(box(Vec3({0., 0., 0.2}), Vec3({1.6, 1.4, 1.}), 0.4, true), die->vertices());
  FinalProblem inside(box(Vec3({0., 0., -0.6}), Vec3({1.2, 1.2, 1.2}), 0.4), bumpy->vertices());
  shake(under_die);
  shake(inside);
  under_die.at.dies[0].displacement = Vec3({0.02, -0.01, -0.05});

  VolumeObjective  volume;
  const auto       strain = CellQuantity::strain;
  CellStatistics   mean(strain, CellStatistic::mean), variance(strain, CellStatistic::variance);
  CellStatistics   p_norm(strain, CellStatistic::largest, {SmoothMaximum::Kind::p_norm, 15.});
  CellStatistics   exponential(strain, CellStatistic::largest, {SmoothMaximum::Kind::log_sum_exp, 30.});
  const Box        low(Vec3({-1., -1., -1.}), Vec3({1., 1., 0.6}));
  FillingObjective die_filling(TargetSurface(die, 0, low)), closed_filling{TargetSurface(bumpy), 1e-2};
  ShapeDistance    die_distance(TargetSurface(die, 0, low)), closed_distance{TargetSurface(bumpy)};
  UnfilledVolume   die_unfilled(Die("die", *die, 0.3), 0, low), closed_unfilled{TargetSurface(bumpy)};
  const std::vector<std::string> sides = {"side +x", "side +y"};
  const Vec3                     foot({-3., 0., 0.}), axis({0.1, 0.2, 1.});
  RadiusObjective                side(RadiusStatistic::variance, sides, foot, axis);
  RadiusObjective                bore(RadiusStatistic::mean, sides, foot, axis);
  check("volume", volume, inside);
  check("mean strain", mean, inside);
  check("variance of the strain", variance, inside);
  check("maximum strain, p-norm", p_norm, inside);
  check("maximum strain, log-sum-exp", exponential, inside);
  check("filling of a die", die_filling, under_die);
  check("filling of a closed shape, rounded", closed_filling, inside);
  FinalProblem between(box(Vec3({0., 0., 0.2}), Vec3({1.6, 1.4, 1.}), 0.4, true),
                       die->vertices(),
                       {Die("lower", *die, 2.), Die("side", Vec3({0.75, 0., 0.}), Vec3({-1., 0., 0.1}))});
  shake(between);
  between.at.dies[0].displacement = Vec3({0.02, -0.01, -0.05});
  FillingObjective of_free(TargetSurface(die, 0, low), 0., FreeNodes(FrictionRamp{0.3, false}));
  check("filling of a die, free nodes", of_free, between);
  std::cout << "  some of them touch, some in part: " << [&] {
    const FreeNodes free(FrictionRamp{0.3, false});
    const auto      view  = between.view(between.at);
    unsigned int    touch = 0, in_part = 0;
    for (const double part : free.parts(view, free.decide(view)))
      (part == 0. ? touch : in_part) += part < 1. ? 1 : 0;
    return yes(touch > 3 && in_part > 3);
  }() << std::endl;
  check("unfilled volume before a die", die_unfilled, under_die);
  check("unfilled volume of a closed shape", closed_unfilled, inside);
  check("distance from a die", die_distance, under_die);
  check("distance from a closed shape", closed_distance, inside);
  check("distance from a cylinder", side, inside);
  check("mean radius", bore, inside);
  for (const double q : inside.at.q)
    inside.at.damage.push_back(1.1 - q);
  check("mean damage", CellStatistics(CellQuantity::damage, CellStatistic::mean), inside);
  check("largest damage, p-norm",
        CellStatistics(CellQuantity::damage, CellStatistic::largest, {SmoothMaximum::Kind::p_norm, 15.}),
        inside);
  const auto   decided  = closed_filling.compute_decisions(inside.view(inside.at));
  unsigned int on_edges = 0;
  for (const auto *features : {&decided.by_workpiece, &decided.by_target})
    for (const SeenFeature &seen : *features)
      on_edges += seen.feature.kind > 0;
  std::cout << "  faces, edges and vertices seen: "
            << yes(on_edges > 10 && on_edges + 10 < decided.by_workpiece.size() + decided.by_target.size())
            << std::endl;
  return worst;
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) > 0)
    std::cout.setstate(std::ios::failbit);
  Errors errors;
  std::cout << "by hand" << std::endl;
  check_volume_and_strain(errors);
  check_shapes(errors);
  check_filling_of_half(errors);
  check_filling_of_free_nodes(errors);
  check_cylinder(errors);
  errors.print(1e-12);
  std::cout << "derivatives" << std::endl;
  const double worst = check_all_derivatives();
  std::cout << "refused" << std::endl;
  refused([] {
    CellStatistics(CellQuantity::strain, CellStatistic::largest, {SmoothMaximum::Kind::p_norm, 0.5});
  });
  refused([] {
    CellStatistics(CellQuantity::damage, CellStatistic::largest, {SmoothMaximum::Kind::p_norm, 0.5});
  });
  refused([] { FillingObjective{TargetSurface(scaled(cube(), 1., Vec3())), -1.}; });
  refused([] {
    const auto open = scaled(sheet(2, [](double, double) { return 0.; }), 1., Vec3());
    UnfilledVolume{TargetSurface(open)};
  });
  refused([] { RadiusObjective(RadiusStatistic::mean, {}, Vec3(), Vec3({0., 0., 1.})); });
  refused([] { RadiusObjective(RadiusStatistic::mean, {"side"}, Vec3(), Vec3()); });
  std::cout << "FIGURE final_objective_derivative_error " << worst << std::endl;
}
