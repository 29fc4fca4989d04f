// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Gradients with dies of any shape, on coarse meshes. Proved:
// - a plane and the same plane triangulated give the same energy and gradient, to 1e-9;
// - under tripods, under a bell whose fillet a cylinder's rim rolls into, and under a punch, a flat face with
// a
//   sharp edge and a rounding behind it, the backward sweep agrees with the direct method to 1e-10 and with
//   replayed central differences to 1e-6: by all node positions, by the die's speed, by its offset, and by
//   all vertices of both dies. Points are nodes and middles of edges, that change facet from increment to
//   increment.
// - the same under the bell where its facets are the surface, and under tripods felt by nodes alone.

#include <deal.II/base/mpi.h>

#include "curved_scenes.h"
#include "directions.h"

#include <retroforge/case/parameters.h>

#include <algorithm>
#include <iostream>
#include <tuple>

using namespace retroforge;

namespace
{
  Parameters punch_scene()
  {
    Parameters p          = cylinder_scene();
    p.billet.element_size = 4.5;
    p.press.stroke        = 4.;
    p.press.increments    = 6;
    return p;
  }

  /// Of revolution, seen from below: a flat face, a sharp edge of 50 degrees, a cone, a rounding, a flat rim.
  Die punch(const double z)
  {
    std::vector<std::pair<double, double>> section = {{4., 0.}, {10., 0.}};
    const double                           slope = 50. * M_PI / 180., radius = 5.;
    const double                           r = 12., height = 2. * std::tan(slope);
    for (unsigned int i = 0; i <= 4; ++i)
    {
      const double a = slope * (1. - 0.25 * i);
      section.emplace_back(r + radius * (std::sin(slope) - std::sin(a)),
                           height + radius * (std::cos(a) - std::cos(slope)));
    }
    section.emplace_back(45., section.back().second);
    constexpr unsigned int n = 24;
    NodalVectors<double>   x = {Vec3({0., 0., z})};
    std::vector<Triangle>  t;
    for (unsigned int ring = 0; ring < section.size(); ++ring)
      for (unsigned int i = 0; i < n; ++i)
      {
        const double       angle = 2. * M_PI * i / n;
        const unsigned int a = 1 + ring * n + i, b = 1 + ring * n + (i + 1) % n;
        x.push_back(Vec3({section[ring].first * std::cos(angle),
                          section[ring].first * std::sin(angle),
                          z + section[ring].second}));
        if (ring == 0)
          t.push_back({{0, b, a}});
        else
          t.insert(t.end(), {{{a - n, b, a}}, {{a - n, b - n, b}}});
      }
    return Die("upper", TriangleSurface("punch", x, t), 5., {true, 40., 1.});
  }

  struct Problem : RecordedRun
  {
    explicit Problem(const Parameters &all) : RecordedRun(all), bar(adjoint()) {}
    Problem(const Parameters &all, std::vector<Die> dies) : RecordedRun(all, std::move(dies)), bar(adjoint())
    {
    }

    AdjointResult bar;
  };

  std::vector<Direction> directions(const Problem &problem)
  {
    const NodalVectors<double> still(problem.state().workpiece.X.size());
    return {{"random X_0", random_vectors(still.size()), 0., 0., {}},
            {"speed", still, 1., 0., {}},
            {"offset", still, 0., 1., {}}};
  }

  /// Where points of a run press.
  struct Pressed
  {
    unsigned int nodes = 0, edges = 0, ///< points
      faces = 0, sharp = 0,            ///< features of dies
      changed   = 0;                   ///< features that a point changed for another
    double tilt = 0.;                  ///< largest angle of a normal against the vertical [degrees]
  };

  Pressed pressed_points(const Problem &problem)
  {
    Pressed                                                          pressed;
    std::map<std::tuple<NodeIndex, NodeIndex, unsigned>, DieFeature> last;
    NodalVectors<double>                                             X = problem.scene.mesh.X;
    for (const IncrementRecord &record : problem.records)
    {
      const auto states = problem.process().at_stroke(record.stroke).dies;
      for (unsigned int p = 0; p < record.pairs.size(); ++p)
        if (const ContactPair &pair = record.pairs[p]; record.solves.back().active[p])
        {
          ++(pair.point.is_node() ? pressed.nodes : pressed.edges);
          ++(pair.feature.kind == 0 ? pressed.faces : pressed.sharp);
          const std::tuple key{pair.point.nodes[0], pair.point.nodes[1], pair.die};
          const auto       found = last.find(key);
          pressed.changed += found != last.end() && found->second != pair.feature;
          last[key] = pair.feature;
          const Vec3 n =
            problem.scene.dies[pair.die].project(pair.point.position(X), states[pair.die], pair.feature).n;
          pressed.tilt = std::max(pressed.tilt, std::acos(std::min(1., std::abs(n[2]))) * 180. / M_PI);
        }
      X = problem.first_epoch().increment.mechanics.recorded(problem.process(), {X, {}}, record).X;
    }
    return pressed;
  }

  void describe(const Problem &problem)
  {
    const Pressed pressed = pressed_points(problem);
    const auto    some    = [](const unsigned int n) { return n == 0 ? "none" : n > 3 ? "yes" : "few"; };
    std::cout << "  pressed nodes: " << some(pressed.nodes) << ", middles of edges: " << some(pressed.edges)
              << ", on faces: " << some(pressed.faces)
              << ", on edges or vertices of a die: " << some(pressed.sharp)
              << ", changing feature: " << yes(pressed.changed > 0) << "\n  friction works: "
              << yes(problem.state().energy.friction > 1e-3 * problem.state().energy.total())
              << ", normals tilted by 15 degrees and more: " << yes(pressed.tilt > 15.) << "\n";
  }

  double check(const std::string &name, Problem problem)
  {
    std::cout << name << "\n";
    describe(problem);
    double                 largest = 0.;
    std::vector<Direction> all     = directions(problem);
    all.push_back(random_vertices(problem));
    for (const Direction &direction : all)
    {
      const double adjoint = slope(problem, problem.bar, direction);
      const double tangent = relative_error(tangent_slope(problem, direction), adjoint);
      double       best    = 1e300;
      for (const double h : {1e-4, 1e-5, 1e-6})
        best = std::min(best, relative_error(difference(problem, direction, h), adjoint));
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
    double largest = relative_error(squares.state().energy.total(), plane.state().energy.total()), size = 0.;
    for (const Vec3 &x : plane.bar.X_0)
      size = std::max(size, x.norm());
    for (std::size_t k = 0; k < plane.bar.X_0.size(); ++k)
      largest = std::max(largest, (plane.bar.X_0[k] - squares.bar.X_0[k]).norm() / size);
    for (const Direction &direction : directions(plane))
      largest = std::max(
        largest, relative_error(slope(squares, squares.bar, direction), slope(plane, plane.bar, direction)));
    std::cout << "plane and triangulated plane\n  energy and gradient within 1e-9: " << yes(largest < 1e-9)
              << "\n";
    std::cout << "FIGURE triangulated_plane_difference " << largest << "\n";
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  compare_plane();
  const Parameters tripods = tripod_scene(), bell = bell_scene(), under_punch = punch_scene();
  Parameters       facets = bell, nodes = tripods;
  facets.dies[1].shape.choose<BellDie>().surface_law = SurfaceDie::Surface::facets;
  nodes.contact.edges_touch                          = false;
  const std::vector<double> errors                   = {check("tripods", Problem(tripods)),
                                                        check("bell", Problem(bell)),
                                                        check("punch with a sharp edge and a rounding",
                                            Problem(under_punch, {under_punch.dies[0].die(), punch(24.8)})),
                                                        check("bell of facets", Problem(facets)),
                                                        check("tripods felt by nodes alone", Problem(nodes))};
  std::cout << "FIGURE curved_die_gradient_error " << *std::max_element(errors.begin(), errors.end()) << "\n";
}
