// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The weights of J as functions of the positions of both meshes, where all nodes are new, on a sector of a cylinder, and where
// an upset billet was remeshed, whose new nodes were then pushed off the old surface and off middles of edges.
// - Where J was made they are its own, to 1e-13.
// - <A x_dot, y> = <x_dot, A^T y>, A from dual numbers, in old positions, in new ones, in both, to 1e-10.
// - J made anew at moved positions: central differences agree with A to 1e-6 and fall by 100 with a step of a tenth,
//   decisions held or made anew.
// - Linear fields stay exact, so that their derivative is that of the point of the old mesh that is closest, to 1e-12.

#include <deal.II/base/mpi.h>

#include "../mesh/mesh_test_tools.h"
#include "../random_numbers.h"
#include <retroforge/core/dual.h>
#include <retroforge/core/numbers.h>
#include <retroforge/geometry/vector_algebra.h>
#include <retroforge/remeshing/local_remesher.h>
#include <retroforge/transfer/moving_transfer.h>

using namespace retroforge;

namespace
{
  struct Meshes
  {
    TetMesh                old_mesh, new_mesh;
    NodalVectors<double>   X; ///< of the old one
    std::vector<NodeIndex> old_node;

    TransferOperator transfer() const { return make_transfer(old_mesh, X, new_mesh, old_node); }
  };

  Meshes unrelated()
  {
    Meshes     meshes;
    const auto sector = [](const char *size) {
      return billet({{"shape", "cylinder"},
                     {"radius", "20"},
                     {"height", "30"},
                     {"sector angle", "60"},
                     {"element size", size}});
    };
    meshes.old_mesh = sector("6");
    meshes.new_mesh = sector("5");
    meshes.X        = meshes.old_mesh.X;
    meshes.old_node.assign(meshes.new_mesh.n_nodes(), invalid_index);
    return meshes;
  }

  Meshes remeshed()
  {
    Meshes meshes;
    meshes.old_mesh =
      billet({{"shape", "cylinder"}, {"radius", "20"}, {"height", "30"}, {"element size", "6"}});
    meshes.X = meshes.old_mesh.X;
    for (Vec3 &x : meshes.X)
      x = Vec3({1.2 * x[0], 1.2 * x[1], 0.7 * x[2]});
    RemeshedMesh made = remesh_locally(meshes.old_mesh, meshes.X, [](const Vec3 &) { return 6.; }, {});
    meshes.new_mesh   = std::move(made.mesh);
    meshes.old_node   = std::move(made.old_node);
    // Off the middles of edges: beside these other corners count.
    RandomNumbers numbers;
    const auto    patches = patches_at_nodes(meshes.new_mesh);
    for (NodeIndex k = 0; k < meshes.new_mesh.n_nodes(); ++k)
      if (Vec3 &x = meshes.new_mesh.X[k]; meshes.old_node[k] == invalid_index && patches[k].size() < 2)
        x = 1.01 * x + 0.3 * numbers.vector();
    return meshes;
  }

  /// Directions in which positions move.
  struct Motion
  {
    NodalVectors<double> old_dot, new_dot;
  };

  NodalVectors<Dual> dual(const NodalVectors<double> &X, const NodalVectors<double> &X_dot)
  {
    NodalVectors<Dual> both;
    convert(X, both);
    for_each_number([](Dual &x, const double &x_dot) { x.fastAccessDx(0) = x_dot; }, both, X_dot);
    return both;
  }

  BasicTransfer<Dual> tangent(MovingTransfer &moving, const Meshes &meshes, const Motion &motion)
  {
    return moving.at(dual(meshes.X, motion.old_dot), dual(meshes.new_mesh.X, motion.new_dot));
  }

  double defect_of_values(MovingTransfer &moving, const Meshes &meshes, const TransferOperator &J)
  {
    const TransferOperator again = moving.at(meshes.X, meshes.new_mesh.X);
    RandomNumbers          numbers;
    const auto             q = numbers.scalars(J.n_old);
    const auto             a = J.apply(q), b = again.apply(q);
    double                 defect = 0.;
    for (NodeIndex k = 0; k < J.n_new(); ++k)
      defect = std::max(defect, std::abs(a[k] - b[k]));
    return defect;
  }

  double defect_of_reverse(MovingTransfer         &moving,
                           const Meshes           &meshes,
                           const TransferOperator &J,
                           const Motion           &motion)
  {
    RandomNumbers numbers;
    const auto    weight_bar = numbers.scalars(J.weight.size());
    const auto    weights    = tangent(moving, meshes, motion);
    double        forward = 0., size = 0.;
    for (std::size_t i = 0; i < J.weight.size(); ++i)
    {
      forward += weight_bar[i] * weights.weight[i].dx(0);
      size += std::abs(weight_bar[i] * weights.weight[i].dx(0));
    }
    NodalVectors<double> old_bar(meshes.X.size()), new_bar(meshes.new_mesh.n_nodes());
    moving.reverse(weight_bar, old_bar, new_bar);
    return weights.node != J.node
             ? 1.
             : std::abs(forward - dot(old_bar, motion.old_dot) - dot(new_bar, motion.new_dot)) / size;
  }

  /// Returns whether a new node stands where an old one does, beside which other corners count.
  bool is_at_node(const TransferOperator &J, const NodeIndex k)
  {
    return std::any_of(
      &J.weight[J.begin[k]], &J.weight[J.begin[k + 1]], [](const double w) { return w > 1. - 1e-9; });
  }

  /// The largest difference between a central difference of J q, and its tangent, relative.
  template <typename At>
  double defect_of_difference(MovingTransfer &moving,
                              const Meshes   &meshes,
                              const Motion   &motion,
                              const double    h,
                              const At       &at)
  {
    RandomNumbers     numbers;
    const auto        q       = numbers.scalars(meshes.X.size());
    const auto        weights = tangent(moving, meshes, motion);
    std::vector<Dual> q_dual(q.begin(), q.end());
    const auto        derivative = weights.apply(q_dual);
    const auto        moved      = [&](const double by) {
      Meshes there = meshes;
      for (std::size_t k = 0; k < there.X.size(); ++k)
        there.X[k] += by * motion.old_dot[k];
      for (std::size_t k = 0; k < there.new_mesh.X.size(); ++k)
        there.new_mesh.X[k] += by * motion.new_dot[k];
      return at(there).apply(q);
    };
    const auto             ahead = moved(h), behind = moved(-h);
    const TransferOperator J       = meshes.transfer();
    double                 largest = 0., size = 0.;
    for (NodeIndex k = 0; k < J.n_new(); ++k)
    {
      if (is_at_node(J, k))
        continue;
      size    = std::max(size, std::abs(derivative[k].dx(0)));
      largest = std::max(largest, std::abs((ahead[k] - behind[k]) / (2. * h) - derivative[k].dx(0)));
    }
    return largest / size;
  }

  /// Of a linear field, whose values move with the old nodes: J q is the field at the closest point.
  double defect_of_linear_field(MovingTransfer &moving, const Meshes &meshes, const Motion &motion)
  {
    const Vec3         a({0.3, -0.2, 0.5});
    const auto         X = dual(meshes.X, motion.old_dot), X_new = dual(meshes.new_mesh.X, motion.new_dot);
    const auto         J = moving.at(X, X_new);
    std::vector<Dual>  q;
    NodalVectors<Dual> at = J.apply(X);
    for (const auto &x : X)
      q.push_back(1. + x * Vector3<Dual>(a));
    const auto transferred = J.apply(q);
    double     defect      = 0.;
    for (std::size_t k = 0; k < at.size(); ++k)
      defect = std::max(defect, std::abs(transferred[k].dx(0) - Dual(at[k] * Vector3<Dual>(a)).dx(0)));
    return defect;
  }

  void check(const char *name, const Meshes &meshes)
  {
    const TransferOperator J = meshes.transfer();
    MovingTransfer         moving(meshes.old_mesh, meshes.X, meshes.new_mesh, J);
    RandomNumbers          numbers;
    const Motion           both{numbers.vectors(meshes.X.size()), numbers.vectors(meshes.new_mesh.n_nodes())},
      of_old{both.old_dot, NodalVectors<double>(meshes.new_mesh.n_nodes())},
      of_new{NodalVectors<double>(meshes.X.size()), both.new_dot};
    const auto reverse = [&](const Motion &motion) {
      return yes(defect_of_reverse(moving, meshes, J, motion) < 1e-10);
    };
    const auto held        = [&](const Meshes &there) { return moving.at(there.X, there.new_mesh.X); };
    const auto anew        = [](const Meshes &there) { return there.transfer(); };
    const auto held_coarse = defect_of_difference(moving, meshes, both, 1e-2, held),
               held_fine   = defect_of_difference(moving, meshes, both, 1e-3, held),
               made_anew   = defect_of_difference(moving, meshes, both, 1e-6, anew);
    std::cout << name << "\n  where J was made: " << yes(defect_of_values(moving, meshes, J) < 1e-13)
              << "\n  dot product, old positions: " << reverse(of_old) << ", new ones: " << reverse(of_new)
              << ", both: " << reverse(both)
              << "\n  differences, decisions held, fall: " << yes(held_fine < 0.02 * held_coarse)
              << ", made anew: " << yes(made_anew < 1e-6)
              << "\n  linear field: " << yes(defect_of_linear_field(moving, meshes, both) < 1e-12) << "\n";
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  check("all nodes new", unrelated());
  check("remeshed", remeshed());
}
