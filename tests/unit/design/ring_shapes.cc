// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The shape of a ring as a function of mu1 to mu4, for a sector of 18 degrees, the whole ring, and a turned
// and shifted sector. Proved, for changes of each mu by 10 % up and down: nodes of the contour lie on the
// contour of the changed measures, no tetrahedron is inverted (its quality stays above 0.15), symmetry planes
// stay; dX_0/dmu agrees with differences (151) to 1e-8; with `volume held by = mu4` the volume of the mesh
// stays to 1e-10, and the derivative of mu4 is that of the formulas of the body, -(dV/dmu4)^-1 dV/dmu (126),
// but for the chords of the mesh.

#include <deal.II/base/mpi.h>

#include "../billet/ring_equations.h"
#include "design_test_tools.h"

using namespace retroforge;

// In the ring's own axes, for billets at rest.
double
contour_defect(const MappedBillet &billet, const std::vector<double> &mu, const NodalVectors<double> &X)
{
  RingProfile ring = billet.parameters.ring;
  for (unsigned int j = 0; j < mu.size(); ++j)
    ring.mu[j] = mu[j];
  if (!billet.parameters.volume_held_by.empty())
    ring.mu[3] = billet.map.held_value(mu);
  double worst = 0.;
  for (const BoundaryFace &face : billet.mesh.faces)
    if (billet.mesh.is_surface(face))
      for (const NodeIndex node : face.nodes)
        worst = std::max(worst, ring_defect(billet.mesh.patches[face.patch].name, ring, X[node]));
  return worst;
}

// dmu4/dmu_j of the body, by differences.
double held_slope_of_body(const RingProfile &ring, const unsigned int j)
{
  const auto slope = [&](const unsigned int i) {
    auto up = ring.mu, down = ring.mu;
    up[i] += 1e-4;
    down[i] -= 1e-4;
    return (volume_per_radian(ring, up) - volume_per_radian(ring, down)) / 2e-4;
  };
  return -slope(j) / slope(3);
}

void report(const std::string &title, Entries entries)
{
  entries.push_back({"shape", "ring"});
  const MappedBillet billet(entries);
  const bool         at_rest = billet.parameters.translation.norm() == 0.;
  std::cout
    << title << "\n  identity at the nominal values: " << yes(is_identity(billet))
    << "\n  parameter, differences below 1e-8, Dual has the values, contour, symmetry, volume kept, least "
       "quality at -10 % and +10 %\n";
  for (unsigned int j = 0; j < billet.nominal.size(); ++j)
  {
    double      contour = 0., symmetry = 0., volume = 0.;
    std::string quality;
    for (const double change : {-0.1, 0.1})
    {
      const auto mu = billet.changed(j, change * billet.nominal[j]);
      const auto X  = billet.map.positions(mu);
      contour       = at_rest ? std::max(contour, contour_defect(billet, mu, X)) : 0.;
      symmetry      = std::max(symmetry, symmetry_defect_at(billet.mesh, X));
      volume        = std::max(volume, relative_change_of_volume(billet, X));
      quality += minimum_quality(billet.mesh.cells, X) > 0.15 ? " good" : " POOR";
    }
    const auto   off = billet.changed(j, 0.04 * billet.nominal[j]);
    const double error =
      std::max(derivative_error(billet.map, billet.nominal, j), derivative_error(billet.map, off, j));
    std::cout << "  " << billet.map.parameters()[j].name << ' ' << yes(error < 1e-8) << ' '
              << yes(dual_defect(billet.map, off) < 1e-13) << ' ' << (at_rest ? yes(contour < 1e-11) : "-")
              << ' ' << yes(symmetry < 1e-11) << ' ' << (volume < 1e-10 ? "yes" : "no") << quality;
    if (!billet.parameters.volume_held_by.empty())
    {
      std::vector<Dual> mu(billet.nominal.begin(), billet.nominal.end());
      mu[j].fastAccessDx(0) = 1.;
      const double slope    = billet.map.held_value(mu).dx(0),
                   body     = held_slope_of_body(billet.parameters.ring, j);
      std::cout << ", dmu4/dmu that of the body: " << yes(std::abs(slope - body) < 0.01);
    }
    std::cout << "\n";
  }
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  report("sector of 18 degrees", {{"sector angle", "18"}, {"element size", "3"}});
  report("sector of 18 degrees, volume held",
         {{"sector angle", "18"}, {"element size", "3"}, {"volume held by", "mu4"}});
  report("whole, volume held", {{"element size", "5"}, {"volume held by", "mu4"}});
  report("turned and shifted, volume held by mu4",
         {{"sector angle", "90"},
          {"element size", "5"},
          {"base centre", "1, 2, 3"},
          {"rotation axis", "1, 1, 0"},
          {"rotation angle", "40"},
          {"translation", "5, -3, 2"},
          {"volume held by", "mu4"}});
}
