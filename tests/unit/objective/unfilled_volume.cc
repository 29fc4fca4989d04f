// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The unfilled volume against closed forms, to rounding where all is flat.
// - Within a shape: a cube of edge 1.5 around one of edge 1 leaves 2.375, half of that where a symmetry plane
//   halves the scene, by the shape's region or by the sector; turned about three axes, the same. What is
//   outside does not count: a unit cube turned by 45 degrees about the other's axis has 2 (sqrt(2) - 1) of
//   its volume in it.
// - Before a die: a box 0.3 above a sheet leaves 0.3 times the region's base; the nearer the die, the less;
//   pushed into the die, nothing.
// - In a pocket of 2 x 2 x 1 in a flat face, which begins a thousandth of its depth behind the face, a box of
//   1.6 x 1.6 whose oblique top has the mean height 0.5 leaves 4 (1 - 0.001) - 2.56 (0.5 - 0.001). So does
//   half of it behind a symmetry plane, and what all of it leaves follows the die.
// - A cylinder meshed with 16 edges around fills a round pocket of its size: chords leave 2 % of it empty,
//   which must not count; nor must what they cut off beside a cylinder that reaches through 5/8 of it, or
//   less than a gap of 1/100 of its radius all round.
// - Derivatives against dual numbers, each input alone, and the Taylor order: metal in a round pocket, at
//   rest on its wall, in it, and apart from it; a box under a wavy die; and a box cut by a shape.

#include <deal.II/base/mpi.h>

#include <retroforge/core/error.h>
#include <retroforge/objective/unfilled_volume.h>

#include "../geometry/geometry_test_tools.h"
#include "final_problem.h"

using namespace retroforge;

/// A pocket in a flat face at z = 0 that faces down, round its axis in n sides, drawn as make_die.py does.
TriangleSurface pocket(const unsigned int n,
                       const double       radius,
                       const double       depth,
                       const double       outer,
                       const double       first = 0.5)
{
  const std::vector<std::array<double, 2>> rings = {{{radius, depth}}, {{radius, 0.}}, {{outer, 0.}}};
  NodalVectors<double>                     x     = {Vec3({0., 0., depth})};
  for (const auto &[r, z] : rings)
    for (unsigned int k = 0; k < n; ++k)
    {
      const double angle = 2. * dealii::numbers::PI * (k + first) / n;
      x.push_back(Vec3({r * std::cos(angle), r * std::sin(angle), z}));
    }
  std::vector<Triangle> triangles;
  for (unsigned int k = 0; k < n; ++k)
  {
    const unsigned int next = (k + 1) % n;
    triangles.push_back({{0, 1 + next, 1 + k}});
    for (unsigned int ring = 1; ring < rings.size(); ++ring)
    {
      const unsigned int inner = 1 + (ring - 1) * n, outer_ring = inner + n;
      triangles.push_back({{inner + k, outer_ring + next, outer_ring + k}});
      triangles.push_back({{inner + k, inner + next, outer_ring + next}});
    }
  }
  return TriangleSurface("pocket", x, triangles);
}

TetMesh
cylinder(const double radius, const double height, const double element_size, const double sector = 0.)
{
  BilletParameters parameters;
  parameters.shape        = BilletParameters::Shape::cylinder;
  parameters.radius       = radius;
  parameters.height       = height;
  parameters.element_size = element_size;
  parameters.sector_angle = sector;
  return make_billet(parameters, MPI_COMM_WORLD);
}

/// Turned about the three axes one after the other, by 0.3, 0.5 and 0.7.
Vec3 turned(Vec3 x)
{
  for (unsigned int i = 0; i < 3; ++i)
  {
    const double       c = std::cos(0.3 + 0.2 * i), s = std::sin(0.3 + 0.2 * i);
    const unsigned int j = (i + 1) % 3, k = (i + 2) % 3;
    const double       a = c * x[j] - s * x[k], b = s * x[j] + c * x[k];
    x[j] = a;
    x[k] = b;
  }
  return x;
}

void check_within(Errors &errors)
{
  const Vec3     base({0.5, 0.5, 0.}), size({1., 1., 1.});
  FinalProblem   problem(box(base, size, 0.5), {});
  auto           larger = scaled(cube(), 1.5, Vec3({-0.25, -0.25, -0.25}));
  UnfilledVolume unfilled{TargetSurface(larger)};
  errors.compare("cube in a cube", problem.value(unfilled), 2.375);
  errors.compare("of the cavity", problem.detail(unfilled, "of the cavity [%]"), 100. * 2.375 / 3.375);
  NodalVectors<double> x = larger->vertices();
  for (Vec3 &vertex : x)
    vertex = turned(vertex);
  for (Vec3 &node : problem.at.X)
    node = turned(node);
  larger->move_vertices(x);
  UnfilledVolume of_turned{TargetSurface(larger)};
  errors.compare("both turned", problem.value(of_turned), 2.375);

  const Box      half_space(Vec3({0., -2., -2.}), Vec3({2., 2., 2.}));
  FinalProblem   half(box(Vec3({0., 0., -0.5}), size, 0.5, true), {});
  const auto     centred = scaled(cube(), 1.5, Vec3({-0.75, -0.75, -0.75}));
  UnfilledVolume of_half(TargetSurface(centred, invalid_index, half_space));
  UnfilledVolume of_sector{TargetSurface(centred)};
  errors.compare("half by its region", half.value(of_half), 0.5 * 2.375);
  errors.compare("half by its sector", half.value(of_sector), 0.5 * 2.375);

  // Below and above the box's ends, so that only the sides meet.
  FinalProblem         whole(box(Vec3({0., 0., -0.5}), size, 0.5), {});
  NodalVectors<double> crossed = scaled(cube(), 1., Vec3({-0.5, -0.5, -0.5}))->vertices();
  for (Vec3 &vertex : crossed)
    vertex = Vec3(
      {(vertex[0] - vertex[1]) / std::sqrt(2.), (vertex[0] + vertex[1]) / std::sqrt(2.), 0.6 * vertex[2]});
  UnfilledVolume star{TargetSurface(std::make_shared<TriangleSurface>("star", crossed, cube().triangles()))};
  errors.compare("crossed cubes", whole.value(star), 0.6 * (1. - 2. * (std::sqrt(2.) - 1.)));
}

void check_before_die(Errors &errors)
{
  const auto     flat = scaled(sheet(4, [](double, double) { return 0.; }), 2., Vec3());
  const Box      base(Vec3({-0.4, -0.4, -0.5}), Vec3({0.4, 0.4, 0.5}));
  FinalProblem   lifted(box(Vec3({0., 0., 0.3}), Vec3({1.6, 1.6, 1.}), 0.5), {});
  UnfilledVolume above(Die("flat", *flat, 0.3), 0, base);
  errors.compare("above a die", lifted.value(above), 0.3 * 0.64);
  lifted.at.dies[0].displacement = Vec3({0., 0., 0.1});
  errors.compare("nearer to it", lifted.value(above), 0.2 * 0.64);
  lifted.at.dies[0].displacement = Vec3({0., 0., 0.35});
  errors.compare("pushed into it", lifted.value(above), 0.);
}

void check_pocket(Errors &errors)
{
  const Die      square("square", pocket(4, std::sqrt(2.), 1., 5.), 0.3);
  UnfilledVolume unfilled(square, 0);
  const auto     make_oblique = [](FinalProblem &problem) {
    for (Vec3 &x : problem.at.X)
      x[2] += 0.2 * x[0];
  };
  const Vec3   foot({0., 0., -1.}), size({1.6, 1.6, 1.5});
  FinalProblem problem(box(foot, size, 0.5), {}), half(box(foot, size, 0.5, true), {});
  make_oblique(problem);
  make_oblique(half);
  errors.compare("pocket", problem.value(unfilled), 3.996 - 2.56 * 0.499);
  errors.compare("of the pocket", problem.detail(unfilled, "of the cavity [%]"), 100. - 2.56 * 49.9 / 3.996);
  problem.at.dies[0].displacement = Vec3({0.05, 0.05, -0.1});
  errors.compare("pocket pushed down", problem.value(unfilled), 3.996 - 2.56 * 0.599);
  errors.compare("half of the pocket", half.value(unfilled), 1.998 - 1.28 * (0.499 + 0.08));
  // The same from a box of the user, which stands still.
  UnfilledVolume in_box(square, 0, Box(Vec3({-1.2, -1.2, 0.001}), Vec3({1.2, 1.2, 1.2})));
  half.at.dies[0].displacement = Vec3({0., 0., 0.1});
  errors.compare(
    "half of the pocket in a box", half.value(in_box), 2. * 1.099 + 0.88 * 0.099 - 1.28 * (0.499 + 0.08));
}

void check_round()
{
  const double   radius = 5., height = 8., cavity = dealii::numbers::PI * radius * radius * height * 0.999;
  const Die      round("round", pocket(48, radius, height, 15.), 0.5);
  UnfilledVolume unfilled(round, 0);
  const auto     told = [&](const std::string &what, const double off) {
    std::cout << "  " << what << ", of the cavity < 1e-3: "
              << (std::abs(off) < 1e-3 ? std::string("yes") : "NO, " + std::to_string(off)) << std::endl;
  };
  FinalProblem full(cylinder(radius, height, 2.), {});
  const auto   b = full.integrals(unfilled);
  told("round pocket, volume", b[0] / cavity - 1.);
  told("round pocket, full", full.value(unfilled) / cavity);
  std::cout << "  of it between chords and wall, 1.5 to 3 %: "
            << yes(b[2] / b[0] > 0.015 && b[2] / b[0] < 0.03) << std::endl;
  FinalProblem part(cylinder(radius, 0.625 * height, 2.), {});
  told("round pocket, in part", part.value(unfilled) / cavity - 0.375 / 0.999);
  FinalProblem thin(cylinder(0.99 * radius, height, 2.), {});
  told("round pocket, gap all round", thin.value(unfilled) / cavity - (1. - 0.99 * 0.99));
}

/// A derivative along a random direction: the sum of its parts, one for each number, and the size that such a
/// sum of parts of either sign has. The sum itself may come out small by chance; errors are measured by the size.
struct RandomSum
{
  double value = 0., squares = 0.;

  void add(const double part)
  {
    value += part;
    squares += part * part;
  }

  void compare(const std::string &name, const double tangent, const double difference) const
  {
    const double size = std::sqrt(squares);
    Errors       tangents, differences;
    tangents.compare(name + ", tangent", 1. + (tangent - value) / size, 1.);
    differences.compare(name + ", difference", 1. + (difference - value) / size, 1.);
    tangents.print(1e-12);
    differences.print(1e-6);
  }
};

/// Facets at rest begin to count within a thousandth of their size: steps of a Taylor series would have to be
/// smaller than it. So differences, of steps that small.
void check_at_rest(const FinalObjective &objective, const FinalProblem &problem, Random &random)
{
  const auto          decisions = objective.decide(problem.view(problem.at));
  FinalInputs<double> bar = problem.reverse(objective, decisions, problem.at), plus = problem.at,
                      minus = plus;
  FinalInputs<Dual> dual    = problem.dual_shape();
  const auto        groups = bar.groups(), up = plus.groups(), down = minus.groups();
  const auto        duals = dual.groups();
  const double      h     = 1e-7;
  RandomSum         along;
  for (std::size_t g = 0; g < groups.size(); ++g)
    for (std::size_t i = 0; i < groups[g].second.size(); ++i)
    {
      const double direction              = random.scalar();
      *duals[g].second[i]                 = Dual(*up[g].second[i]);
      duals[g].second[i]->fastAccessDx(0) = direction;
      *up[g].second[i] += h * direction;
      *down[g].second[i] -= h * direction;
      along.add(direction * *groups[g].second[i]);
    }
  const double difference =
    (problem.value(objective, decisions, plus) - problem.value(objective, decisions, minus)) / (2. * h);
  along.compare("at rest on a round wall", problem.value(objective, decisions, dual).dx(0), difference);
}

/// Nodes of symmetry planes stay in them, by a motion along the radius; vertices of the die move as they like.
void check_in_sector(const FinalObjective &objective, const FinalProblem &problem, Random &random)
{
  const auto                decisions = objective.decide(problem.view(problem.at));
  const FinalInputs<double> bar       = problem.reverse(objective, decisions, problem.at);
  FinalInputs<Dual>         dual      = problem.dual_shape();
  convert(problem.at.X, dual.X);
  convert(problem.at.q, dual.q);
  convert(problem.at.dies, dual.dies);
  convert(problem.at.target, dual.target);
  FinalInputs<double> plus = problem.at, minus = problem.at;
  const double        h = 1e-6;
  RandomSum           along;
  for (std::size_t k = 0; k < dual.X.size(); ++k)
  {
    const double part = random.scalar();
    const Vec3   x_dot({part * problem.at.X[k][0], part * problem.at.X[k][1], random.scalar()});
    for (unsigned int i = 0; i < 3; ++i)
      dual.X[k][i].fastAccessDx(0) = x_dot[i];
    plus.X[k] += h * x_dot;
    minus.X[k] -= h * x_dot;
    along.add(x_dot * bar.X[k]);
  }
  for (std::size_t v = 0; v < dual.target.size(); ++v)
  {
    const Vec3 x_dot = random.vector();
    for (unsigned int i = 0; i < 3; ++i)
      dual.target[v][i].fastAccessDx(0) = x_dot[i];
    plus.target[v] += h * x_dot;
    minus.target[v] -= h * x_dot;
    along.add(x_dot * bar.target[v]);
  }
  const double difference =
    (problem.value(objective, decisions, plus) - problem.value(objective, decisions, minus)) / (2. * h);
  along.compare("sector of 60 degrees", problem.value(objective, decisions, dual).dx(0), difference);
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
  const auto shake = [&](FinalProblem &problem, const double by) {
    for (Vec3 &x : problem.at.X)
      x += by * random.vector();
  };
  const auto wave = [](const double x, const double y) {
    return 0.1 + 0.1 * std::sin(4. * x) * std::cos(3. * y);
  };
  const auto     round = std::make_shared<TriangleSurface>(pocket(12, 1., 1.2, 2.));
  FinalProblem   apart(cylinder(0.92, 1., 0.4), round->vertices());
  FinalProblem   pressed(cylinder(1.07, 1., 0.4), round->vertices());
  FinalProblem   at_wall(cylinder(1., 1., 0.4), round->vertices());
  UnfilledVolume in_pocket(Die("round", *round, 0.3), 0);
  UnfilledVolume boxed(Die("round", *round, 0.3), 0, Box(Vec3({-0.7, -1.1, 0.1}), Vec3({1.3, 0.9, 1.3})));
  shake(at_wall, 0.03);
  for (FinalProblem *problem : {&apart, &pressed})
  {
    shake(*problem, 0.005);
    problem->at.dies[0].displacement = Vec3({0.02, -0.01, -0.15});
  }
  check("apart from a round wall", in_pocket, apart);
  check("the same in a box", boxed, apart);
  FinalProblem sector(cylinder(0.92, 1., 0.4, 60.), round->vertices());
  sector.at.dies[0].displacement = Vec3({0., 0., -0.15});
  check_in_sector(in_pocket, sector, random);
  // Edges of the die in the symmetry planes.
  const auto   from_plane = std::make_shared<TriangleSurface>(pocket(12, 1., 1.2, 2., 0.));
  FinalProblem at_edges(cylinder(0.92, 1., 0.4, 60.), from_plane->vertices());
  at_edges.at.dies[0].displacement = Vec3({0., 0., -0.15});
  check_in_sector(UnfilledVolume(Die("round", *from_plane, 0.3), 0), at_edges, random);
  check("pressed into a round wall", in_pocket, pressed);
  check_at_rest(in_pocket, at_wall, random);

  const auto     die   = scaled(sheet(9, wave), 1.5, Vec3());
  const auto     bumpy = scaled(bumpy_sphere(2), 1.1, Vec3());
  FinalProblem   under_die(box(Vec3({0., 0., 0.2}), Vec3({1.6, 1.4, 1.}), 0.4, true), die->vertices());
  FinalProblem   inside(box(Vec3({0., 0., -0.6}), Vec3({1.2, 1.2, 1.2}), 0.4), bumpy->vertices());
  const Box      low(Vec3({-1., -1., -1.}), Vec3({1., 1., 0.6}));
  UnfilledVolume on_facets(Die("die", *die, 0.3, {false}), 0, low), shape{TargetSurface(bumpy)};
  shake(under_die, 0.03);
  shake(inside, 0.03);
  under_die.at.dies[0].displacement = Vec3({0.02, -0.01, -0.05});
  check("before facets", on_facets, under_die);
  check("within a shape", shape, inside);
  // Some of what is differentiated, so that none of it is missing unseen.
  const auto   seen = at_wall.view(at_wall.at);
  const auto   b    = in_pocket.compute_integrals(seen, in_pocket.compute_decisions(seen));
  unsigned int cut  = 0;
  for (const auto &cell : shape.compute_decisions(inside.view(inside.at)).cells)
    cut += !cell.facets.empty();
  std::cout << "  chords count, cells are cut: " << yes(std::abs(b[2]) > 1e-3 * b[0] && cut > 10)
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
  check_within(errors);
  check_before_die(errors);
  check_pocket(errors);
  errors.print(1e-12);
  check_round();
  std::cout << "derivatives" << std::endl;
  const double worst = check_all_derivatives();
  std::cout << "refused" << std::endl;
  refused(
    [] { UnfilledVolume{TargetSurface(scaled(sheet(2, [](double, double) { return 0.; }), 1., Vec3()))}; });
  const auto value = [](const Box &region, const double shift) {
    const auto   flat = scaled(sheet(4, [](double, double) { return 0.; }), 2., Vec3());
    FinalProblem half(box(Vec3({0., 0., 0.3}), Vec3({1.6, 1.6, 1.}), 0.5, true), {});
    half.at.dies[0].displacement[0] = shift;
    half.value(UnfilledVolume(Die("flat", *flat, 0.3), 0, region));
  };
  refused([&] { value(Box(Vec3({-2., -1., -1.}), Vec3({-1., 1., 1.})), 0.); });
  refused([&] { value(Box(Vec3({1., -1., -2.}), Vec3({2., 1., -1.})), -9.); });
  std::cout << "FIGURE unfilled_volume_derivative_error " << worst << std::endl;
}
