// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// d(energy)/dV of a cube of 50 mm between flat dies with friction, m = 0.139, in its equilibrium:
//
//   energy_derivative accuracy SIZE    the program's derivative against automatic differentiation, and
//   differences inside
//                                      the elements over their perturbation
//   energy_derivative time SIZE...     seconds of one local sweep, and of a global perturbation of every
//   component for
//                                      meshes below 500 nodes
//
// SIZE is the element size in mm. Prints one line per result, for scripts to read.

#include <deal.II/base/mpi.h>

#include <retroforge/case/parameters.h>
#include <retroforge/discretization/element_pairs.h>
#include <retroforge/element/mini_element.templates.h>

#include <chrono>
#include <cstdio>
#include <cstring>

using namespace retroforge;

namespace
{
  Parameters cube(const double element_size)
  {
    Parameters p;
    p.billet.size         = Vec3({50, 50, 50});
    p.billet.element_size = element_size;
    p.dies                = {DieParameters("lower"), DieParameters("upper")};
    p.dies[0].facing      = Vec3({0, 0, 1});
    p.dies[1].point       = Vec3({0, 0, 50});
    p.dies[1].facing      = Vec3({0, 0, -1});
    p.dies[1].velocity    = Vec3({0, 0, -100});
    for (DieParameters &die : p.dies)
      die.friction = 0.4;
    p.material.law.m   = 0.139;
    p.press.stroke     = 1.;
    p.press.increments = 2;
    return p;
  }

  /// The equilibrium at the start of the press.
  struct Solved
  {
    explicit Solved(const double element_size)
        : parameters(cube(element_size))
        , scene(make_billet(parameters.billet, MPI_COMM_WORLD),
                {},
                {parameters.dies[0].die(), parameters.dies[1].die()},
                MPI_COMM_WORLD)
        , model(parameters.step_model())
        , process(parameters.process({50., 50.}))
        , physics(process.at_stroke(0.))
        , contact(make_contact_set<double>(
            scene.view(physics.dies, scene.mesh.X),
            find_contact_pairs(scene.view(physics.dies, scene.mesh.X),
                               model.contact.ramp,
                               model.reach,
                               model.edges_touch),
            {model.contact.ramp, parameters.press.stroke / parameters.press.increments / process.speed()}))
        , stage(scene, physics, contact, scene.mesh.X)
        , W(scene.discretization)
    {
      LinearSystem system(scene, parameters.linear_solver, timings);
      Newton(scene, parameters.newton, system).solve(stage, W, {});
      active = stage.decide_active(W);
    }

    double power(const Field<double> &at) const
    {
      const auto [deformation, friction] = stage.power(at, active);
      return deformation + friction;
    }

    /// As the backward sweep has it.
    NodalVectors<double> derivative() const
    {
      Field<double>        W_bar(scene.discretization);
      NodalVectors<double> X_bar(scene.mesh.n_nodes());
      ContactSetBar        contact_bar(contact.pairs.size());
      PhysicsBar           physics_bar(scene.dies);
      EquilibriumBar       bar{W_bar, X_bar, contact_bar, physics_bar};
      reverse_power({stage, W, active}, 1., 1., bar);
      return W_bar.V.complete(*scene.discretization.condensed_nodes());
    }

    Parameters          parameters;
    Timings             timings;
    Scene               scene;
    StepModel           model;
    Process<double>     process;
    Physics<double>     physics;
    ContactSet<double>  contact;
    Equilibrium<double> stage;
    Field<double>       W;
    ActiveSet           active;
  };

  Vector3<Dual> dual(const Vec3 &v)
  {
    Vector3<Dual> x;
    for (unsigned int i = 0; i < 3; ++i)
      x[i] = Dual(v[i]);
    return x;
  }

  ContactNode<Dual> dual(const ContactNode<double> &node)
  {
    return {dual(node.u),
            dual(node.n),
            Dual(node.delta),
            Dual(node.tau),
            Dual(node.S),
            Dual(node.Sf),
            Dual(node.alpha),
            node.active};
  }

  /// Runs over all cells and contact nodes; `cell(geometry, w, a, i)` and `node(contact node, i)` are the
  /// derivatives of one of them in one velocity component.
  template <typename OfCell, typename OfNode>
  NodalVectors<double> gather(const Solved &e, const OfCell &cell, const OfNode &node)
  {
    const TetMesh       &mesh = e.scene.mesh;
    NodalVectors<double> slope(mesh.n_nodes());
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
      for (unsigned int a = 0; a < 4; ++a)
        for (unsigned int i = 0; i < 3; ++i)
          slope[mesh.cells[c][a]][i] += cell(geometry_of_cell(e.scene.discretization, mesh.X, c),
                                             MiniPair::on_cell(e.scene.discretization, e.W, c),
                                             a,
                                             i);
    for (unsigned int p = 0; p < e.contact.pairs.size(); ++p)
      for (unsigned int i = 0; i < 3; ++i)
        slope[e.contact.pairs[p].point.nodes[0]][i] += node(e.stage.contact_node(p, e.W, e.active), i);
    return slope;
  }

  NodalVectors<double> by_automatic_differentiation(const Solved &e)
  {
    const auto law     = converted<Dual>(e.physics.material.law);
    const auto contact = converted<Dual>(e.physics.contact);
    return gather(
      e,
      [&](const CellGeometry<double> &geometry,
          const CellValues<double>   &w,
          const unsigned int          a,
          const unsigned int          i) {
        CellGeometry<Dual> g;
        CellValues<Dual>   x;
        g.volume = Dual(geometry.volume);
        x.beta   = dual(w.beta);
        for (unsigned int b = 0; b < 4; ++b)
        {
          g.g[b] = dual(geometry.g[b]);
          x.V[b] = dual(w.V[b]);
          x.P[b] = Dual(w.P[b]);
        }
        x.V[a][i].fastAccessDx(0) = 1.;
        return cell_dissipation(g, x, law).dx(0);
      },
      [&](const ContactNode<double> &node, const unsigned int i) {
        ContactNode<Dual> x    = dual(node);
        x.u[i].fastAccessDx(0) = 1.;
        return friction_power(x, law, contact).dx(0);
      });
  }

  /// Forward differences of the elements' powers, as the thesis forms them.
  NodalVectors<double> by_local_differences(const Solved &e, const double step)
  {
    return gather(
      e,
      [&](const CellGeometry<double> &geometry,
          CellValues<double>          w,
          const unsigned int          a,
          const unsigned int          i) {
        const double here = cell_dissipation(geometry, w, e.physics.material.law);
        w.V[a][i] += step;
        return (cell_dissipation(geometry, w, e.physics.material.law) - here) / step;
      },
      [&](ContactNode<double> node, const unsigned int i) {
        const double here = friction_power(node, e.physics.material.law, e.physics.contact);
        node.u[i] += step;
        return (friction_power(node, e.physics.material.law, e.physics.contact) - here) / step;
      });
  }

  NodalVectors<double> by_global_differences(const Solved &e, const double step)
  {
    NodalVectors<double> slope(e.scene.mesh.n_nodes());
    const double         here = e.power(e.W);
    Field<double>        W    = e.W;
    for (NodeIndex k = 0; k < slope.size(); ++k)
      for (unsigned int i = 0; i < 3; ++i)
      {
        W.V[k][i] += step;
        slope[k][i] = (e.power(W) - here) / step;
        W.V[k][i]   = e.W.V[k][i];
      }
    return slope;
  }

  double difference(const NodalVectors<double> &a, const NodalVectors<double> &b)
  {
    double apart = 0., size = 0.;
    for (std::size_t k = 0; k < a.size(); ++k)
    {
      apart += (a[k] - b[k]).norm_square();
      size += b[k].norm_square();
    }
    return std::sqrt(apart / size);
  }

  template <typename F>
  double seconds(const F &f)
  {
    const auto start = std::chrono::steady_clock::now();
    f();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  void print_accuracy(const double element_size)
  {
    const Solved e(element_size);
    const auto   exact = by_automatic_differentiation(e);
    std::printf("nodes %u\ndefault %.3e\n", e.scene.mesh.n_nodes(), difference(e.derivative(), exact));
    for (int exponent = 2; exponent <= 24; ++exponent)
    {
      const double step = std::pow(10., -0.5 * exponent);
      std::printf("difference %.3e %.3e\n", step, difference(by_local_differences(e, step), exact));
    }
  }

  void print_time(const double element_size)
  {
    const Solved        e(element_size);
    std::vector<double> times;
    for (unsigned int i = 0; i < 21; ++i)
      times.push_back(seconds([&] { e.derivative(); }));
    std::nth_element(times.begin(), times.begin() + 10, times.end());
    const unsigned int n = e.scene.mesh.n_nodes();
    std::printf("time %u %u %.3e", n, e.scene.mesh.n_cells(), times[10]);
    if (n < 500)
      std::printf(" %.3e", seconds([&] { by_global_differences(e, 1e-6); }));
    std::printf("\n");
    std::fflush(stdout);
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  if (argc < 3)
    return 1;
  for (int i = 2; i < argc; ++i)
    std::strcmp(argv[1], "time") == 0 ? print_time(std::atof(argv[i])) : print_accuracy(std::atof(argv[i]));
  return 0;
}
