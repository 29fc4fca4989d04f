// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Half a block between a wavy die and a tilted plane that comes down on it, with friction after Coulomb on
// both: it follows the pressure, so that its tangent takes the penalty of the normal into the rows along the
// die. Proved, on one rank and on two, for linear and for quadratic velocities:
// - the system is known to be unsymmetric, and symmetric again under Norton's law;
// - Newton's method reaches the equilibrium from rest, and friction slides and presses there;
// - with M the tangent at the solution, as solved for derivatives by Krylov's method and directly:
//    <y, M^-1 b> = <M^-T y, b>,  and M^-1 M w = w for a w that moves pressed nodes,
//   M w by dual numbers; the transposed system is as easy for Krylov's method, and its solution is a start
//   that leaves nothing to do.

#include <deal.II/base/mpi.h>

#include <retroforge/core/timer.h>
#include <retroforge/solver/newton.h>

#include "../contact/wavy_sheet.h"
#include "../element/element_test_tools.h"
#include "../mesh/block_mesh.h"
#include "methods.h"

using namespace retroforge;

namespace
{
  const char *yes(const bool condition)
  {
    return condition ? "yes" : "NO";
  }

  /// A block that is squeezed, with a plane of symmetry.
  struct Block
  {
    Scene                scene;
    NodalVectors<double> X;
    Physics<double>      physics;
    ContactSet<double>   contact;

    static std::vector<Die> make_dies(const double hills)
    {
      const Vec3 down({0.08, 0., -1.});
      return {Die("lower", wavy_sheet(hills), 2., {true, 40., 1.}),
              Die("upper", Vec3({0., 0., 5.8}), down / down.norm())};
    }

    Block(Random            &random,
          const double       rho,
          const double       hills,
          const ElementPair  pair,
          const std::string &law)
        : scene(half_box_mesh(Vec3({10., 8., 6.}), {{4, 6, 4}}), {pair}, make_dies(hills), MPI_COMM_WORLD)
        , X(scene.mesh.X)
    {
      for (Vec3 &x : X)
        x += 0.05 * random.vector();
      physics                  = {MaterialLaw<double>{1.3, 0.2, 0.05}, {rho, 0.1}, {{}, {}}};
      physics.dies[1].velocity = Vec3({0., 0.3, -2.});
      for (auto &die : physics.dies)
      {
        die.friction      = 0.25;
        die.interface_law = find_interface_law(law, "test");
        // Far away: near it the slope by the pressure is known to the square of the penalty times rounding only, and
        // dual numbers find gaps by another path.
        die.shear_limit = 1e3;
      }
      contact = contact_of(physics, X);
    }

    template <typename Number>
    ContactSet<Number> contact_of(const Physics<Number> &at, const NodalVectors<Number> &positions) const
    {
      const FrictionRamp ramp{0.5, false};
      return make_contact_set<Number>(scene.view(at.dies, positions),
                                      find_contact_pairs(scene.view(physics.dies, X), ramp, 0.8, true),
                                      {ramp, Number(0.4), 0.3, 0.3});
    }

    Equilibrium<double> stage() const { return {scene, physics, contact, X}; }

    /// Without what the plane of symmetry fixes.
    Field<double> random_field(Random &random) const
    {
      const auto   &spaces = scene.discretization;
      Field<double> w(spaces);
      for (unsigned int place = 0; place < spaces.velocity_nodes()->n_owned(); ++place)
      {
        Vec3 &v = w.V.at_place(place);
        v       = random.vector();
        if (place < spaces.condensed_nodes()->n_owned())
          for (const Vec3 &n : spaces.fixed_directions(place))
            v -= (v * n) * n;
      }
      for (unsigned int place = 0; place < spaces.pressure_nodes()->n_owned(); ++place)
        w.P.at_place(place) = random.scalar();
      w.update_ghosts();
      return w;
    }
  };

  struct Solver
  {
    LinearSolverParameters linear;
    NewtonParameters       parameters;
    Timings                timings;
    LinearSystem           system;
    Newton                 newton;

    Solver(const Scene &scene, const std::string &method)
        : system(scene, linear, timings), newton(scene, parameters, system)
    {
      linear.method         = method_of(method);
      linear.max_iterations = 2000;
      parameters.tolerance  = 1e-8;
    }
  };

  /// Of what ranks own.
  double dot(const Scene &scene, const Field<double> &a, const Field<double> &b)
  {
    const auto &spaces = scene.discretization;
    double      sum    = 0.;
    for (unsigned int place = 0; place < spaces.velocity_nodes()->n_owned(); ++place)
      sum += a.V.at_place(place) * b.V.at_place(place);
    for (unsigned int place = 0; place < spaces.pressure_nodes()->n_owned(); ++place)
      sum += a.P.at_place(place) * b.P.at_place(place);
    return spaces.sum(sum);
  }

  double norm(const Scene &scene, const Field<double> &a)
  {
    return std::sqrt(dot(scene, a, a));
  }

  /// The tangent times w, by dual numbers.
  Field<double>
  image(const Block &block, const Field<double> &W, const ActiveSet &active, const Field<double> &w)
  {
    const Physics<Dual> physics = converted<Dual>(block.physics);
    NodalVectors<Dual>  X;
    convert(block.X, X);
    const ContactSet<Dual>  contact = block.contact_of(physics, X);
    const Equilibrium<Dual> stage(block.scene, physics, contact, X);
    Field<Dual>             at(block.scene.discretization);
    Field<double>           derivative(block.scene.discretization);
    const auto              along = [](const double value, const double dot) {
      Dual x(1, value);
      x.fastAccessDx(0) = dot;
      return x;
    };
    for (unsigned int place = 0; place < at.V.size(); ++place)
      for (unsigned int i = 0; i < 3; ++i)
        at.V.at_place(place)[i] = along(W.V.at_place(place)[i], w.V.at_place(place)[i]);
    for (unsigned int place = 0; place < at.P.size(); ++place)
      at.P.at_place(place) = along(W.P.at_place(place), w.P.at_place(place));
    const Field<Dual> r = stage.residual(at, active);
    for (unsigned int place = 0; place < at.V.size(); ++place)
      for (unsigned int i = 0; i < 3; ++i)
        derivative.V.at_place(place)[i] = r.V.at_place(place)[i].dx(0);
    for (unsigned int place = 0; place < at.P.size(); ++place)
      derivative.P.at_place(place) = r.P.at_place(place).dx(0);
    return derivative;
  }

  struct Pressed
  {
    unsigned int pressed = 0, sliding = 0;
  };

  Pressed pressed_points(const Block &block, const Field<double> &W, const ActiveSet &active)
  {
    Pressed    found;
    const auto stage = block.stage();
    for (unsigned int p = 0; p < active.size(); ++p)
      if (const auto node = stage.contact_node(p, W, active); node.active && node.Sf > 0.)
      {
        ++found.pressed;
        found.sliding += slip(node).norm() > block.physics.contact.v0;
      }
    return found;
  }

  void check(const ElementPair pair, const double rho, const double hills, Errors &dual, Errors &solved)
  {
    Random            random;
    const Block       block(random, rho, hills, pair, "Coulomb");
    const Scene      &scene = block.scene;
    const std::string name  = std::string(pair == ElementPair::mini ? "linear" : "quadratic") + ", penalty " +
                             (rho > 1e3 ? "stiff" : "soft") + (hills > 0. ? ", wavy" : ", flat");
    Field<double>          W(scene.discretization);
    Solver                 solver(scene, "auto");
    const NewtonStatistics found  = solver.newton.solve(block.stage(), W, {});
    const ActiveSet        active = block.stage().decide_active(W);
    const Pressed          points = pressed_points(block, W, active);
    std::cout << name << ": solved: " << yes(found.residual <= solver.parameters.tolerance)
              << ", a potential: " << (block.stage().has_potential() ? "YES" : "none")
              << ", pressed with friction: " << yes(points.pressed > 5)
              << ", sliding faster than the regularisation: " << yes(points.sliding > 3) << "\n";
    const Field<double> w = block.random_field(random), b = image(block, W, active, w),
                        y = block.random_field(random);
    for (const std::string method : {"direct", "auto"})
    {
      Solver        linear(scene, method);
      Field<double> x, lambda;
      linear.system.assemble(block.stage(), W, active);
      const unsigned int plain = linear.system.solve_derivative(b, 1e-12, x),
                         transposed =
                           linear.system.solve_derivative(y, 1e-12, lambda, {}, Transposition::transposed);
      dual.compare(name + ", " + method + ": <y, M^-1 b> = <M^-T y, b>",
                   (dot(scene, y, x) - dot(scene, lambda, b)) / (norm(scene, y) * norm(scene, x)),
                   0.);
      x.add(-1., w);
      solved.compare(name + ", " + method + ": M^-1 M w = w", norm(scene, x) / norm(scene, w), 0.);
      Field<double>      again;
      const unsigned int spared =
        linear.system.solve_derivative(y, 1e-8, again, {lambda}, Transposition::transposed);
      again.add(-1., lambda);
      solved.compare(
        name + ", " + method + ": its solution as a start", norm(scene, again) / norm(scene, lambda), 0.);
      if (method == "auto")
        std::cout << "  iterations: of the transposed system not twice those of the system: "
                  << yes(plain > 5 && transposed < 2 * plain)
                  << ", from its solution none: " << yes(spared == 0) << "\n";
    }
  }

  void symmetry()
  {
    for (const std::string law : {"Coulomb", "Norton"})
    {
      Random       random;
      const Block  block(random, 2., 0.3, ElementPair::mini, law);
      SaddleMatrix matrix(block.scene);
      matrix.assemble(block.stage(), block.random_field(random), {}, Linearisation::newton);
      std::cout << law << ": symmetric: " << (matrix.system().symmetric ? "yes" : "no") << "\n";
    }
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) > 0)
    std::cout.setstate(std::ios::failbit);
  symmetry();
  Errors dual, solved;
  check(ElementPair::mini, 1e3, 0.3, dual, solved);
  check(ElementPair::mini, 1e6, 0., dual, solved);
  check(ElementPair::taylor_hood, 1e3, 0.3, dual, solved);
  check(ElementPair::taylor_hood, 1e6, 0.3, dual, solved);
  dual.print(1e-10);
  solved.print(1e-8);
}
