// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// How dies stand to a billet and come against it, by hand: a block of edges 10, x and y from -5 to 5, z from
// 0 to 10, with elements of 5, and
// - a plane, straight and at 45 degrees;
// - a pyramid that hangs over the middle of a face, its tip pointing down: 3 wide 3 above the tip. No node
// sees
//   it come in; 1 deep it is 1 wide in the plane of the face, and its sides lean by atan(1/2): the middle of
//   the section is 0.5 cos(atan(1/2)) = 0.4472 from them, 0.8944 wide;
// - a blade along x over the whole block: only its edge is in the metal, both ends are outside;
// - a blade whose edge falls by 45 degrees and crosses an edge of the block: no vertex of one meets a face of
// the
//   other, and it comes down by 1;
// - the pyramid with its tip in the plane of symmetry of the half block, as on the whole one;
// - the pyramid 0.3 deep in a side: it is free when it goes back by that, but not from the half block, where that is
//   across the plane of symmetry: up it goes by 1.6, until its sides are 5 from the middle below the top face;
// - a bar of 10 radius meshed with edges of 9: billet_surface() is round to a hundredth of what the mesh is.
// The pyramid covers 3 x 3 of the face's 10 x 10; a quarter of that where it stands over a corner; of the
// half block 1.5 x 3 of 5 x 10; from below its roof does. The blade covers 1 x 10, and a plane all.
// After the move that frees a die nothing overlaps, whichever way it was.

#include <deal.II/base/mpi.h>

#include <retroforge/contact/die_approach.h>
#include <retroforge/contact/penetration.h>

#include <cstdio>

#include "../mesh/block_mesh.h"

using namespace retroforge;

namespace
{
  const Vec3 down({0., 0., -1.}), up({0., 0., 1.});

  TetMesh block(const bool half)
  {
    TetMesh mesh = block_mesh(
      {{2, 2, 2}}, [half](const unsigned int i, unsigned int, unsigned int) { return !half || i == 1; });
    for (Vec3 &x : mesh.X)
      x = 5. * x - Vec3({5., 5., 0.});
    if (half)
    {
      mesh.patches.push_back({"symmetry", Plane{Vec3(), Vec3({-1., 0., 0.})}});
      for (BoundaryFace &face : mesh.faces)
        if (std::all_of(
              face.nodes.begin(), face.nodes.end(), [&](const NodeIndex k) { return mesh.X[k][0] == 0.; }))
          face.patch = 2;
    }
    return mesh;
  }

  /// Four sides and a roof; the tip at the origin, below the roof.
  Die pyramid()
  {
    const NodalVectors<double> x = {
      Vec3(), Vec3({1.5, 1.5, 3.}), Vec3({-1.5, 1.5, 3.}), Vec3({-1.5, -1.5, 3.}), Vec3({1.5, -1.5, 3.})};
    return Die(
      "pyramid",
      TriangleSurface(
        "pyramid", x, {{{0, 2, 1}}, {{0, 3, 2}}, {{0, 4, 3}}, {{0, 1, 4}}, {{1, 2, 3}}, {{1, 3, 4}}}),
      10.,
      {false, 25.});
  }

  /// Two sides that meet in an edge through the origin along `edge`, 40 long, and stand up from it by 5.
  Die blade(const Vec3 &edge)
  {
    const Vec3                 along = 20. / edge.norm() * edge, across({0., 0.5, 0.}), above({0., 0., 5.});
    const NodalVectors<double> x     = {-along,
                                        along,
                                        -along + above + across,
                                        along + above + across,
                                        -along + above - across,
                                        along + above - across};
    return Die("blade",
               TriangleSurface("blade", x, {{{0, 2, 1}}, {{1, 2, 3}}, {{0, 1, 4}}, {{1, 5, 4}}}),
               10.,
               {false, 25.});
  }

  void print(const char *what, const Vec3 &x)
  {
    std::printf(", %s (%.4f, %.4f, %.4f)", what, x[0] + 0., x[1] + 0., x[2] + 0.);
  }

  void report(const char         *name,
              const Die          &die,
              const Vec3         &displacement,
              const Vec3         &velocity,
              const Vec3         &facing,
              const MetalSurface &metal)
  {
    const DieApproach approach = find_approach(die, displacement, velocity, facing, metal, 1e-3);
    std::printf("%s: overlap %.4f", name, approach.overlap.depth);
    if (approach.overlap.depth > 0.)
    {
      std::printf(" of %s", approach.overlap.is_of_die ? "the die" : "the metal");
      print("at", approach.overlap.place);
      print("free after", approach.freeing);
      std::printf(", overlap then %.4f", find_overlap(die, displacement + approach.freeing, metal).depth);
    }
    else
    {
      std::printf(", gap %.4f", approach.gap);
      print("at", approach.gap_place);
    }
    if (approach.meeting)
    {
      std::printf(", meets after %.4f", approach.meeting->travel);
      print("at", approach.meeting->place);
    }
    std::printf("%s\n", approach.moves_away ? ", moves away" : "");
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const TetMesh                            mesh  = block(false);
  const MetalSurface                       metal = metal_surface(mesh, mesh.X);

  const Die plane("plane", Vec3({0., 0., 10.}), down);
  report("plane apart", plane, 2. * up, down, down, metal);
  report("plane at 45 degrees", plane, 2. * up, Vec3({1., 0., -1.}), down, metal);
  report("plane that touches", plane, Vec3(), down, down, metal);
  report("plane that moves away", plane, Vec3(), up, down, metal);
  report("plane too low", plane, 0.3 * down, down, down, metal);

  const Die  tip = pyramid();
  const Vec3 beside({0.7, -1.6, 10.});
  report("pyramid apart", tip, beside + 2. * up, 7. * down, down, metal);
  report("pyramid that touches", tip, beside, down, down, metal);
  report("pyramid that moves away", tip, beside + 2. * up, up, down, metal);
  report("pyramid that passes by", tip, Vec3({7., 0., 12.}), down, down, metal);
  report("pyramid in the block", tip, beside + down, down, down, metal);
  report("pyramid that stands in it", tip, beside + down, Vec3(), Vec3({1., 0., 0.}), metal);
  const auto unseen = find_unseen(tip, beside + down, metal);
  std::printf("  which is not seen: %.4f deep, %.4f wide\n", unseen->depth, unseen->width);
  std::printf("  but at a node: %s\n", find_unseen(tip, Vec3({0.1, 0.1, 9.}), metal) ? "no" : "yes");
  const Topology topology(mesh);
  const auto     deepest =
    deepest_point(mesh, topology, {tip}, {{Vec3(), Vec3(beside + down), 0., {}}}, mesh.X, MPI_COMM_WORLD);
  std::printf("  deepest point: %.4f in die %u\n", deepest.depth, deepest.die);

  const Die edge = blade(Vec3({1., 0., 0.}));
  report("blade apart", edge, Vec3({0., 1.3, 11.}), down, down, metal);
  report("blade in the block", edge, Vec3({0., 1.3, 9.6}), down, down, metal);
  const Die falling = blade(Vec3({1., 0., -1.}));
  report("edge over an edge", falling, Vec3({5., 1.3, 11.}), down, down, metal);
  report("edge in an edge", falling, Vec3({5., 1.3, 9.}), down, down, metal);

  const TetMesh      half       = block(true);
  const MetalSurface half_metal = metal_surface(half, half.X);
  report("tip on the whole", tip, Vec3({0., 1.6, 9.5}), down, down, metal);
  report("tip in the plane of symmetry", tip, Vec3({0., 1.6, 9.5}), down, down, half_metal);
  report("pyramid beside the whole", tip, Vec3({6.2, 0., 6.}), down, down, metal);
  report("pyramid beside the half", tip, Vec3({6.2, 0., 6.}), down, down, half_metal);

  std::printf(
    "covered: %.4f above, %.4f over a corner, %.4f of the half, %.4f from below, %.4f by the blade, "
    "%.4f by a plane, %.4f by its back\n",
    covered_part(tip, beside + 2. * up, 7. * down, metal),
    covered_part(tip, Vec3({5., 5., 12.}), down, metal),
    covered_part(tip, Vec3({0., 1.6, 12.}), down, half_metal),
    covered_part(tip, beside - 20. * up, up, metal),
    covered_part(edge, Vec3({0., 1.3, 11.}), down, metal),
    covered_part(plane, Vec3(), down, metal),
    covered_part(plane, Vec3(), up, metal));

  BilletParameters bar;
  bar.shape            = BilletParameters::Shape::cylinder;
  bar.radius           = 10.;
  bar.height           = 40.;
  bar.element_size     = 9.;
  bar.rotations.axis   = Vec3({0., 1., 0.});
  bar.rotations.angle  = 90.;
  bar.translation      = Vec3({0., 0., 10.});
  const TetMesh coarse = make_billet(bar, MPI_COMM_WORLD);
  const auto    bulge  = [](const MetalSurface &surface) {
    double farthest = 0.; // of a face of the side from the circle
    for (unsigned int t = 0; t < surface.triangles().size(); ++t)
    {
      const auto x = surface.corners(t);
      const auto r = [](const Vec3 &p) { return std::hypot(p[1], p[2] - 10.); };
      if (r(x[0]) > 9.99 && r(x[1]) > 9.99 && r(x[2]) > 9.99 &&
          std::abs(x[0][0] - x[1][0]) + std::abs(x[0][0] - x[2][0]) > 1e-9)
        farthest = std::max(farthest, 10. - r((x[0] + x[1] + x[2]) / 3.));
    }
    return farthest;
  };
  const double of_mesh = bulge(metal_surface(coarse, coarse.X)),
               of_bar  = bulge(billet_surface(bar, coarse, coarse.X, 0.005));
  std::printf(
    "bar: faces of the mesh more than 0.3 inside the circle: %s, those of its surface less than 0.01: %s\n",
    of_mesh > 0.3 ? "yes" : "no",
    of_bar < 0.01 ? "yes" : "no");
}
