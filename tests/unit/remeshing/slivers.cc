// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Flat cells at the surface. Proved:
// - a node that came to lie next to the middle of an edge of a block, on one of its sides: the flat cell
// there
//   has three faces on the surface and ridges around. Local remeshing leaves it. It is taken away, alone, and
//   remeshing as a run does it gives a sound mesh of the same volume; not where nothing may be taken away;
// - a film of three cells whose root, a node below, touches an edge above: two flat cells, none of which can
//   go before the film's end. It goes, then they do, 1/6 mm^3 and what is flat; all stay where that is
//   more than a cube of the wanted length, or than is allowed, or where the film ends in a plane of symmetry;
// - a neck: a flat cell inside, all of whose nodes are on the surface. It goes with the two cells above it, 2/3 mm^3;
//   where these are not on the surface either, the thinnest metal above them goes first.

#include "../mesh/block_mesh.h"
#include "remeshing_test_tools.h"

#include <deal.II/base/mpi.h>

#include <retroforge/mesh/mesh_checks.h>
#include <retroforge/remeshing/slivers.h>
#include <retroforge/time/remesher.h>

using namespace retroforge;

namespace
{
  constexpr double thin = 1e-4;

  const double one_degree = std::sin(M_PI / 180.);

  double size_of_one(const Vec3 &)
  {
    return 1.;
  }

  unsigned int n_flat(const TetMesh &mesh)
  {
    return std::count_if(mesh.cells.begin(), mesh.cells.end(), [&](const auto &cell) {
      return tet_quality(corners(cell, mesh.X)) < one_degree;
    });
  }

  void print(const std::string &title, const TetMesh &mesh, const std::optional<RepairedMesh> &made)
  {
    std::cout << title << ": " << n_flat(mesh) << " flat cells";
    if (!made)
    {
      std::cout << ", all stay\n";
      return;
    }
    const TetMesh &after = made->mesh.mesh;
    check_mesh(after, title);
    const double lost = volume(mesh.cells, mesh.X) - volume(after.cells, after.X);
    std::cout << ", " << mesh.n_cells() - after.n_cells() << " cells taken away, " << n_flat(after)
              << " flat ones left; volume told right: " << yes(std::abs(lost - made->removed) < 1e-13)
              << ", of it not flat: " << std::round(1e3 * lost) / 1e3 << "\n";
  }

  /// A block with a node on its side, next to the middle of the upper edge.
  TetMesh capped_block()
  {
    TetMesh    mesh = block_mesh({{3, 4, 3}}, [](unsigned int, unsigned int, unsigned int) { return true; });
    const auto at   = [&](const Vec3 &x) {
      return std::find_if(
               mesh.X.begin(), mesh.X.end(), [&](const Vec3 &y) { return (x - y).norm() < 1e-12; }) -
             mesh.X.begin();
    };
    const NodeIndex a = at(Vec3({3., 1., 3.})), b = at(Vec3({3., 2., 3.})), m = mesh.X.size();
    mesh.X.push_back(0.5 * (mesh.X[a] + mesh.X[b]) + Vec3({thin, 0., -2. * thin}));
    for (std::size_t f = 0, n = mesh.faces.size(); f < n; ++f)
      if (const auto nodes = mesh.faces[f].nodes;
          mesh.faces[f].patch == 1 && contains(nodes, a) && contains(nodes, b))
      {
        mesh.cells.push_back({{nodes[0], nodes[1], nodes[2], m}});
        mesh.faces[f].nodes = replaced(nodes, nodes[0], m);
        for (unsigned int i = 1; i < 3; ++i)
          mesh.faces.push_back({replaced(nodes, nodes[i], m), 1});
      }
    return mesh;
  }

  void cap()
  {
    TetMesh mesh = capped_block();
    check_mesh(mesh, "capped block");
    const RemeshedMesh local = remesh_locally(mesh, mesh.X, size_of_one, RemeshingParameters());
    std::cout << "local remeshing: " << n_flat(local.mesh) << " flat cells left\n";
    print("cap", mesh, without_slivers(mesh, mesh.X, size_of_one, 1.));
    print("cap, nothing allowed", mesh, without_slivers(mesh, mesh.X, size_of_one, 0.));
    const std::vector<Die> no_dies;
    const Remesher         remesher(RemesherParameters(), 1., no_dies, mesh.patches, MPI_COMM_WORLD);
    Timings                timings;
    for (const double allowed : {1., 0.})
    {
      const auto   record = remesher.remesh(mesh, mesh.X, {}, {}, allowed, timings);
      const double after = volume(record->mesh.cells, record->mesh.X), before = volume(mesh.cells, mesh.X);
      std::cout << "remeshed, " << allowed << " mm^3 allowed: " << n_flat(record->mesh)
                << " flat cells left, taken away: " << yes(record->removed_volume > 0.)
                << ", volume kept: " << yes(std::abs(after / before - 1.) < 1e-12) << "\n";
    }
  }

  /// Over the body P W Q R, the film A B T U, whose root V touches the edge A B from below.
  TetMesh film()
  {
    enum : NodeIndex
    {
      A,
      B,
      T,
      U,
      V,
      W,
      P,
      Q,
      R
    };
    TetMesh mesh;
    mesh.X     = {Vec3({0., -1., 0.}),
                  Vec3({0., 1., 0.}),
                  Vec3({1., 0., 0.}),
                  Vec3({1., 0., -1.}),
                  Vec3({0., 0., -thin}),
                  Vec3({-1., 0., -0.5}),
                  Vec3({-1., 0., 0.5}),
                  Vec3({0., -1., -1.}),
                  Vec3({-1., -2., 0.})};
    mesh.cells = {{{A, B, T, V}},
                  {{A, B, W, V}},
                  {{B, V, U, T}},
                  {{A, V, T, U}},
                  {{A, W, V, Q}},
                  {{A, V, U, Q}},
                  {{P, A, W, B}},
                  {{P, A, W, R}},
                  {{A, W, Q, R}}};
    for (auto &cell : mesh.cells)
      if (tet_volume(corners(cell, mesh.X)) < 0.)
        std::swap(cell[2], cell[3]);
    add_one_patch(mesh);
    check_mesh(mesh, "film");
    return mesh;
  }

  void film_with_a_root()
  {
    TetMesh mesh = film();
    // The body's cells are larger than a fifth.
    print("film", mesh, without_slivers(mesh, mesh.X, size_of_one, 0.2));
    print("film, wanted length 0.5",
          mesh,
          without_slivers(
            mesh, mesh.X, [](const Vec3 &) { return 0.5; }, 1.));
    print("film, 0.1 mm^3 allowed", mesh, without_slivers(mesh, mesh.X, size_of_one, 0.1));
    mesh.patches.push_back({"plane", Plane{mesh.X[3], Vec3({1., 1., 0.}) / std::sqrt(2.)}});
    for (BoundaryFace &face : mesh.faces)
      if (face_key(face.nodes) == FaceKey{{1, 2, 3}})
        face.patch = 1;
    print("film from a plane of symmetry", mesh, without_slivers(mesh, mesh.X, size_of_one, 0.2));
  }

  /// A flat cell A B C D, whose edges A B and C D nearly touch, between cells with the apexes P above and Q below:
  /// a neck. Nothing of these is on the surface, for each of their other faces bears one more cell.
  TetMesh neck(const bool with_caps)
  {
    enum : NodeIndex
    {
      A,
      B,
      C,
      D,
      P,
      Q
    };
    TetMesh mesh;
    mesh.X     = {Vec3({-1., 0., 0.}),
                  Vec3({1., 0., 0.}),
                  Vec3({0., -1., -thin}),
                  Vec3({0., 1., -thin}),
                  Vec3({0., 0., 1.}),
                  Vec3({0., 0., -1.})};
    mesh.cells = {{{A, B, C, D}}, {{A, B, C, P}}, {{A, B, D, P}}, {{A, C, D, Q}}, {{B, C, D, Q}}};
    if (with_caps)
      for (const NodeIndex apex : {P, Q})
        for (const NodeIndex end : {A, B})
          for (const NodeIndex side : {C, D})
          {
            const Vec3 middle = (mesh.X[apex] + mesh.X[end] + mesh.X[side]) / 3.;
            mesh.cells.push_back({{apex, end, side, static_cast<NodeIndex>(mesh.X.size())}});
            mesh.X.push_back((apex == P ? 1.5 : 1.7) * middle);
          }
    for (auto &cell : mesh.cells)
      if (tet_volume(corners(cell, mesh.X)) < 0.)
        std::swap(cell[2], cell[3]);
    add_one_patch(mesh);
    check_mesh(mesh, "neck");
    return mesh;
  }

  void necks()
  {
    const TetMesh bare = neck(false), capped = neck(true);
    print("neck", bare, without_slivers(bare, bare.X, size_of_one, 1.));
    const auto of_size = [](const double size) { return [size](const Vec3 &) { return size; }; };
    print("neck within more metal", capped, without_slivers(capped, capped.X, of_size(1.2), 2.));
    print("neck within more metal, wanted length 0.8",
          capped,
          without_slivers(capped, capped.X, of_size(0.8), 2.));
    print("neck within more metal, 0.3 mm^3 allowed",
          capped,
          without_slivers(capped, capped.X, of_size(1.2), 0.3));
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  cap();
  film_with_a_root();
  necks();
}
