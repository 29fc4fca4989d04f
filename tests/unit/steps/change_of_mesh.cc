// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The step that takes the workpiece to another mesh, on an upset cylinder that is remeshed.
// - The state: positions are those of the new mesh, strain is transfer_cells(), constants stay.
// - <A x_dot, y> = <x_dot, A^T y> of the state, A from dual numbers; and of an aggregate of all kinds of
//   members, positions, one number or vector per node, one number per cell, for each kind alone and all together.
// - Volumes change as they did.
// - No derivatives in a field: none arrive, and none are computed.

#include <deal.II/base/mpi.h>

#include "../mesh/mesh_test_tools.h"
#include "../random_numbers.h"
#include <retroforge/remeshing/local_remesher.h>
#include <retroforge/steps/change_of_mesh.h>
#include <retroforge/transfer/cell_transfer.h>

#include <cmath>
#include <iostream>
#include <numeric>

using namespace retroforge;

namespace
{
  RandomNumbers numbers;

  const std::vector<Die>              no_dies;
  const std::vector<DieState<double>> no_states;

  /// Members of every kind.
  template <typename Number>
  struct Everything
  {
    NodalVectors<Number>       X;
    NodeField<Number>          at_nodes;
    CellField<Number>          in_cells;
    NodeVectorField<3, Number> vectors;

    template <typename Self>
    static auto members(Self &self)
    {
      auto &[X, at_nodes, in_cells, vectors] = self;
      return std::tie(X, at_nodes, in_cells, vectors);
    }
  };

  struct Meshes
  {
    TetMesh              old_mesh;
    NodalVectors<double> X;
    RemeshRecord         remesh;
  };

  Meshes upset_cylinder()
  {
    constexpr double size = 6., f = 0.7;
    Meshes           meshes;
    meshes.old_mesh =
      billet({{"shape", "cylinder"}, {"radius", "20"}, {"height", "30"}, {"element size", "6"}});
    meshes.X = meshes.old_mesh.X;
    for (Vec3 &x : meshes.X)
      x = Vec3({x[0] / std::sqrt(f), x[1] / std::sqrt(f), f * x[2]});
    TapeWriter   tape(meshes.X);
    RemeshedMesh made = remesh_locally(
      meshes.old_mesh, meshes.X, [](const Vec3 &) { return size; }, {}, {}, {}, {}, &tape);
    std::vector<NodeIndex> all(made.mesh.n_nodes());
    std::iota(all.begin(), all.end(), 0);
    meshes.remesh.X_before  = meshes.X;
    meshes.remesh.mesh      = std::move(made.mesh);
    meshes.remesh.positions = tape.tape(all);
    meshes.remesh.mesh.X =
      moved_positions<double>(meshes.old_mesh, meshes.remesh, meshes.X, no_dies, no_states);
    meshes.remesh.transfer = make_transfer(meshes.old_mesh, meshes.X, meshes.remesh.mesh, made.old_node);
    return meshes;
  }

  template <typename Aggregate>
  Aggregate randomised(Aggregate of_shape)
  {
    for_each_number([](double &x) { x = numbers.scalar(); }, of_shape);
    return of_shape;
  }

  template <typename Aggregate>
  double dot(const Aggregate &a, const Aggregate &b)
  {
    double sum = 0.;
    for_each_number([&](const double &x, const double &y) { sum += x * y; }, a, b);
    return sum;
  }

  /// The difference of two sums, over the sum of the absolute products of the first.
  template <typename Aggregate>
  double defect(const Aggregate &a, const Aggregate &b, const double other)
  {
    double size = 0.;
    for_each_number([&](const double &x, const double &y) { size += std::abs(x * y); }, a, b);
    return std::abs(dot(a, b) - other) / size;
  }

  template <template <typename> class Aggregate>
  Aggregate<Dual> along(const Aggregate<double> &at, const Aggregate<double> &direction)
  {
    Aggregate<Dual> dual;
    convert(at, dual);
    for_each_number([](Dual &x, const double &x_dot) { x.fastAccessDx(0) = x_dot; }, dual, direction);
    return dual;
  }

  template <typename To, typename From>
  To dots(const From &dual, To of_shape)
  {
    for_each_number([](const Dual &x, double &x_dot) { x_dot = x.dx(0); }, dual, of_shape);
    return of_shape;
  }

  template <typename Number>
  using State = WorkpieceState<3, Number>;

  State<double> reversed(const Meshes &meshes, const State<double> &at, const State<double> &y)
  {
    std::vector<DieState<double>> no_bar;
    MovingTransfer moving(meshes.old_mesh, meshes.X, meshes.remesh.mesh, meshes.remesh.transfer);
    return reverse_change_mesh(meshes.old_mesh, meshes.remesh, at, no_dies, no_states, y, moving, no_bar);
  }

  /// Zero derivatives in all that a state may have.
  State<double> costate_of(const TetMesh &mesh)
  {
    return zero_costate<3>(
      mesh.n_nodes(), mesh.n_cells(), true, NodeSkins<double>::none(mesh.n_nodes(), 2), true);
  }

  /// |<A x_dot, y> - <x_dot, A^T y>|, relative.
  double defect_of_state(const Meshes &meshes)
  {
    const TetMesh &old_mesh = meshes.old_mesh, &new_mesh = meshes.remesh.mesh;
    auto           at = randomised(costate_of(old_mesh));
    at.X              = meshes.X;
    const auto dir = randomised(at), y = randomised(costate_of(new_mesh));
    const auto after = change_mesh<Dual>(old_mesh, meshes.remesh, along<State>(at, dir), no_dies, {});
    return defect(dots(after, y), y, dot(dir, reversed(meshes, at, y)));
  }

  Everything<double> everything(const TetMesh &mesh)
  {
    return randomised(Everything<double>{NodalVectors<double>(mesh.n_nodes()),
                                         NodeField<double>(mesh.n_nodes()),
                                         CellField<double>(mesh.n_cells()),
                                         NodeVectorField<3, double>(mesh.n_nodes())});
  }

  /// The same with some of the derivatives that come in put to zero.
  template <typename Keep>
  double defect_of_kinds(const Meshes &meshes, const Keep &keep)
  {
    auto at        = everything(meshes.old_mesh);
    at.X           = meshes.X;
    const auto dir = everything(meshes.old_mesh);
    auto       y   = everything(meshes.remesh.mesh);
    keep(y);
    const auto                        dual = along<Everything>(at, dir);
    Everything<Dual>                  after;
    Everything<double>                bar;
    const std::vector<DieState<Dual>> no_dual_states;
    std::vector<DieState<double>>     no_bar;
    const TetMesh                    &old_mesh = meshes.old_mesh, &new_mesh = meshes.remesh.mesh;
    const auto X_new = moved_positions(old_mesh, meshes.remesh, dual.X, no_dies, no_dual_states);
    const auto J     = moved_transfer(old_mesh, meshes.remesh, dual.X, X_new);
    internal::for_each_member(MemberTransfer<Dual>{old_mesh, new_mesh, dual.X, X_new, J}, dual, after);
    MovingTransfer        moving(old_mesh, meshes.X, new_mesh, meshes.remesh.transfer);
    ReverseMemberTransfer reverse(old_mesh, meshes.remesh, at.X, moving, bar.X);
    internal::for_each_member(
      [&](const auto &q, const auto &q_bar, auto &to) { reverse(q, q_bar, to); }, at, y, bar);
    reverse.reverse_positions(no_dies, no_states, no_bar);
    return defect(dots(after, y), y, dot(dir, bar));
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const Meshes                             meshes   = upset_cylinder();
  const TetMesh                           &old_mesh = meshes.old_mesh, &new_mesh = meshes.remesh.mesh;

  auto before = initial_state<3>(meshes.X, old_mesh.n_cells());
  before.strain.assign(old_mesh.n_cells(), 0.25);
  const auto after    = change_mesh(old_mesh, meshes.remesh, before, no_dies, no_states);
  double     farthest = 0., largest = 0.;
  for (NodeIndex k = 0; k < new_mesh.n_nodes(); ++k)
    farthest = std::max(farthest, (after.X[k] - new_mesh.X[k]).norm());
  for (const double q : after.strain)
    largest = std::max(largest, std::abs(q - 0.25));
  std::cout << "positions are those of the new mesh: " << yes(farthest < 1e-12) << "\n"
            << "a constant strain stays, in each new cell: "
            << yes(after.strain.size() == new_mesh.n_cells() && largest < 1e-14) << "\n";
  before.strain = randomised(before.strain);
  std::cout << "strain by transfer_cells: "
            << yes(
                 change_mesh(old_mesh, meshes.remesh, before, no_dies, no_states).strain ==
                 transfer_cells<double>(old_mesh, before.X, meshes.remesh.transfer, new_mesh, before.strain))
            << "\n";

  NodalVectors<double> moved = meshes.X;
  for (Vec3 &x : moved)
    x = Vec3({1.01 * x[0], 1.01 * x[1] + 0.05 * std::sin(x[2]), x[2]});
  const double was = volume(old_mesh.cells, meshes.X), change = volume(old_mesh.cells, moved) - was;
  const auto   there =
    meshes.remesh.positions.positions<double>({old_mesh, new_mesh, no_dies, no_states}, moved);
  std::cout << "the volume changes as it did: "
            << yes(std::abs(volume(new_mesh.cells, there) - volume(new_mesh.cells, new_mesh.X) - change) <
                   1e-11 * change)
            << "\n";

  const auto small = [](const double defect) { return yes(defect < 1e-14); };
  const auto none  = [](auto &field) { for_each_number([](double &x) { x = 0.; }, field); };
  std::cout << "dot product, state: " << small(defect_of_state(meshes)) << "\n"
            << "dot product, all kinds: " << small(defect_of_kinds(meshes, [](auto &) {})) << "\n"
            << "positions alone: "
            << small(defect_of_kinds(meshes,
                                     [&](auto &y) {
                                       none(y.at_nodes);
                                       none(y.in_cells);
                                       none(y.vectors);
                                     }))
            << "\nnodes alone: "
            << small(defect_of_kinds(meshes,
                                     [&](auto &y) {
                                       none(y.X);
                                       none(y.in_cells);
                                       none(y.vectors);
                                     }))
            << "\nvectors alone: "
            << small(defect_of_kinds(meshes,
                                     [&](auto &y) {
                                       none(y.X);
                                       none(y.at_nodes);
                                       none(y.in_cells);
                                     }))
            << "\ncells alone: "
            << small(defect_of_kinds(meshes,
                                     [&](auto &y) {
                                       none(y.X);
                                       none(y.at_nodes);
                                       none(y.vectors);
                                     }))
            << "\n";
  const auto nothing = reversed(meshes, before, zero_costate<3>(new_mesh.n_nodes(), new_mesh.n_cells()));
  std::cout << "nothing comes of nothing: " << yes(dot(nothing, nothing) == 0.)
            << ", in each old cell: " << yes(nothing.strain.size() == old_mesh.n_cells()) << "\n";
}
