// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Sizes from errors, on a box of 8^3 cubes of six cells each whose errors per volume fall by 2^(2p+3) over 4
// in x.
// - Theory: the wanted size is d^(-1/(2p+3)), so it doubles over 4, for both degrees; and the gain is that of
//   Hoelder's inequality, mean(d) / mean(d^(3/(2p+3)))^((2p+3)/3), here by its closed form, but for what the
//   means over neighbours take from the largest errors, which are at a side.
// - As many cells are wanted as a uniform mesh has, before the sizes are graded and after.
// - Bounded, and graded: sizes of two points differ by at most the growth per distance, and nearly that
// somewhere.
// - The search gives what looking at all cells gives, where cells of a wanted size stand alone.
// - The unit of the errors does not count, nor do their last digits. No errors: a uniform size and no gain.

#include "remeshing_test_tools.h"
#include <retroforge/remeshing/error_sizes.h>

#include <cmath>
#include <iostream>

using namespace retroforge;

namespace
{
  constexpr unsigned int n = 8;

  const char *yes(const bool good)
  {
    return good ? "yes" : "NO";
  }

  double middle(const TetMesh &mesh, const CellIndex c)
  {
    double x = 0.;
    for (const NodeIndex k : mesh.cells[c])
      x += 0.25 * mesh.X[k][0];
    return x;
  }

  std::vector<double> falling_errors(const TetMesh &mesh, const unsigned int degree)
  {
    std::vector<double> errors;
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
      errors.push_back(std::exp2(-(2. * degree + 3.) * middle(mesh, c) / 4.));
    return errors;
  }

  double cells_over_uniform(const OptimalSizes &sizes, const std::vector<double> &size, const double uniform)
  {
    double cells = 0., volume = 0.;
    for (CellIndex c = 0; c < size.size(); ++c)
    {
      cells += sizes.volume[c] / std::pow(size[c], 3.);
      volume += sizes.volume[c];
    }
    return cells / volume * std::pow(uniform, 3.);
  }

  // By the continuous field:  d = 2^(-q x/4), q = 2p+3, over x from 0 to 8.
  double closed_gain(const double q)
  {
    const auto   mean = [](const double rate) { return (1. - std::exp(-rate * n)) / (rate * n); };
    const double a    = std::log(2.) / 4.;
    return mean(q * a) / std::pow(mean(3. * a), q / 3.);
  }

  // Of the logarithms of sizes, over the cells between x and x + 1.
  double mean_log(const TetMesh &mesh, const OptimalSizes &sizes, const double x)
  {
    double       sum   = 0.;
    unsigned int count = 0;
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
      if (middle(mesh, c) > x && middle(mesh, c) < x + 1.)
      {
        sum += std::log(sizes.size[c]);
        ++count;
      }
    return sum / count;
  }

  void check_theory(const TetMesh &mesh, const unsigned int degree)
  {
    const SizeBounds bounds   = {0.8, 0.01, 100., 10.};
    const auto       sizes    = optimal_sizes(mesh, mesh.X, falling_errors(mesh, degree), degree, bounds);
    const double     doubling = std::exp(mean_log(mesh, sizes, 6.) - mean_log(mesh, sizes, 2.)) / 2.;
    const double     gain     = sizes.gain / closed_gain(2. * degree + 3.);
    std::cout << "degree " << degree << ": doubles over 4: " << yes(std::abs(doubling - 1.) < 1e-3)
              << ", as many cells: "
              << yes(std::abs(cells_over_uniform(sizes, sizes.size, bounds.uniform) - 1.) < 1e-3)
              << ", the gain: " << yes(gain > 0.9 && gain < 1.) << "\n";
    measured() << doubling << " " << gain << "\n";
  }

  void check_field(const TetMesh &mesh)
  {
    const SizeBounds bounds = {0.8, 0.5, 1.5, 0.15};
    const auto       sizes  = optimal_sizes(mesh, mesh.X, falling_errors(mesh, 1), 1, bounds);
    const ErrorSizes h(sizes, bounds);
    std::mt19937     random(1);
    const auto       point = [&]() {
      return Vec3(
        {4. + 5. * random_number(random), 4. + 5. * random_number(random), 4. + 5. * random_number(random)});
    };
    double steepest = 0., smallest = 1e9, largest = 0.;
    for (unsigned int i = 0; i < 4000; ++i)
    {
      const Vec3 x = point(), y = i % 2 ? point() : x + 0.02 * (point() - x);
      smallest = std::min(smallest, h(x));
      largest  = std::max(largest, h(x));
      steepest = std::max(steepest, std::abs(h(x) - h(y)) / (x - y).norm());
    }
    std::vector<double> graded;
    for (const Vec3 &x : sizes.centre)
      graded.push_back(h(x));
    std::cout << "field: bounded: " << yes(smallest >= bounds.smallest && largest <= bounds.largest)
              << ", changes by at most the growth: " << yes(steepest <= bounds.growth * (1 + 1e-9))
              << ", and by nearly that: " << yes(steepest > 0.95 * bounds.growth) << ", as many cells: "
              << yes(std::abs(cells_over_uniform(sizes, graded, bounds.uniform) - 1.) < 0.02) << "\n";
    measured() << smallest << " " << largest << " " << steepest << "\n";
  }

  // Sizes so far apart that grading from a few small cells decides everything, and no scale is looked for.
  void check_search()
  {
    OptimalSizes sizes;
    std::mt19937 random(2);
    for (unsigned int i = 0; i < 300; ++i)
    {
      sizes.centre.push_back(8. *
                             Vec3({random_number(random), random_number(random), random_number(random)}));
      sizes.volume.push_back(0.01 * (1.5 + random_number(random)));
      sizes.size.push_back(1. + 0.5 * random_number(random));
    }
    const SizeBounds bounds = {10., 1., 1., 0.2}; // the largest bounds the scale: it stays 1
    const ErrorSizes h(sizes, bounds);
    double           worst = 0.;
    for (unsigned int i = 0; i < 2000; ++i)
    {
      const Vec3 x        = 10. * Vec3({random_number(random), random_number(random), random_number(random)});
      double     expected = bounds.largest;
      for (unsigned int c = 0; c < sizes.size.size(); ++c)
        expected =
          std::min(expected,
                   sizes.size[c] +
                     bounds.growth *
                       std::max(0., (x - sizes.centre[c]).norm() - std::cbrt(0.75 * sizes.volume[c] / M_PI)));
      worst = std::max(worst, std::abs(h(x) - expected));
    }
    std::cout << "search: as of all cells: " << yes(worst < 1e-12) << "\n";
  }

  void check_units_and_digits(const TetMesh &mesh)
  {
    const SizeBounds    bounds = {0.8, 0.2, 3., 0.3};
    std::vector<double> errors = falling_errors(mesh, 1);
    const auto          sizes  = optimal_sizes(mesh, mesh.X, errors, 1, bounds);
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
      errors[c] *= 1e6 * (1. + 1e-11 * (c % 7));
    const auto   others      = optimal_sizes(mesh, mesh.X, errors, 1, bounds);
    unsigned int n_different = 0;
    for (CellIndex c = 0; c < mesh.n_cells(); ++c)
      n_different += sizes.size[c] != others.size[c];
    const auto none = optimal_sizes(mesh, mesh.X, std::vector<double>(mesh.n_cells(), 0.), 1, bounds);
    std::cout << "other unit, other last digits: the same: " << yes(n_different <= 3)
              << "; no errors: uniform "
              << yes(none.size == std::vector<double>(mesh.n_cells(), bounds.uniform)) << ", gain "
              << none.gain << "\n";
  }
} // namespace

int main(int argc, char **)
{
  measured(argc > 1);
  const TetMesh mesh = kuhn_box(n, 0.);
  check_theory(mesh, 1);
  check_theory(mesh, 2);
  check_field(mesh);
  check_search();
  check_units_and_digits(mesh);
}
