// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Free form of a die: in a square region of a flat die the first mode is a product of sines, which is known,
// and nothing moves outside; modes are orthogonal in the Sobolev metric and measure the area there, by an
// assembly of its own; vertices of a bell move along its facing, mirror images alike, also on triangles that
// are no mirror images, and with many mirrors a die of revolution stays one; along the normals vertices of
// mirrors stay on them; forward is the transpose of reverse; what cannot be is refused.

#include <retroforge/core/error.h>
#include <retroforge/design/die_free_form.h>
#include <retroforge/design/surface_modes.h>
#include <retroforge/geometry/stl_file.h>

#include "../geometry/geometry_test_tools.h"

#include <iostream>
#include <random>

using namespace retroforge;

namespace
{
  constexpr double pi = dealii::numbers::PI;

  const std::vector<Plane> quarter = {{Vec3(), Vec3({-1., 0., 0.})}, {Vec3(), Vec3({0., -1., 0.})}};

  /// A flat die of 30 x 30 mm whose facing is +z, its vertices 1.25 mm apart; or displaced in the plane.
  DieParameters plate(const double displaced)
  {
    const TriangleSurface flat = sheet(24, [](double, double) { return 0.; });
    NodalVectors<double>  x    = flat.vertices();
    for (unsigned int k = 0; k < x.size(); ++k)
      if (!flat.on_rim(k))
        x[k] += displaced * Vec3({std::sin(7. * k), std::cos(5. * k), 0.});
    const std::string file = displaced > 0. ? "displaced.stl" : "plate.stl";
    write_stl(file, TriangleSurface("plate", x, flat.triangles()), StlFormat::ascii);
    DieParameters die("plate");
    auto         &stl = die.shape.choose<StlDie>();
    stl.file          = file;
    stl.scale         = 15.;
    die.facing        = Vec3({0., 0., 1.});
    return die;
  }

  /// An upper die that goes down.
  DieParameters bell()
  {
    DieParameters die("bell");
    auto         &shape = die.shape.choose<BellDie>();
    shape.chord_error   = 0.3;
    shape.shape         = {{}, 12., 20., {5., 20., 2., 3.}};
    die.point           = Vec3({0., 0., 30.});
    die.facing          = Vec3({0., 0., -1.});
    die.velocity        = Vec3({0., 0., -100.});
    return die;
  }

  DieFreeFormParameters &form_of(DieParameters &die, const unsigned int modes)
  {
    auto &form = const_cast<DieFreeFormParameters &>(*die.shape->free_form());
    form.modes = modes;
    return form;
  }

  void sines()
  {
    DieParameters die  = plate(0.);
    auto         &form = form_of(die, 1);
    form.length        = 5.;
    form.from          = Vec3({-10.1, -10.1, -1.});
    form.to            = Vec3({10.1, 10.1, 1.});
    const DieFreeForm made(die, {});
    // Held are vertices 11.25 mm from the middle and beyond; 17^2 are not.
    const double side = 22.5, lambda = 2. * std::pow(pi / side, 2), part = std::pow(17. * 1.25 / side, 2);
    double       off = 0., outside = 0.;
    for (unsigned int k = 0; k < made.vertices().size(); ++k)
    {
      const Vec3  &x = made.vertices()[k], &move = made.move(0)[k];
      const bool   is_in = std::max(std::abs(x[0]), std::abs(x[1])) < 0.5 * side;
      const double exact =
        2. * std::sqrt(part / (1. + 25. * lambda)) * std::cos(pi * x[0] / side) * std::cos(pi * x[1] / side);
      (is_in ? off : outside) =
        std::max(is_in ? off : outside, (move - Vec3({0., 0., is_in ? exact : 0.})).norm());
    }
    std::cout << "square region of a plate: off the sines by less than 0.01: " << yes(off < 0.01)
              << "; still outside: " << yes(outside == 0.) << "\n";
  }

  /// Integral of grad u · grad v.
  double stiffness(const MovingSurface &surface, const std::vector<double> &u, const std::vector<double> &v)
  {
    double sum = 0.;
    for (const Triangle &t : surface.triangles)
    {
      const Vec3 n = facet_vector(surface.points[t[0]], surface.points[t[1]], surface.points[t[2]]);
      Vec3       grad_u, grad_v;
      for (unsigned int i = 0; i < 3; ++i)
      {
        const Vec3 edge = surface.points[t[(i + 2) % 3]] - surface.points[t[(i + 1) % 3]];
        const Vec3 hat  = cross_product_3d(n, edge) / n.norm_square();
        grad_u += u[t[i]] * hat;
        grad_v += v[t[i]] * hat;
      }
      sum += 0.5 * n.norm() * (grad_u * grad_v);
    }
    return sum;
  }

  void orthogonal()
  {
    const TriangleSurface surface = bumpy_sphere(3);
    MovingSurface         moving{surface.vertices(), surface.triangles(), {}, {}};
    for (const Vec3 &x : moving.points)
      moving.held.push_back(x[2] > 0.6);
    const double                           l = 0.3, area = moving.area();
    const std::vector<std::vector<double>> modes = surface_modes(moving, 12, l);
    const std::vector<double>              mass  = moving.masses();
    double                                 error = 0.;
    for (unsigned int i = 0; i < modes.size(); ++i)
      for (unsigned int j = 0; j <= i; ++j)
      {
        double product = l * l * stiffness(moving, modes[i], modes[j]);
        for (unsigned int k = 0; k < mass.size(); ++k)
          product += mass[k] * modes[i][k] * modes[j][k];
        error = std::max(error, std::abs(product / area - (i == j ? 1. : 0.)));
      }
    std::cout
      << "modes of a bumpy surface, part of it held: phi_i^T (M + l^2 L) phi_j is the area or 0, to 1e-10: "
      << yes(error < 1e-10) << "\n";
  }

  /// Largest difference between the moves of a vertex and of its image, and how many have one.
  std::pair<double, unsigned int> mirror_defect(const DieFreeForm &form, const Vec3 &normal)
  {
    double       defect = 0.;
    unsigned int n      = 0;
    for (unsigned int a = 0; a < form.vertices().size(); ++a)
      for (unsigned int b = 0; b < form.vertices().size(); ++b)
      {
        const auto mirrored = [&](const Vec3 &x) { return x - 2. * (x * normal) * normal; };
        if ((mirrored(form.vertices()[a]) - form.vertices()[b]).norm() > 1e-9)
          continue;
        ++n;
        for (unsigned int i = 0; i < form.n_modes(); ++i)
          defect = std::max(defect, (mirrored(form.move(i)[a]) - form.move(i)[b]).norm());
      }
    return {defect, n};
  }

  bool are_on_one_circle(const Vec3 &a, const Vec3 &b)
  {
    return std::abs(a[2] - b[2]) + std::abs(std::hypot(a[0], a[1]) - std::hypot(b[0], b[1])) < 1e-9;
  }

  void mirrored()
  {
    DieParameters     die  = bell();
    auto             &form = form_of(die, 6);
    const DieFreeForm everywhere(die, quarter);
    double            constant = 0., across = 0.;
    for (unsigned int k = 0; k < everywhere.vertices().size(); ++k)
    {
      constant = std::max(constant, (everywhere.move(0)[k] - die.facing).norm());
      for (unsigned int i = 0; i < 6; ++i)
        across = std::max(across, std::hypot(everywhere.move(i)[k][0], everywhere.move(i)[k][1]));
    }
    std::cout << "bell: the first mode is its offset, to 1e-8: " << yes(constant < 1e-8)
              << "; all are along its facing: " << yes(across == 0.);
    form.from   = Vec3({0., 0., 20.});
    form.to     = Vec3({14., 14., 40.});
    using Along = DieFreeFormParameters::Along;
    for (const auto &[along, word] : {std::pair(Along::facing, "facing"), std::pair(Along::normal, "normal")})
    {
      form.along = along;
      const DieFreeForm made(die, quarter);
      bool              all    = true;
      double            defect = 0., off = 0.;
      for (const Plane &plane : quarter)
      {
        const auto [of_plane, n] = mirror_defect(made, plane.normal);
        all &= n == made.vertices().size();
        defect = std::max(defect, of_plane);
        for (unsigned int k = 0; k < made.vertices().size(); ++k)
          if (std::abs(made.vertices()[k] * plane.normal) < 1e-9)
            for (unsigned int i = 0; i < 6; ++i)
              off = std::max(off, std::abs(made.move(i)[k] * plane.normal));
      }
      std::cout << "\n  region in a quarter, along the " << word
                << ": mirror images alike, to 1e-8: " << yes(all && defect < 1e-8)
                << "; on the planes: " << yes(off < 1e-12);
    }
    form.along   = Along::facing;
    form.mirrors = 12;
    const DieFreeForm round(die, quarter);
    double            spread = 0.;
    for (unsigned int a = 0; a < round.vertices().size(); ++a)
      for (unsigned int b = 0; b < a; ++b)
        if (are_on_one_circle(round.vertices()[a], round.vertices()[b]))
          spread = std::max(spread, (round.move(1)[a] - round.move(1)[b]).norm());
    std::cout << "\n  with 12 mirrors: it stays a die of revolution, to 0.02: " << yes(spread < 0.02) << "\n";
  }

  /// Triangles that are no mirror images, and modes that are.
  void on_any_triangles()
  {
    DieParameters die = plate(0.02);
    form_of(die, 4);
    for (const bool with_planes : {true, false})
    {
      const DieFreeForm made(die, with_planes ? quarter : std::vector<Plane>());
      double            most = 0.;
      for (unsigned int i = 1; i < 4; ++i)
        for (unsigned int axis = 0; axis < 2; ++axis)
        {
          double moment = 0., all = 0.;
          for (unsigned int k = 0; k < made.vertices().size(); ++k)
          {
            moment += made.move(i)[k][2] * made.vertices()[k][axis];
            all += std::abs(made.move(i)[k][2] * made.vertices()[k][axis]);
          }
          most = std::max(most, std::abs(moment) / all);
        }
      std::cout << "displaced vertices, "
                << (with_planes ? "with planes: hardly antisymmetric: " : "without: they may be: ")
                << yes(with_planes ? most < 0.02 : most > 0.5) << "\n";
    }
  }

  void transposed()
  {
    DieParameters die     = bell();
    form_of(die, 6).along = DieFreeFormParameters::Along::normal;
    const DieFreeForm              form(die, quarter);
    std::mt19937                   generator(3);
    std::normal_distribution<>     normal;
    NodalVectors<double>           bar(form.vertices().size()), moved = form.vertices();
    std::map<unsigned int, double> mu;
    for (Vec3 &x : bar)
      for (unsigned int i = 0; i < 3; ++i)
        x[i] = normal(generator);
    double backward = 0., forward = 0., size = 0.;
    for (unsigned int i = 0; i < 6; ++i)
    {
      mu[i] = 0.1 * normal(generator);
      backward += mu[i] * form.reverse(i, bar);
    }
    form.forward(mu, moved);
    for (unsigned int k = 0; k < bar.size(); ++k)
    {
      forward += (moved[k] - form.vertices()[k]) * bar[k];
      size += (moved[k] - form.vertices()[k]).norm() * bar[k].norm();
    }
    NodalVectors<Dual>           dual;
    std::map<unsigned int, Dual> mu_dual = {{4, Dual(0.)}};
    mu_dual[4].fastAccessDx(0)           = 1.;
    convert(form.vertices(), dual);
    form.forward(mu_dual, dual);
    double off = 0.;
    for (unsigned int k = 0; k < bar.size(); ++k)
      for (unsigned int i = 0; i < 3; ++i)
        off = std::max(off, std::abs(dual[k][i].dx(0) - form.move(4)[k][i]));
    std::cout << "<A x, y> = <x, A^T y> to 1e-12: " << yes(std::abs(forward - backward) < 1e-12 * size)
              << "; dual numbers agree: " << yes(off < 1e-15) << "\n";
  }

  void refused(const DieParameters &die, const double coefficient = 0.)
  {
    try
    {
      DieParameters checked = die;
      checked.check();
      const DieFreeForm    form(checked, quarter);
      NodalVectors<double> x = form.vertices();
      form.forward<double>({{form.n_modes() - 1, coefficient}}, x);
      std::cout << "NOT REFUSED\n";
    }
    catch (const Error &error)
    {
      std::cout << error.what() << "\n";
    }
  }
} // namespace

int main()
{
  sines();
  orthogonal();
  mirrored();
  on_any_triangles();
  transposed();
  DieParameters die = plate(0.);
  form_of(die, 600);
  refused(die);
  auto &form = form_of(die, 2);
  form.from  = Vec3({40., 40., 0.});
  form.to    = Vec3({50., 50., 1.});
  refused(die);
  std::swap(form.from, form.to);
  refused(die);
  DieParameters round     = bell();
  form_of(round, 6).along = DieFreeFormParameters::Along::normal;
  refused(round, 100.);
  // A die that is a plane, whose section asks for modes.
  for (const auto &kind : round.shape.kinds())
    if (const DieFreeFormParameters *asked = kind->free_form(); asked && asked->modes > 0)
      try
      {
        asked->check("Die bell", "plane");
      }
      catch (const Error &error)
      {
        std::cout << error.what() << "\n";
      }
}
