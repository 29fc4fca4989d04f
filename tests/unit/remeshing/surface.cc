// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The boundary as remeshing sees it. Proved:
// - features counted by hand: a box has 6 regions, 12 curves, 8 corners; a cylinder 3 regions, 2 closed
//   curves, no corner; a quarter of it 5 regions, 9 curves, 6 corners; a box that is one patch is the same as
//   one with six, by its angles; but an edge whose faces cut into a die is none;
// - the tree finds what a search of all triangles finds;
// - the lift is of second order: middles of edges are off a cylinder by  h^2/(8 R)  before (the chord) and
//   less than 10 % of that after, on its side and its rim, also next to symmetry planes, which hold to
//   rounding;
// - points inside a die are pushed out, others stay;
// - the volume correction moves a cylinder's side and not its ends, and reaches the volume to 2e-14; of a
//   box, flat all round, it moves the sides.

#include <deal.II/base/mpi.h>

#include "remeshing_test_tools.h"
#include <retroforge/remeshing/volume_correction.h>

using namespace retroforge;

TetMesh cylinder(const std::string &h, const std::string &planes)
{
  std::vector<std::pair<std::string, std::string>> entries = {
    {"shape", "cylinder"}, {"radius", "20"}, {"height", "30"}, {"element size", h}};
  if (!planes.empty())
    entries.push_back({"symmetry planes", planes});
  return billet(entries);
}

void count_features(const std::string &title, const TetMesh &mesh, const PushOut &push_out = {})
{
  const SurfaceFeatures features(mesh, mesh.X, 40, 45, push_out);
  unsigned int          n_closed = 0;
  for (const auto &curve : features.curves)
    n_closed += curve.is_closed();
  std::cout << title << ": " << features.patch_of_region.size() << " regions, " << features.curves.size()
            << " curves, of them closed " << n_closed << ", "
            << std::count(features.is_corner.begin(), features.is_corner.end(), true) << " corners\n";
}

void search_tree()
{
  std::mt19937 random(3);
  const auto   point = [&]() {
    Vec3 x;
    for (unsigned int d = 0; d < 3; ++d)
      x[d] = random_number(random);
    return x;
  };
  std::vector<std::array<Vec3, 3>> triangles;
  for (unsigned int i = 0; i < 200; ++i)
  {
    const Vec3 centre = point();
    triangles.push_back({{centre, centre + 0.2 * point(), centre + 0.2 * point()}});
  }
  const TriangleTree tree(triangles);
  unsigned int       n_wrong = 0;
  for (unsigned int i = 0; i < 500; ++i)
  {
    const Vec3 x    = 1.5 * point();
    double     best = 100;
    for (const auto &triangle : triangles)
      best = std::min(best, (nearest_on_triangle(x, triangle).point - x).norm());
    n_wrong += (tree.closest(x).at.point - x).norm() != best;
  }
  std::cout << "tree: " << n_wrong << " of 500 wrong\n";
}

// Farthest the middles of edges are from the radius, before and after lifting, and off symmetry planes.
void lift(const std::string &title, const TetMesh &mesh)
{
  const SurfaceFeatures features(mesh, mesh.X, 40, 45);
  const OldSurface      surface(mesh, mesh.X, features, {});
  const EditableMesh    edited(mesh, mesh.X, features);
  double                before[2] = {0, 0}, after[2] = {0, 0}, off_plane = 0;
  for (const auto &edge : surface_edges(mesh.faces))
  {
    const Vec3         x     = (mesh.X[edge.nodes[0]] + mesh.X[edge.nodes[1]]) / 2.;
    const unsigned int curve = edited.curve_of_edge(edge.nodes[0], edge.nodes[1]);
    const unsigned int f = edge.faces[0], g = edge.faces[1];
    const Vec3         y =
      curve == invalid_index ? surface.on_region(features.region_of_face[f], x) : surface.on_curve(curve, x);
    for (const unsigned int face : {f, g})
      if (const auto &plane = mesh.patches[mesh.faces[face].patch].symmetry)
        off_plane = std::max(off_plane, std::abs((y - plane->point) * plane->normal));
    if (mesh.patches[mesh.faces[f].patch].name != "side" && mesh.patches[mesh.faces[g].patch].name != "side")
      continue;
    const bool is_rim = curve != invalid_index;
    before[is_rim]    = std::max(before[is_rim], std::abs(std::hypot(x[0], x[1]) - 20));
    after[is_rim]     = std::max(after[is_rim], std::abs(std::hypot(y[0], y[1]) - 20));
  }
  std::cout << title
            << ": lifted to 10 % of the chord's error on the side: " << yes(after[0] < 0.1 * before[0])
            << ", on the rim: " << yes(after[1] < 0.1 * before[1])
            << ", on the planes: " << yes(off_plane < 1e-13) << "\n";
  measured() << title << " " << before[0] << " " << after[0] << " " << before[1] << " " << after[1] << "\n";
}

// A die fills x > 19.5, where the cylinder reaches 20; the plane y = 0 holds all the same.
void leave_die(const TetMesh &mesh)
{
  const PushOut         leave = [](const Vec3 &x) { return x[0] > 19.5 ? Vec3({19.5, x[1], x[2]}) : x; };
  const SurfaceFeatures features(mesh, mesh.X, 40, 45);
  const OldSurface      surface(mesh, mesh.X, features, leave), free(mesh, mesh.X, features, {});
  double                inside[2] = {0, 0}, moved = 0, off_plane = 0;
  for (unsigned int f = 0; f < mesh.faces.size(); ++f)
  {
    const auto &n = mesh.faces[f].nodes;
    const Vec3  x = (mesh.X[n[0]] + mesh.X[n[1]] + mesh.X[n[2]]) / 3.;
    const Vec3  y = surface.on_region(features.region_of_face[f], x);
    const Vec3  z = free.on_region(features.region_of_face[f], x);
    inside[0]     = std::max(inside[0], z[0] - 19.5);
    inside[1]     = std::max(inside[1], y[0] - 19.5);
    moved         = std::max(moved, z[0] < 19.5 ? (y - z).norm() : 0.);
    if (const auto &plane = mesh.patches[mesh.faces[f].patch].symmetry)
      off_plane = std::max(off_plane, std::abs((y - plane->point) * plane->normal));
  }
  std::cout << "die: new nodes inside it, without pushing: " << yes(inside[0] > 0.1)
            << ", none with: " << yes(inside[1] < 1e-14) << "; others stay: " << yes(moved == 0)
            << ", on the planes: " << yes(off_plane < 1e-13) << "\n";
}

void volume_corrections()
{
  TetMesh      mesh   = cylinder("6", "");
  const auto   X      = mesh.X;
  const double wanted = 1.002 * volume(mesh.cells, mesh.X);
  const double moved  = correct_volume(mesh, wanted, std::vector<bool>(mesh.n_nodes(), false), 40.).distance;
  double       ends = 0, most = 0;
  for (NodeIndex node = 0; node < mesh.n_nodes(); ++node)
  {
    most = std::max(most, (mesh.X[node] - X[node]).norm());
    if (X[node][2] == 0 || X[node][2] == 30)
      ends = std::max(ends, std::abs(mesh.X[node][2] - X[node][2]));
  }
  // d = dV / area of the side, 0.002 pi r^2 H / (2 pi r H) = 0.001 r = 0.02, a little less for the polygon.
  std::cout << "cylinder swollen by 0.2 %: moved " << std::round(1000 * moved) / 1000
            << ", as told: " << yes(std::abs(most / moved - 1) < 1e-12) << ", ends stay: " << yes(ends == 0)
            << ", volume: " << yes(std::abs(volume(mesh.cells, mesh.X) / wanted - 1) < 2e-14) << "\n";
  TetMesh      box    = kuhn_box(3, 0.);
  const double bigger = 1.001 * volume(box.cells, box.X);
  correct_volume(box, bigger, std::vector<bool>(box.n_nodes(), false), 40.);
  std::cout << "box swollen by 0.1 %: volume: "
            << yes(std::abs(volume(box.cells, box.X) / bigger - 1) < 2e-14) << "\n";
}

int main(int argc, char **argv)
{
  measured(argc > 1);
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  count_features("box", billet({{"element size", "15"}}));
  TetMesh plain = kuhn_box(3, 0.2);
  add_one_patch(plain);
  count_features("box of one patch", plain);
  // The rounding of a die cuts off the middle of the edge x = 0, z = 3.
  count_features("the same, one edge partly within a die", plain, [](const Vec3 &x) {
    return std::hypot(x[0], x[2] - 3) < 0.5 && std::abs(x[1] - 1.5) < 0.5 ? x + Vec3({0.1, 0, -0.1}) : x;
  });
  count_features("cylinder", cylinder("6", ""));
  const TetMesh quarter = cylinder("6", "-1, 0, 0; 0, -1, 0");
  count_features("quarter", quarter);
  search_tree();
  lift("cylinder", cylinder("6", ""));
  lift("quarter", quarter);
  leave_die(quarter);
  volume_corrections();
}
