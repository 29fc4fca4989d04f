// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Every operation at every place of a box of 3 x 3 x 3 disturbed cubes (64 nodes: 8 inside, 8 corners, 24 on
// edges, 24 on sides), each applied to a copy, whatever it does to the quality. Proved for all that are not
// refused: the mesh stays one the solver can use (check_mesh), a ball (Euler characteristic 1), with its
// volume 27 and its six areas 9 (so that no ridge or corner is lost), and its smallest quality among the
// changed cells is what the plan says. Then: edge removal with rings of 3 to 7 nodes has n - 2 triangles, so
// 2 (n - 2) cells; a long edge in a ring of three is the exchange of 3 cells for 2, and a face flip is its
// inverse.

#include <deal.II/base/mpi.h>

#include "remeshing_test_tools.h"
#include <retroforge/remeshing/collapse.h>
#include <retroforge/remeshing/edge_removal.h>
#include <retroforge/remeshing/face_flip.h>
#include <retroforge/remeshing/smoothing.h>
#include <retroforge/remeshing/split.h>

using namespace retroforge;

constexpr double any_gain = -2;

// Counts what was done and what went wrong.
struct Tally
{
  std::string  name;
  unsigned int n_done = 0, n_refused = 0, n_on_surface = 0, n_wrong = 0;
  double       volume_error = 0, area_error = 0;

  void add(const Workbench &bench, const std::optional<CavityChange> &change)
  {
    if (!change)
    {
      ++n_refused;
      return;
    }
    ++n_done;
    n_on_surface += !change->removed_faces.empty();
    const TetMesh after = bench.after(*change);
    CavityChange  again = *change;
    evaluate(bench.edited, -2, again);
    if (verdict(after) != "valid" || euler_characteristic(after) != 1 ||
        std::abs(again.quality_after - change->quality_after) > 1e-14 ||
        std::abs(again.quality_before - change->quality_before) > 1e-14)
      ++n_wrong;
    volume_error = std::max(volume_error, std::abs(volume(after.cells, after.X) - 27));
    for (unsigned int patch = 0; patch < 6; ++patch)
      area_error = std::max(area_error, std::abs(patch_area(after, patch) - 9));
  }

  ~Tally()
  {
    std::cout << name << ": " << n_done << " done (" << n_on_surface << " on the surface), " << n_refused
              << " refused, " << n_wrong
              << " wrong; volume and areas kept: " << yes(volume_error < 1e-12 && area_error < 1e-12) << "\n";
  }
};

void operations_on_box()
{
  const Workbench                    bench(kuhn_box(3, 0.2), 1.);
  const EditableMesh                &mesh = bench.edited;
  std::set<std::array<NodeIndex, 2>> edges;
  for (const auto &cell : bench.mesh.cells)
    for (unsigned int i = 0; i < 4; ++i)
      for (unsigned int j = i + 1; j < 4; ++j)
        edges.insert(std::array<NodeIndex, 2>{{std::min(cell[i], cell[j]), std::max(cell[i], cell[j])}});
  {
    Tally removals{"edge removals"};
    for (const auto &[a, b] : edges)
      removals.add(bench, plan_edge_removal(bench.context, a, b, any_gain));
  }
  {
    Tally flips{"face flips"};
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
      for (unsigned int corner = 0; corner < 4; ++corner)
        flips.add(bench, plan_face_flip(bench.context, c, corner, any_gain));
  }
  for (const NodeKind kind : {NodeKind::interior, NodeKind::surface, NodeKind::ridge, NodeKind::corner})
  {
    const char *names[] = {"inside", "on sides", "on ridges", "in corners"};
    Tally       collapses{std::string("collapses of nodes ") + names[int(kind)]};
    for (const auto &[a, b] : edges)
      for (const auto &[from, to] : {std::array<NodeIndex, 2>{{a, b}}, std::array<NodeIndex, 2>{{b, a}}})
        if (mesh.kind(from) == kind)
          collapses.add(bench, plan_collapse(bench.context, from, to, 0, 10));
  }
  for (const SplitAt at : {SplitAt::middle, SplitAt::best})
  {
    Tally splits{at == SplitAt::best ? "optimised splits" : "splits"};
    for (const auto &[a, b] : edges)
      splits.add(bench, plan_split(bench.context, a, b, 0, at));
  }
  {
    Tally smoothings{"smoothings"};
    for (NodeIndex node = 0; node < mesh.n_nodes(); ++node)
      smoothings.add(bench, plan_smoothing(bench.context, node, 1e-3));
  }
}

// n nodes on a circle about an edge of half length `half`, nodes 0 and 1.
TetMesh ring_mesh(const unsigned int n, const double half)
{
  TetMesh mesh;
  mesh.X = {Vec3({0, 0, -half}), Vec3({0, 0, half})};
  for (unsigned int i = 0; i < n; ++i)
  {
    mesh.X.push_back(Vec3({std::cos(2 * M_PI * i / n), std::sin(2 * M_PI * i / n), 0}));
    mesh.cells.push_back({{0, 1, 2 + i, 2 + (i + 1) % n}});
  }
  add_one_patch(mesh);
  return mesh;
}

void rings()
{
  for (unsigned int n = 3; n <= 8; ++n)
  {
    const Workbench bench(ring_mesh(n, 1.), 1.);
    const auto      change = plan_edge_removal(bench.context, 0, 1, any_gain);
    std::cout << "ring of " << n << ": ";
    if (!change)
    {
      std::cout << "refused\n";
      continue;
    }
    const TetMesh after = bench.after(*change);
    std::cout << after.n_cells() << " cells, " << verdict(after) << ", same volume: "
              << yes(std::abs(volume(after.cells, after.X) - volume(bench.mesh.cells, bench.mesh.X)) < 1e-14)
              << "\n";
    if (n > 3)
      continue;
    const Workbench back(after, 1.);
    unsigned int    n_flips = 0;
    for (unsigned int corner = 0; corner < 4; ++corner)
      if (const auto flip = plan_face_flip(back.context, 0, corner, any_gain))
      {
        const TetMesh again = back.after(*flip);
        std::cout << "  flipped back: " << again.n_cells() << " cells, " << verdict(again) << "\n";
        ++n_flips;
      }
    std::cout << "  its faces that can be flipped: " << n_flips << "\n";
  }
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  operations_on_box();
  rings();
}
