// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The Newton matrix where middles of edges are contact points and couple the nodes of an edge. A corner of a
// billet with a plane of symmetry, at any velocity, between a wavy die and a tilted plane. Proved, on one
// rank and on two:
// - A x, for random x, is the derivative of the residual along x by dual numbers: solving for that derivative
// gives
//   x back;
// - the matrix is symmetric: <y, A^-1 x> = <x, A^-1 y>;
// - what edges add to it counts: with them held off, the same right-hand side gives another solution;
// - iterative solutions agree with the direct one: by incomplete factors, by multigrid, and at a stiff
// penalty, where
//   penalised velocities of edges' nodes are solved for together.

#include <deal.II/base/mpi.h>

#include <retroforge/solver/linear_system.h>

#include "corner_stage.h"
#include "methods.h"

using namespace retroforge;

namespace
{
  /// Its matrix by several methods.
  struct Corner : CornerStage
  {
    Timings timings;

    using CornerStage::CornerStage;

    /// Derivative of the residual along x. What fixed velocities do is no concern of the matrix.
    Field<double> derivative(const Field<double> &x) const
    {
      const auto         dual = converted<Dual>(physics);
      NodalVectors<Dual> positions;
      for (const Vec3 &position : X)
        positions.push_back(number(position));
      const auto contact_dual = make_contact_set<Dual>(
        scene.view(dual.dies, positions), contact.pairs, {FrictionRamp{0.5, false}, Dual(0.4), 0.3, 0.3});
      Field<Dual> field(scene.discretization);
      for (unsigned int i = 0; i < field.V.size(); ++i)
        field.V.at_place(i) = number(W.V.at_place(i), x.V.at_place(i));
      for (unsigned int i = 0; i < field.P.size(); ++i)
      {
        field.P.at_place(i)                 = Dual(W.P.at_place(i));
        field.P.at_place(i).fastAccessDx(0) = x.P.at_place(i);
      }
      const Field<Dual> r = Equilibrium<Dual>(scene, dual, contact_dual, positions).residual(field, active);
      Field<double>     r_dot(scene.discretization);
      for (unsigned int k = 0; k < r.V.size(); ++k)
        for (unsigned int i = 0; i < 3; ++i)
          r_dot.V.at_place(k)[i] = r.V.at_place(k)[i].dx(0);
      for (unsigned int k = 0; k < r.P.size(); ++k)
        r_dot.P.at_place(k) = r.P.at_place(k).dx(0);
      r_dot.update_ghosts();
      return r_dot;
    }

    /// @param edges  whether middles of edges press
    Field<double> solve(const Field<double> &rhs, const std::string &method, const bool edges = true)
    {
      ActiveSet pressed = active;
      for (unsigned int p = 0; p < pressed.size(); ++p)
        pressed[p] = pressed[p] && (edges || contact.pairs[p].point.is_node());
      LinearSolverParameters parameters;
      parameters.method         = method_of(method);
      parameters.max_iterations = 2000;
      LinearSystem  system(scene, parameters, timings);
      Field<double> solution;
      system.assemble(stage(), W, pressed);
      system.solve(rhs, 1e-12, solution);
      return solution;
    }

    static Vector3<Dual> number(const Vec3 &x, const Vec3 &x_dot = Vec3())
    {
      Vector3<Dual> d;
      for (unsigned int i = 0; i < 3; ++i)
      {
        d[i]                 = Dual(x[i]);
        d[i].fastAccessDx(0) = x_dot[i];
      }
      return d;
    }
  };

  /// Of all ranks.
  std::vector<double> flat(const Field<double> &x)
  {
    std::vector<double> list = x.P.complete(*x.P.numbering());
    for (const Vec3 &v : x.V.complete(*x.V.numbering()))
      list.insert(list.end(), v.begin_raw(), v.end_raw());
    return list;
  }

  double dot(const Field<double> &x, const Field<double> &y)
  {
    const std::vector<double> a = flat(x), b = flat(y);
    double                    sum = 0.;
    for (std::size_t i = 0; i < a.size(); ++i)
      sum += a[i] * b[i];
    return sum;
  }

  void describe(const Corner &corner)
  {
    const auto  &discretization = corner.scene.discretization;
    unsigned int n = 0, n_pressed = 0, n_frames = 0;
    double       n_shared = 0.;
    for (unsigned int p = 0; p < corner.contact.pairs.size(); ++p)
      if (const ContactPoint &point = corner.contact.pairs[p].point; !point.is_node())
      {
        ++n;
        n_pressed += corner.active[p];
        n_shared += discretization.owns(point.nodes[0]) && !discretization.owns(point.nodes[1]);
        n_frames += corner.scene.topology.fixed_directions[point.nodes[0]].size() > 0;
      }
    n_shared = discretization.sum(n_shared);
    std::cout << "  middles of edges: " << n << ", pressed: " << n_pressed
              << ", at nodes of the plane of symmetry: " << (n_frames > 1 ? "yes" : "NO")
              << ", across ranks: " << (n_shared > 1. ? "yes" : "none") << "\n";
  }

  double difference(const Field<double> &x, const Field<double> &y)
  {
    Field<double> z = x;
    z.add(-1., y);
    return std::sqrt(dot(z, z) / dot(y, y));
  }

  void check(const std::string &name, const double rho, const double exact_bar, const double iterative_bar)
  {
    Random random;
    Corner corner(random, rho);
    std::cout << name << "\n";
    describe(corner);
    Errors exact, iterative;
    double least = 1e300;
    for (unsigned int i = 0; i < 2; ++i)
    {
      const Field<double> x = corner.random_field(random), y = corner.random_field(random);
      const Field<double> rhs = corner.derivative(x), direct = corner.solve(rhs, "direct");
      exact.compare("direct solution for A x is x", flat(direct), flat(x));
      exact.compare("symmetry", dot(y, corner.solve(x, "direct")), dot(x, corner.solve(y, "direct")));
      for (const std::string method : {"ilu", "multigrid"})
        iterative.compare(method + " as direct", flat(corner.solve(rhs, method)), flat(direct));
      least = std::min(least, difference(corner.solve(rhs, "direct", false), x));
    }
    exact.print(exact_bar);
    iterative.print(iterative_bar);
    std::cout << "  edges held off, another solution: " << (least > 0.01 ? "yes" : "NO") << std::endl;
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) > 0)
    std::cout.setstate(std::ios::failbit);
  check("soft penalty", 2., 1e-12, 1e-8);
  check("stiff penalty", 1e5, 1e-10, 1e-7);
}
