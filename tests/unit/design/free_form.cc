// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Free form: on a side of a box the modes are cosines, which is known; the side moves along its normal,
// planes next to it and those of symmetry stay planes, also where they are along no axis; of a cylinder all
// modes together are every shape of its side; the volume can be held; what cannot be is refused.

#include <deal.II/base/mpi.h>

#include <retroforge/core/error.h>

#include "design_test_tools.h"

#include <set>

using namespace retroforge;

namespace
{
  constexpr double pi = dealii::numbers::PI;

  std::set<NodeIndex> nodes_on(const TetMesh &mesh, const std::string &patch)
  {
    std::set<NodeIndex> nodes;
    for (const BoundaryFace &face : mesh.faces)
      if (mesh.patches[face.patch].name == patch)
        nodes.insert(face.nodes.begin(), face.nodes.end());
    return nodes;
  }

  NodalVectors<double> moves(const MappedBillet &billet, const std::string &name)
  {
    for (const ShapeParameter &parameter : billet.map.parameters())
      if (parameter.name == name)
        return parameter.direction;
    return {};
  }

  /// A box of 40 x 20 x 30 whose side at x = 20 moves: its modes are products of cosines along y and z.
  void on_a_box(const std::string &element_size)
  {
    const MappedBillet billet({{"shape", "box"},
                               {"size", "40, 20, 30"},
                               {"element size", element_size},
                               {"free form modes", "4"},
                               {"free form patches", "side +x"},
                               {"free form length", "5"}});
    const auto         side = nodes_on(billet.mesh, "side +x"), top = nodes_on(billet.mesh, "top");
    std::cout << "box, elements of " << element_size << " mm\n";
    // Half waves along y (20 mm) and z (30 mm), by their eigenvalues.
    const std::vector<std::array<int, 2>> waves = {{{0, 0}}, {{0, 1}}, {{1, 0}}, {{1, 1}}};
    double                                off = 0., along = 0., planes = 0., steepest = 0.;
    for (unsigned int i = 0; i < waves.size(); ++i)
    {
      const auto   d = moves(billet, "free form " + std::to_string(i + 1));
      const double a = waves[i][0] * pi / 20., b = waves[i][1] * pi / 30.;
      const double size =
        std::pow(2., 0.5 * (waves[i][0] + waves[i][1])) / std::sqrt(1. + 25. * (a * a + b * b));
      double sign = 0.;
      for (const NodeIndex k : side)
      {
        const Vec3  &X     = billet.mesh.X[k];
        const double exact = size * std::cos(a * (X[1] + 10.)) * std::cos(b * X[2]);
        if (sign == 0. && std::abs(exact) > 0.3)
          sign = d[k][0] * exact > 0. ? 1. : -1.;
      }
      for (const NodeIndex k : side)
      {
        const Vec3  &X     = billet.mesh.X[k];
        const double exact = size * std::cos(a * (X[1] + 10.)) * std::cos(b * X[2]);
        off                = std::max(off, std::abs(sign * d[k][0] - exact));
        along              = std::max(along, std::hypot(d[k][1], d[k][2]));
      }
      for (const NodeIndex k : top)
        planes = std::max(planes, std::abs(d[k][2]));
      for (const Vec3 &move : d)
        steepest = std::max(steepest, move.norm());
    }
    std::cout << "  off the cosines by less than 0.1: " << yes(off < 0.1)
              << "; along the normal: " << yes(along < 1e-12)
              << "; the top stays plane: " << yes(planes < 1e-12)
              << "; nowhere farther than on the side: " << yes(steepest < 1.6) << "\n";
  }

  /// phi_i^T M phi_j over the side of a cylinder, whose normals are radial to the mesh's accuracy.
  void all_of_a_cylinder()
  {
    const Entries entries = {{"shape", "cylinder"},
                             {"radius", "10"},
                             {"height", "12"},
                             {"element size", "4"},
                             {"sector angle", "60"},
                             {"free form patches", "side"}};
    Entries       first   = entries;
    first.push_back({"free form modes", "1"});
    const std::size_t n   = nodes_on(MappedBillet(first).mesh, "side").size();
    Entries           all = entries;
    all.push_back({"free form modes", std::to_string(n)});
    const MappedBillet billet(all);
    const auto         side = nodes_on(billet.mesh, "side");
    // Moves of the side as columns: all shapes are there where they are independent.
    dealii::FullMatrix<double> columns(n, n);
    double                     symmetry = 0.;
    for (unsigned int i = 0; i < n; ++i)
    {
      const auto   d = moves(billet, "free form " + std::to_string(i + 1));
      unsigned int s = 0;
      for (const NodeIndex k : side)
      {
        const Vec3 &X   = billet.mesh.X[k];
        columns(s++, i) = (d[k][0] * X[0] + d[k][1] * X[1]) / 10.;
      }
      NodalVectors<double> moved = billet.mesh.X;
      for (std::size_t k = 0; k < moved.size(); ++k)
        moved[k] += d[k];
      symmetry = std::max(symmetry, symmetry_defect_at(billet.mesh, moved));
    }
    dealii::FullMatrix<double> inverse(n, n);
    inverse.invert(columns);
    std::cout << "sector of a cylinder, as many modes as nodes: any shape of the side, condition below 1000: "
              << yes(columns.frobenius_norm() * inverse.frobenius_norm() < 1000. * n)
              << "; planes of symmetry, along no axis, stay: " << yes(symmetry < 1e-11) << "\n";
  }

  void with_volume()
  {
    const MappedBillet billet({{"shape", "profile"},
                               {"control points", "20, 0; 22, 7; 22, 13; 20, 20"},
                               {"element size", "6"},
                               {"sector angle", "90"},
                               {"free form modes", "6"},
                               {"free form patches", "side outer"},
                               {"volume held by", "free form 1"}});
    double             volume = 0., error = 0.;
    bool               sound = true;
    for (unsigned int j = 0; j < billet.nominal.size(); ++j)
    {
      if (billet.map.parameters()[j].name.rfind("free form", 0) != 0)
        continue;
      const auto mu = billet.changed(j, 1.);
      const auto X  = billet.map.positions(mu);
      volume        = std::max(volume, relative_change_of_volume(billet, X));
      error         = std::max(error, derivative_error(billet.map, mu, j));
      sound &= minimum_quality(billet.mesh.cells, X) > 0.1;
    }
    std::cout << "profile, volume held by the first mode: volume kept: " << yes(volume < 1e-10)
              << "; differences below 1e-8: " << yes(error < 1e-8) << "; mesh sound: " << yes(sound)
              << "; identity at zero: " << yes(is_identity(billet)) << "\n";
  }

  void refused(const Entries &entries)
  {
    try
    {
      MappedBillet{entries};
      std::cout << "NOT REFUSED\n";
    }
    catch (const Error &error)
    {
      std::cout << error.what() << "\n";
    }
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  on_a_box("4");
  on_a_box("2.5");
  all_of_a_cylinder();
  with_volume();
  refused({{"shape", "box"}, {"free form modes", "3"}});
  refused({{"shape", "box"}, {"free form modes", "3"}, {"free form patches", "sides"}});
  refused(
    {{"shape", "box"}, {"element size", "25"}, {"free form modes", "999"}, {"free form patches", "top"}});
}
