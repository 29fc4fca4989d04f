// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Gradients with dies of any shape, on coarse meshes. Proved:
// - a plane and the same plane triangulated give the same energy and gradient, to 1e-9;
// - under tripods and under a bell whose fillet a cylinder's rim rolls into, with nodes on faces and edges
//   and normals that change from increment to increment, the backward sweep agrees with the direct method to
//   1e-10 and with replayed central differences to 1e-6: by all node positions, by the die's speed and by
//   its offset.

#include <deal.II/base/mpi.h>

#include "recorded_run.h"

#include <retroforge/parameters.h>

#include <algorithm>
#include <iostream>
#include <random>

using namespace retroforge;

namespace
{
  Parameters cylinder_scene()
  {
    Parameters p;
    p.billet.shape                 = "cylinder";
    p.billet.radius                = 20.;
    p.billet.height                = 24.;
    p.billet.symmetry_planes       = {Vec3({0., -1., 0.}), Vec3({-std::sqrt(0.75), 0.5, 0.})};
    p.billet.element_size          = 7.;
    p.dies                         = {DieParameters("lower"), DieParameters("upper")};
    p.dies[0].facing               = Vec3({0., 0., 1.});
    p.dies[1].facing               = Vec3({0., 0., -1.});
    p.dies[1].point                = Vec3({0., 0., 24.});
    p.dies[1].velocity             = Vec3({0., 0., -100.});
    p.dies[0].friction             = 0.4;
    p.dies[1].friction             = 0.3;
    p.material.minimal_strain_rate = 0.3;
    p.press.stroke                 = 3.;
    p.press.increments             = 4;
    p.contact.penetration          = 1e-2;
    p.contact.slip_fraction        = 0.1;
    p.newton.tolerance             = 1e-12;
    p.adjoint.tolerance            = 1e-13;
    p.linear_solver.method         = "direct";
    return p;
  }

  Parameters tripod_scene()
  {
    Parameters p          = cylinder_scene();
    p.billet.element_size = 5.;
    for (DieParameters &die : p.dies)
    {
      die.shape       = "tripod";
      die.chord_error = 0.3;
      die.tripod      = {9., 10., 46., 4., 60., {5., 20., 2., 2.}};
    }
    return p;
  }

  Parameters bell_scene()
  {
    Parameters p          = cylinder_scene();
    p.dies[1].shape       = "bell";
    p.dies[1].chord_error = 0.3;
    p.dies[1].bell        = {30., 50., {6., 60., 2., 14.}};
    p.dies[1].point       = Vec3({0., 0., 18.9});
    p.press.stroke        = 2.4;
    return p;
  }

  struct Problem : RecordedRun
  {
    explicit Problem(const Parameters &all) : RecordedRun(all), bar(adjoint()) {}
    Problem(const Parameters &all, std::vector<Die> dies) : RecordedRun(all, std::move(dies)), bar(adjoint())
    {
    }

    AdjointResult bar;
  };

  const char *yes(const bool condition)
  {
    return condition ? "yes" : "NO";
  }

  double error(const double a, const double b)
  {
    return std::abs(a / b - 1.);
  }

  /// A direction in (X_0, speed and offset of the upper die).
  struct Direction
  {
    std::string          name;
    NodalVectors<double> X_dot;
    double               speed_dot, offset_dot;
  };

  std::vector<Direction> directions(const Problem &problem)
  {
    std::mt19937               generator(1);
    const NodalVectors<double> still(problem.forged.X.size());
    std::vector<Direction>     list = {
          {"random X_0", still, 0., 0.}, {"speed", still, 1., 0.}, {"offset", still, 0., 1.}};
    for (Vec3 &x : list[0].X_dot)
      for (unsigned int i = 0; i < 3; ++i)
        x[i] = generator() / 2147483648. - 1.;
    return list;
  }

  template <typename Number>
  Number number(const double value, const double dot);
  template <>
  double number(const double value, double)
  {
    return value;
  }
  template <>
  Dual number(const double value, const double dot)
  {
    Dual x(value);
    x.fastAccessDx(0) = dot;
    return x;
  }

  /// Process and positions at t along a direction; as dual numbers, with that direction.
  template <typename Number>
  std::pair<Process<Number>, NodalVectors<Number>>
  along(const Problem &problem, const Direction &direction, const double t)
  {
    const Process<double> &at = problem.process;
    Process<Number>        process{{Number(at.law.K), Number(at.law.m), Number(at.law.e0)},
                            {Number(at.contact.rho), Number(at.contact.v0)},
                            {},
                            at.leading_die};
    for (unsigned int d = 0; d < at.dies.size(); ++d)
    {
      DieState<Number> state;
      for (unsigned int i = 0; i < 3; ++i)
      {
        const double speed_dot  = d == 1 ? direction.speed_dot * at.dies[d].velocity[i] : 0.;
        const double offset_dot = d == 1 ? direction.offset_dot * problem.parameters.dies[d].facing[i] : 0.;
        state.velocity[i]       = number<Number>(at.dies[d].velocity[i] + t * speed_dot, speed_dot);
        state.displacement[i]   = number<Number>(t * offset_dot, offset_dot);
      }
      state.friction = Number(at.dies[d].friction);
      process.dies.push_back(state);
    }
    NodalVectors<Number> X(problem.scene.mesh.n_nodes());
    for (std::size_t k = 0; k < X.size(); ++k)
      for (unsigned int i = 0; i < 3; ++i)
        X[k][i] =
          number<Number>(problem.scene.mesh.X[k][i] + t * direction.X_dot[k][i], direction.X_dot[k][i]);
    return {process, X};
  }

  double adjoint_slope(const Problem &problem, const Direction &direction)
  {
    double sum = 0.;
    for (std::size_t k = 0; k < direction.X_dot.size(); ++k)
      sum += problem.bar.X_0[k] * direction.X_dot[k];
    const auto &die = problem.bar.process.dies[1];
    return sum + direction.speed_dot * (die.velocity * problem.process.dies[1].velocity) +
           direction.offset_dot * (die.displacement * problem.parameters.dies[1].facing);
  }

  double tangent_slope(Problem &problem, const Direction &direction)
  {
    const auto [process, X] = along<Dual>(problem, direction, 0.);
    return problem.tangent(process, X);
  }

  double difference(Problem &problem, const Direction &direction, const double h)
  {
    const auto energy = [&](const double t) {
      const auto [process, X] = along<double>(problem, direction, t);
      return problem.replayed_energy(process, X);
    };
    return (energy(h) - energy(-h)) / (2. * h);
  }

  /// How many contacts of the run are on each kind of feature, how many features a node changes, and how far
  /// the normals of the active contacts spread.
  void describe(const Problem &problem)
  {
    unsigned int                                             n_kind[3] = {0, 0, 0}, n_changed = 0;
    double                                                   steepest = 1.;
    std::map<std::pair<NodeIndex, unsigned int>, DieFeature> last;
    for (const IncrementRecord &record : problem.records)
      for (unsigned int p = 0; p < record.pairs.size(); ++p)
        if (record.solves.back().active[p])
        {
          const ContactPair &pair = record.pairs[p];
          ++n_kind[pair.feature.kind == 0 ? 0 : pair.feature.kind < 4 ? 1 : 2];
          const auto found = last.find({pair.node, pair.die});
          n_changed += found != last.end() && found->second != pair.feature;
          last[{pair.node, pair.die}] = pair.feature;
          if (pair.feature.kind > 0)
            continue;
          // The normal of a face is the same from anywhere.
          const Vec3 n = problem.scene.dies[pair.die].project(Vec3(), Vec3(), pair.feature).n;
          steepest     = std::min(steepest, std::abs(n[2]));
        }
    std::cout << "  pressed on faces: " << yes(n_kind[0] > 30)
              << ", on edges or vertices: " << yes(n_kind[1] + n_kind[2] > 3)
              << ", changing feature: " << yes(n_changed > 0) << "\n  friction works: "
              << yes(problem.forged.energy.friction > 1e-3 * problem.forged.energy.total())
              << ", normals tilted by 15 degrees and more: " << yes(steepest < std::cos(M_PI / 12.)) << "\n";
  }

  double check(const std::string &name, const Parameters &parameters)
  {
    Problem problem(parameters);
    std::cout << name << "\n";
    describe(problem);
    double largest = 0.;
    for (const Direction &direction : directions(problem))
    {
      const double adjoint = adjoint_slope(problem, direction);
      const double tangent = error(tangent_slope(problem, direction), adjoint);
      double       best    = 1e300;
      for (const double h : {1e-4, 1e-5, 1e-6})
        best = std::min(best, error(difference(problem, direction, h), adjoint));
      largest = std::max(largest, best);
      std::cout << "  " << direction.name << ": direct method within 1e-10: " << yes(tangent < 1e-10)
                << ", differences within 1e-6: " << yes(best < 1e-6) << "\n";
    }
    return largest;
  }

  /// Both dies as planes, and as squares of four triangles that meet off the axis.
  void compare_plane()
  {
    const Parameters parameters = cylinder_scene();
    const auto       square     = [](const double z, const bool up) {
      const NodalVectors<double> x = {Vec3({-70., -70., z}),
                                      Vec3({70., -70., z}),
                                      Vec3({70., 70., z}),
                                      Vec3({-70., 70., z}),
                                      Vec3({3., 4., z})};
      std::vector<Triangle>      t = {{{0, 1, 4}}, {{1, 2, 4}}, {{2, 3, 4}}, {{3, 0, 4}}};
      if (!up)
        for (Triangle &facet : t)
          std::swap(facet[0], facet[1]);
      return TriangleSurface("square", x, t);
    };
    const Problem plane(parameters),
      squares(parameters, {Die("lower", square(0., true), 10.), Die("upper", square(24., false), 10.)});
    double largest = error(squares.forged.energy.total(), plane.forged.energy.total()), size = 0.;
    for (const Vec3 &x : plane.bar.X_0)
      size = std::max(size, x.norm());
    for (std::size_t k = 0; k < plane.bar.X_0.size(); ++k)
      largest = std::max(largest, (plane.bar.X_0[k] - squares.bar.X_0[k]).norm() / size);
    for (const Direction &direction : directions(plane))
      largest = std::max(largest, error(adjoint_slope(squares, direction), adjoint_slope(plane, direction)));
    std::cout << "plane and triangulated plane\n  energy and gradient within 1e-9: " << yes(largest < 1e-9)
              << "\n";
    std::cout << "FIGURE triangulated_plane_difference " << largest << "\n";
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  compare_plane();
  const double tripod = check("tripods", tripod_scene()), bell = check("bell", bell_scene());
  std::cout << "FIGURE curved_die_gradient_error " << std::max(tripod, bell) << "\n";
}
