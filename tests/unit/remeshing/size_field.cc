// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Graded sizes near surfaces.
// - Plane: of a sheet [-1, 1]^2 in z = 0 one half, x < 0, wants 0.5, the other 2, the growth is 0.3. Over the
//   first the size is 0.5 + 0.3 |z|, on the other at x it is 0.5 + 0.3 x, far away 2; by hand.
// - Bumpy sphere: the search gives what looking at all facets gives, whatever their sizes, bit for bit; sizes
//   change by at most the growth per distance, and by more than 0.99 of it somewhere.
// - Facets that want the largest size or more are not looked at, and nothing is left when all do.

#include <retroforge/core/error.h>
#include <retroforge/mesh/point_location.h>
#include <retroforge/remeshing/size_field.h>

#include <algorithm>

#include "../element/element_test_tools.h"
#include "../geometry/geometry_test_tools.h"

using namespace retroforge;

void check_plane()
{
  const TriangleSurface flat = sheet(4, [](double, double) { return 0.; });
  std::vector<double>   size;
  for (const Triangle &t : flat.triangles())
    size.push_back(flat.vertices()[t[0]][0] + flat.vertices()[t[1]][0] + flat.vertices()[t[2]][0] < 0 ? 0.5
                                                                                                      : 2);
  const GradedSize h(flat, size, 2, 0.3);
  std::cout << "plane: " << h.n_facets() << " of " << flat.n_facets() << " facets;";
  for (const Vec3 &x : {Vec3({-0.5, 0.2, 0}),
                        Vec3({-0.5, 0.2, 1}),
                        Vec3({-0.5, 0.2, -1}),
                        Vec3({0.5, 0.2, 0}),
                        Vec3({0.3, 0.2, 0.4}),
                        Vec3({-4, 0.2, 4}),
                        Vec3({9, 0, 0})})
    std::cout << " " << h(x);
  std::cout << "\n";
}

double of_all(const TriangleSurface     &surface,
              const std::vector<double> &size,
              const double               largest,
              const double               growth,
              const Vec3                &x)
{
  double h = largest;
  for (unsigned int f = 0; f < surface.n_facets(); ++f)
  {
    const auto               &t = surface.triangles()[f];
    const std::array<Vec3, 3> p = {
      {surface.vertices()[t[0]], surface.vertices()[t[1]], surface.vertices()[t[2]]}};
    const auto w = closest_on_triangle(x, p);
    h            = std::min(h, size[f] + growth * (w[0] * p[0] + w[1] * p[1] + w[2] * p[2] - x).norm());
  }
  return h;
}

void check_bumpy()
{
  const TriangleSurface surface = bumpy_sphere(3);
  Random                random;
  std::vector<double>   size;
  for (unsigned int f = 0; f < surface.n_facets(); ++f)
    size.push_back(0.3 + 0.25 * random.scalar());
  const double     largest = 0.5, growth = 0.4;
  const GradedSize h(surface, size, largest, growth);
  unsigned int     n_wrong = 0, n_largest = 0;
  double           steepest = 0;
  for (unsigned int i = 0; i < 5000; ++i)
  {
    const Vec3 x = 2. * random.vector(), y = x + (i % 2 ? 0.5 : 1e-3) * random.vector();
    n_wrong += h(x) != of_all(surface, size, largest, growth, x);
    n_largest += h(x) == largest;
    steepest = std::max(steepest, std::abs(h(x) - h(y)) / (x - y).norm());
  }
  std::cout << "bumpy sphere: wrong " << n_wrong << ", largest at " << (n_largest > 1000 ? "many" : "FEW")
            << ", changes by at most the growth: " << yes(steepest <= growth * (1 + 1e-9))
            << ", and by nearly that: " << yes(steepest > 0.99 * growth) << "\n";
}

void check_nothing_wanted()
{
  const TriangleSurface surface = cube();
  const GradedSize      h(surface, std::vector<double>(surface.n_facets(), 3.5), 3.5, 0.3);
  std::cout << "nothing wanted: " << h.n_facets() << " facets, size " << h(Vec3({1, 2, 3})) << "\n";
}

void check_error(const std::vector<double> &size, const double largest, const double growth)
{
  try
  {
    GradedSize(cube(), size, largest, growth);
    std::cout << "nothing thrown\n";
  }
  catch (const Error &error)
  {
    std::cout << error.what() << "\n";
  }
}

int main()
{
  check_plane();
  check_bumpy();
  check_nothing_wanted();
  check_error(std::vector<double>(11, 1.), 2, 0.3);
  check_error(std::vector<double>(12, 0.), 2, 0.3);
  check_error(std::vector<double>(12, 1.), 2, -1);
}
