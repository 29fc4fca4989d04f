// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The step that takes the workpiece to another mesh, on an upset cylinder that is remeshed.
// - The state: positions are those of the new mesh, strain is transfer_cells(), constants stay.
// - <A x_dot, y> = <x_dot, A^T y> of the state, A from dual numbers; and of an aggregate of all kinds of
//   members, positions, one number or vector per node, one number per cell, for each kind alone and all together.
// - Volumes change as they did.
// - A mesh that follows the shape: its volume changes as by the operations; along the flat ends of the cylinder nodes go as
//   their neighbours do, what goes across stays, and a motion along the ends leaves nothing; where two patches meet on an end they go along the border alone; no node goes farther than those of the surface; nodes stay in planes of symmetry; constant
//   fields stay, equal values of nodes beside each other stay equal, those that are 0 stay so, and linear ones are inside what they are at the new places; the dot product as above, for each member of the
//   state alone and for all, and a member of which the motion is left out is told.
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

  State<double> reversed(const Meshes        &meshes,
                         const State<double> &at,
                         const State<double> &y,
                         const FollowingMesh *following = nullptr)
  {
    std::vector<DieState<double>> no_bar;
    MovingTransfer moving(meshes.old_mesh, meshes.X, meshes.remesh.mesh, meshes.remesh.transfer);
    return reverse_change_mesh(
      meshes.old_mesh, meshes.remesh, at, no_dies, no_states, y, moving, no_bar, following);
  }

  /// Zero derivatives in all that a state may have.
  State<double> costate_of(const TetMesh &mesh)
  {
    return zero_costate<3>(
      mesh.n_nodes(), mesh.n_cells(), true, NodeSkins<double>::none(mesh.n_nodes(), 2), true);
  }

  /// |<A x_dot, y> - <x_dot, A^T y>|, relative.
  /// @param keep  takes from y what is not asked for
  template <typename Keep>
  double defect_of_state(const Meshes &meshes, const FollowingMesh *following, const Keep &keep)
  {
    const TetMesh &old_mesh = meshes.old_mesh, &new_mesh = meshes.remesh.mesh;
    auto           at = randomised(costate_of(old_mesh));
    at.X              = meshes.X;
    const auto dir    = randomised(at);
    auto       y      = randomised(costate_of(new_mesh));
    keep(y);
    const auto after =
      change_mesh<Dual>(old_mesh, meshes.remesh, along<State>(at, dir), no_dies, {}, following);
    return defect(dots(after, y), y, dot(dir, reversed(meshes, at, y, following)));
  }

  /// A quarter of a cylinder, whose nodes lie on planes of symmetry and their axis, too.
  TetMesh quarter()
  {
    return billet({{"shape", "cylinder"},
                   {"radius", "20"},
                   {"height", "30"},
                   {"element size", "6"},
                   {"sector angle", "90"}});
  }

  void check_shape_motion(const TetMesh &mesh)
  {
    constexpr double     height = 30., small = 1e-6;
    const ShapeMotion    motion(mesh);
    NodalVectors<double> d, no_shape(mesh.n_nodes()); // the latter along the ends
    double               farthest = 0., off_planes = 0., across = 0., unlike = 0., left = 0.;
    const auto           is_on = [&](const NodeIndex k, const Patch &patch) {
      return patch.symmetry && std::abs((mesh.X[k] - patch.symmetry->point) * patch.symmetry->normal) < small;
    };
    for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
    {
      d.push_back(numbers.vector());
      for (const Patch &patch : mesh.patches)
        if (is_on(k, patch))
          d[k] -= (d[k] * patch.symmetry->normal) * patch.symmetry->normal;
    }
    const NodalVectors<double> r          = motion.of(d);
    double                     of_surface = 0.;
    for (const BoundaryFace &face : mesh.faces)
      if (mesh.is_surface(face))
        for (const NodeIndex k : face.nodes)
          of_surface = std::max(of_surface, r[k].norm());
    for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
    {
      farthest = std::max(farthest, r[k].norm());
      for (const Patch &patch : mesh.patches)
        if (is_on(k, patch))
          off_planes = std::max(off_planes, std::abs(r[k] * patch.symmetry->normal));
      const bool at_end  = mesh.X[k][2] < small || mesh.X[k][2] > height - small;
      const bool at_side = std::hypot(mesh.X[k][0], mesh.X[k][1]) > 19.9;
      if (!at_end || at_side)
        continue;
      across      = std::max(across, std::abs(r[k][2] - d[k][2]));
      no_shape[k] = Vec3({d[k][0], d[k][1], 0.});
      // As its neighbours in the mean over the faces, but across planes of symmetry.
      Vec3 sum;
      for (const BoundaryFace &face : mesh.faces)
        if (mesh.is_surface(face) && std::find(face.nodes.begin(), face.nodes.end(), k) != face.nodes.end())
          for (const NodeIndex b : face.nodes)
            sum += r[b] - r[k];
      sum[2]          = 0.;
      unsigned planes = 0;
      for (const Patch &patch : mesh.patches)
        if (is_on(k, patch))
        {
          sum -= (sum * patch.symmetry->normal) * patch.symmetry->normal;
          ++planes;
        }
      if (planes < 2)
        unlike = std::max(unlike, sum.norm());
    }
    for (const Vec3 &x : motion.of(no_shape))
      left = std::max(left, x.norm());
    constexpr double h      = 1e-6;
    const auto       change = [&](const NodalVectors<double> &motion_of) {
      const auto moved = [&](const double t) {
        NodalVectors<double> X = mesh.X;
        for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
          X[k] += t * motion_of[k];
        return volume(mesh.cells, X);
      };
      return (moved(h) - moved(-h)) / (2. * h);
    };
    std::cout << "follows the shape: volume "
              << yes(std::abs(change(r) - change(d)) < 1e-6 * std::abs(change(d))) << ", across the ends "
              << yes(across < 1e-13) << ", along them as neighbours " << yes(unlike < 1e-12)
              << ", of what changes no shape nothing " << yes(left < 1e-12) << ", in the planes "
              << yes(off_planes < 1e-13) << ", no farther than the surface "
              << yes(farthest <= of_surface * (1. + 1e-13)) << "\n";
  }

  /// The upper end in two patches: where they meet nodes keep to their border, which slides along itself alone.
  void check_borders(TetMesh mesh)
  {
    constexpr double height = 30., small = 1e-6;
    const auto       is_inside_end = [&](const NodeIndex k) {
      return mesh.X[k][2] > height - small && std::hypot(mesh.X[k][0], mesh.X[k][1]) < 19.9;
    };
    const unsigned int                                              half = mesh.patches.size();
    std::map<std::array<NodeIndex, 2>, std::array<unsigned int, 2>> faces; // of each edge, in each half
    for (BoundaryFace &face : mesh.faces)
    {
      const Vec3 sum = mesh.X[face.nodes[0]] + mesh.X[face.nodes[1]] + mesh.X[face.nodes[2]];
      if (!mesh.is_surface(face) || sum[2] < 3. * (height - small))
        continue;
      const bool other = sum[0] + 0.3 * sum[1] < 6.;
      if (other)
      {
        if (mesh.patches.size() == half)
          mesh.patches.push_back(mesh.patches[face.patch]);
        face.patch = half;
      }
      for (unsigned int i = 0; i < 3; ++i)
      {
        const auto [a, b] = std::minmax(face.nodes[i], face.nodes[(i + 1) % 3]);
        ++faces[{{a, b}}][other];
      }
    }
    std::map<NodeIndex, std::vector<NodeIndex>> border;
    for (const auto &[edge, of_half] : faces)
      if (of_half[0] == 1 && of_half[1] == 1)
        for (const unsigned int i : {0, 1})
          border[edge[i]].push_back(edge[1 - i]);
    NodalVectors<double> d;
    for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
      d.push_back(numbers.vector());
    const NodalVectors<double> r       = ShapeMotion(mesh).of(d);
    unsigned int               n_slide = 0, n_stay = 0;
    double                     beside = 0.;
    for (const auto &[k, neighbours] : border)
      if (is_inside_end(k) && neighbours.size() == 2)
      {
        const Vec3 to = mesh.X[k] - mesh.X[neighbours[0]], from = mesh.X[neighbours[1]] - mesh.X[k];
        const Vec3 slid  = r[k] - d[k];
        const bool turns = to * from < 0.7 * to.norm() * from.norm();
        const Vec3 along = (to + from) / (to + from).norm();
        beside           = std::max(beside, turns ? slid.norm() : (slid - (slid * along) * along).norm());
        n_stay += turns;
        n_slide += !turns && slid.norm() > 1e-3;
      }
    std::cout << "where patches meet: along the border alone " << yes(beside < 1e-13 && n_slide > 0)
              << ", at its corners not at all " << yes(n_stay > 0) << "\n";
  }

  void check_moved_fields(const TetMesh &mesh)
  {
    const FollowingMesh  following(mesh);
    const Vec3           slope = numbers.vector();
    std::vector<double>  linear, constant(mesh.n_nodes(), 3.), in_cells(mesh.n_cells(), 3.);
    NodalVectors<double> w;
    std::vector<bool>    is_inside(mesh.n_nodes(), true);
    for (const BoundaryFace &face : mesh.faces)
      for (const NodeIndex k : face.nodes)
        if (mesh.is_surface(face))
          is_inside[k] = false;
    for (const Vec3 &x : mesh.X)
    {
      linear.push_back(slope * x);
      w.push_back(numbers.vector());
    }
    // The transfer makes values equal to others'; heat that flows has kinks there.
    std::vector<double> with_equals = linear;
    const auto         &cell        = mesh.cells[mesh.n_cells() / 2];
    with_equals[cell[1]] = with_equals[cell[2]] = with_equals[cell[0]];
    following.move_nodes(w, with_equals);
    const bool equal =
      with_equals[cell[1]] == with_equals[cell[0]] && with_equals[cell[2]] == with_equals[cell[0]];
    // Where no die has touched there is no skin and no flux.
    std::vector<double> with_nothing = linear;
    for (const NodeIndex k : cell)
      with_nothing[k] = 0.;
    following.move_nodes(w, with_nothing);
    const bool nothing =
      std::all_of(cell.begin(), cell.end(), [&](const NodeIndex k) { return with_nothing[k] == 0.; });
    following.move_nodes(w, linear);
    following.move_nodes(w, constant);
    following.move_cells(w, in_cells);
    double of_linear = 0., of_constants = 0.;
    for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
    {
      if (is_inside[k])
        of_linear = std::max(of_linear, std::abs(linear[k] - slope * (mesh.X[k] + w[k])));
      of_constants = std::max(of_constants, std::abs(constant[k] - 3.));
    }
    for (const double q : in_cells)
      of_constants = std::max(of_constants, std::abs(q - 3.));
    std::cout << "fields: linear ones inside " << yes(of_linear < 1e-12) << ", constants "
              << yes(of_constants < 1e-12) << ", equal values stay equal " << yes(equal)
              << ", of nothing nothing " << yes(nothing) << "\n";
  }

  /// Of a mesh that follows the shape.
  void check_following(const Meshes &meshes)
  {
    const FollowingMesh following(meshes.remesh.mesh);
    const auto          only = [](const unsigned int member) {
      return [member](State<double> &y) {
        unsigned int i = 0;
        internal::for_each_member(
          [&](auto &q) {
            if (i++ != member)
              for_each_number([](double &x) { x = 0.; }, q);
          },
          y);
      };
    };
    std::cout << "dot product, following the shape: "
              << yes(defect_of_state(meshes, &following, [](const State<double> &) {}) < 1e-13) << ", alone:";
    const std::vector<std::string> names = {
      "positions", "strain", "velocity", "temperature", "skin", "friction flux", "damage"};
    for (unsigned int i = 0; i < names.size(); ++i)
      std::cout << " " << names[i] << " " << yes(defect_of_state(meshes, &following, only(i)) < 1e-13);
    std::cout << "\n";
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
            << yes(change_mesh(old_mesh, meshes.remesh, before, no_dies, no_states).strain ==
                   transfer_cells<double>({old_mesh, before.X, meshes.remesh.transfer, new_mesh, new_mesh.X},
                                          before.strain))
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
  std::cout << "dot product, state: " << small(defect_of_state(meshes, nullptr, [](const State<double> &) {}))
            << "\n"
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
  for (const TetMesh &mesh : {old_mesh, quarter()})
  {
    check_shape_motion(mesh);
    check_moved_fields(mesh);
  }
  check_borders(old_mesh);
  check_following(meshes);
}
