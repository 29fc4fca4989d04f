// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// A billet meshed anew at other values of its shape: there the map is the identity, bit for bit; values mean
// what they meant, so that from there every other shape has the measures it had, the nominal one too;
// derivatives are those of differences, and the pull-back is their transpose. A free form takes its modes
// along: the surface of the new mesh moves on that of the old one. A mesh that is bad where it is moved to is
// good when it is made anew there. What cannot be is refused.

#include <deal.II/base/mpi.h>

#include <retroforge/core/error.h>
#include <retroforge/design/mesh_anew.h>
#include <retroforge/mesh/point_location.h>

#include "design_test_tools.h"

#include <iomanip>

using namespace retroforge;

namespace
{
  std::vector<double> plus(std::vector<double> values, const std::vector<double> &change)
  {
    for (std::size_t j = 0; j < change.size(); ++j)
      values[j] += change[j];
    return values;
  }

  double farthest(const std::pair<Vec3, Vec3> &a, const std::pair<Vec3, Vec3> &b)
  {
    return std::max((a.first - b.first).norm(), (a.second - b.second).norm());
  }

  /// How far two meshes of one shape may be apart.
  struct Bars
  {
    double extent = 1e-9; ///< [mm]
    double volume = 0.02; ///< relative: sides are cut into other chords
  };

  /// Bounding boxes and volumes of two meshes of one shape.
  void print_same_shape(const Bars                 &bars,
                        const std::string          &what,
                        const TetMesh              &a,
                        const NodalVectors<double> &X_a,
                        const TetMesh              &b,
                        const NodalVectors<double> &X_b)
  {
    const double box    = farthest(bounding_box(X_a), bounding_box(X_b));
    const double change = volume(a.cells, X_a) / volume(b.cells, X_b) - 1.;
    std::cout << "  " << what << ": same extent to " << bars.extent << " mm " << yes(box < bars.extent)
              << ", same volume but for chords " << yes(std::abs(change) < bars.volume) << "\n";
    if (!(box < bars.extent) || !(std::abs(change) < bars.volume))
      std::cout << "  " << box << " mm, " << change << "\n";
  }

  /// |<dX/dmu_j, X_bar> - (pull-back of X_bar)_j| over the largest.
  double pull_back_error(const BilletMap &map, const std::vector<double> &mu)
  {
    NodalVectors<double> X_bar(map.positions(mu).size());
    for (std::size_t k = 0; k < X_bar.size(); ++k)
      X_bar[k] = Vec3({std::sin(1. + k), std::cos(2. + 3. * k), std::sin(0.7 * k)});
    const std::vector<double> bar   = map.pull_back(mu, X_bar);
    double                    error = 0., size = 0.;
    for (unsigned int j = 0; j < mu.size(); ++j)
    {
      const auto dX  = derivative(map, mu, j);
      double     sum = 0.;
      for (std::size_t k = 0; k < dX.size(); ++k)
        sum += dX[k] * X_bar[k];
      error = std::max(error, std::abs(sum - bar[j]));
      size  = std::max(size, std::abs(sum));
    }
    return error / size;
  }

  void print_derivatives(const BilletMap &map, const std::vector<double> &mu)
  {
    double error = 0.;
    for (unsigned int j = 0; j < mu.size(); ++j)
      error = std::max(error, derivative_error(map, mu, j));
    std::cout << "  derivatives: differences to 1e-8 " << yes(error < 1e-8) << ", pull-back to 1e-12 "
              << yes(pull_back_error(map, mu) < 1e-12) << "\n";
  }

  /// @param there  values of all parameters of the shape, the mesh is made at; @param beyond  those of
  /// another
  void with_measures(const Entries             &entries,
                     const std::vector<double> &there,
                     const std::vector<double> &beyond,
                     const Bars                &bars = {})
  {
    const BilletParameters billet = billet_parameters(entries);
    const auto make = [](const BilletParameters &measured) { return make_billet(measured, MPI_COMM_WORLD); };
    const FirstMesh first = first_mesh(billet, make(billet));
    const FirstMesh anew  = meshed_anew(first, there, make);
    const BilletMap old_map(billet, first), map(billet, anew);
    std::cout << entries.front().second
              << "\n  identity where it is made: " << yes(map.positions(there) == anew.mesh.X)
              << ", its worst cell better than the moved one's "
              << yes(map.mesh_quality(there) > old_map.mesh_quality(there)) << "\n";
    print_same_shape(bars, "there", anew.mesh, anew.mesh.X, first.mesh, old_map.positions(there));
    print_same_shape(bars, "beyond", anew.mesh, map.positions(beyond), first.mesh, old_map.positions(beyond));
    print_same_shape(bars, "nominal", anew.mesh, map.nominal_positions(), first.mesh, first.mesh.X);
    print_derivatives(map, beyond);
  }

  /// Of the nodes of each face of the new surface from the old one, patch by patch.
  std::vector<double> distances_of_surfaces(const TetMesh              &old_mesh,
                                            const NodalVectors<double> &X_old,
                                            const TetMesh              &new_mesh,
                                            const NodalVectors<double> &X_new)
  {
    std::vector<double> distances;
    for (const BoundaryFace &face : new_mesh.faces)
      for (const NodeIndex k : face.nodes)
      {
        double nearest = 1e300;
        for (const BoundaryFace &old : old_mesh.faces)
          if (old.patch == face.patch)
          {
            const auto &n = old.nodes;
            const auto  w = closest_on_triangle(X_new[k], {{X_old[n[0]], X_old[n[1]], X_old[n[2]]}});
            const Vec3  p = w[0] * X_old[n[0]] + w[1] * X_old[n[1]] + w[2] * X_old[n[2]];
            nearest       = std::min(nearest, (p - X_new[k]).norm());
          }
        distances.push_back(nearest);
      }
    return distances;
  }

  double largest_difference(const std::vector<double> &a, const std::vector<double> &b)
  {
    double most = 0.;
    for (std::size_t i = 0; i < a.size(); ++i)
      most = std::max(most, std::abs(a[i] - b[i]));
    return most;
  }

  /// A profile whose side moves by modes, the volume held by the first of them.
  void with_free_form()
  {
    const Entries          entries = {{"shape", "profile"},
                                      {"control points", "20, 0; 22, 7; 22, 13; 20, 20"},
                                      {"element size", "5"},
                                      {"sector angle", "90"},
                                      {"free form modes", "5"},
                                      {"free form patches", "side outer"},
                                      {"volume held by", "free form 1"}};
    const BilletParameters billet  = billet_parameters(entries);
    const FirstMesh        first   = first_mesh(billet, make_billet(billet, MPI_COMM_WORLD));
    const BilletMap        old_map(billet, first);
    const ShapeValues      given  = {{"billet/free form 2", 4.}, {"billet/free form 3", -3.}};
    const auto             values = shape_values(billet, first, given);
    Timings                timings;
    const FirstMesh        anew = remeshed(first, values, {}, timings, MPI_COMM_WORLD);
    const BilletMap        map(billet, anew);
    std::vector<double>    there, beyond, nominal;
    for (const ShapeParameter &parameter : map.parameters())
    {
      const auto found = given.find("billet/" + parameter.name);
      nominal.push_back(parameter.nominal);
      there.push_back(found == given.end() ? parameter.nominal : found->second);
      beyond.push_back(parameter.nominal + 1.2 * (there.back() - parameter.nominal));
    }
    const auto X_there = map.positions(there);
    const auto all     = map.all_values(there);
    std::cout << "free form\n  identity where it is made: " << yes(X_there == anew.mesh.X)
              << ", the held mode has the value it had "
              << yes(std::abs(all[first.at.size() - 5] - values[first.at.size() - 5]) < 1e-12)
              << ", symmetry planes kept to 1e-11 "
              << yes(symmetry_defect_at(anew.mesh, map.positions(beyond)) < 1e-11) << "\n  worst cell better "
              << yes(map.mesh_quality(there) > 1.5 * old_map.mesh_quality(there)) << "\n";
    // The mesh is made with nodes on the old surface, whose chords take volume away; then its surface is moved
    // outwards until the volume is the old one but for the rounding of positions. So far off it stays.
    const auto distances = [&](const NodalVectors<double> &X_old, const NodalVectors<double> &X_new) {
      return distances_of_surfaces(first.mesh, X_old, anew.mesh, X_new);
    };
    const auto   X_old  = old_map.positions(there);
    const auto   made   = distances(X_old, X_there);
    const double change = volume(anew.mesh.cells, X_there) / volume(first.mesh.cells, X_old) - 1.;
    const double off    = *std::max_element(made.begin(), made.end());
    const double far  = largest_difference(made, distances(old_map.positions(beyond), map.positions(beyond)));
    const double back = largest_difference(made, distances(first.mesh.X, map.nominal_positions()));
    std::cout << "  where it is made, the volume of the old one to 1e-10: " << yes(std::abs(change) < 1e-10)
              << ", its surface to 5 % of an element: " << yes(off < 0.25)
              << "\n  as far from the old surface beyond, and back at the nominal shape, to 0.5 %: "
              << yes(far < 0.025) << ' ' << yes(back < 0.025) << "\n";
    if (std::abs(change) >= 1e-10 || off >= 0.25 || std::max(far, back) >= 0.025)
      std::cout << change << ' ' << off << ' ' << far << ' ' << back << "\n";
    print_derivatives(map, beyond);
    std::vector<double> wild = values;
    wild.back()              = 60.;
    print_error("turned inside out", [&] { remeshed(first, wild, {}, timings, MPI_COMM_WORLD); });
  }

  void refused()
  {
    const BilletParameters billet = billet_parameters({{"shape", "cylinder"}, {"element size", "20"}});
    const FirstMesh        first  = first_mesh(billet, make_billet(billet, MPI_COMM_WORLD));
    print_error("another shape's", [&] { shape_values(billet, first, {{"billet/mu1", 3.}}); });
    print_error("twice", [&] {
      shape_values(billet, first, {{"billet/radius", 3.}, {"billet/radius", 4.}});
    });
    print_error("no shape", [&] { shape_values(billet, first, {{"billet/radius", -3.}}); });
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  with_measures({{"shape", "box"},
                 {"size", "20, 30, 40"},
                 {"element size", "10"},
                 {"translation", "1, 2, 3"},
                 {"rotation axis", "1, 1, 0"},
                 {"rotation angle", "30"}},
                {40., 20.},
                {45., 15.});
  with_measures({{"shape", "cylinder"},
                 {"radius", "10"},
                 {"height", "30"},
                 {"element size", "6"},
                 {"symmetry planes", "-1, 0, 0; 0, -1, 0"}},
                {30., 15.},
                {33., 12.},
                {1e-9, 0.04}); // a quarter with a few chords around
  const std::vector<double> ring = {45., 19., 30., 25.5};
  with_measures({{"shape", "ring"}, {"sector angle", "18"}, {"element size", "4"}},
                plus(ring, {40., 1., 20., 12.}),
                plus(ring, {42., 2., 22., 13.}));
  with_measures({{"shape", "profile"},
                 {"control points", "20, 0; 26, 15; 26, 30; 20, 45"},
                 {"sector angle", "30"},
                 {"element size", "6"}},
                {40., 0., 60., 15., 20., 30., 50., 45.},
                {44., 0., 66., 14., 18., 31., 55., 47.},
                {0.03, 0.02}); // no node stands where it is widest
  with_free_form();
  refused();
}
