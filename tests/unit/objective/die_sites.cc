// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Sites on a die that gather what contact points spend. Proved:
// - on a plane, in any direction, and on facets, what is spent evenly gives an even density, its amount per area, and none
//   beyond the reach;
// - sites of a sector have the densities of the whole: a quarter, a sector of 60 degrees and half a box, with all images of the points in the
//   whole, to rounding; a plane across the path of the press has no images;
// - sites stay where they are when the billet of another design is larger;
// - sum() is the transpose of gather(): products, and the gradient against dual numbers.

#include <deal.II/base/mpi.h>

#include <retroforge/billet/billet.h>
#include <retroforge/geometry/vector_algebra.h>
#include <retroforge/objective/die_sites.h>

#include "../mesh/block_mesh.h"
#include "objective_test_tools.h"

using namespace retroforge;

namespace
{
  const Vec3       down({0., 0., -1.});
  constexpr double reach = 4., top = 6.;

  TetMesh cylinder(const double sector, const double radius = 9.)
  {
    BilletParameters parameters;
    parameters.shape        = BilletParameters::Shape::cylinder;
    parameters.radius       = radius;
    parameters.height       = top;
    parameters.sector_angle = sector;
    parameters.element_size = 4.;
    return make_billet(parameters, MPI_COMM_WORLD);
  }

  Die upper()
  {
    return {"upper", Vec3({0., 0., top}), down};
  }

  double total(const std::vector<double> &x)
  {
    return std::accumulate(x.begin(), x.end(), 0.);
  }

  /// In the surface of the die around its middle.
  void check_density(const std::string &name,
                     const Die         &die,
                     const Vec3        &middle,
                     const Vec3        &normal,
                     Random            &random)
  {
    const DieSites sites(die, cylinder(0.), down, reach);
    const auto     across = directions_across(normal);
    const auto point = [&](const double a, const double b) { return middle + a * across[0] + b * across[1]; };
    constexpr double    side = 12., step = 0.25;
    std::vector<double> even(sites.size(), 0.), one(sites.size(), 0.);
    for (double a = -side; a < side; a += step)
      for (double b = -side; b < side; b += step)
        sites.gather(point(a, b), step * step, even);
    sites.gather(point(4. * random.scalar(), 4. * random.scalar()), 1., one);
    double       out_of_plane = 0., uneven = 0., beyond = 0.;
    unsigned int inner = 0;
    for (std::size_t s = 0; s < sites.size(); ++s)
    {
      const Vec3 z = sites.places()[s] - middle;
      out_of_plane = std::max(out_of_plane, std::abs(z * normal));
      if (z.norm() < side - reach)
      {
        ++inner;
        uneven = std::max(uneven, std::abs(even[s] - 1.));
      }
      if (z.norm() > std::sqrt(2.) * side + reach)
        beyond = std::max(beyond, even[s]);
    }
    std::cout << name << ": sites: " << (inner > 20 ? "many" : "FEW")
              << ", on the surface: " << (out_of_plane < 1e-12 ? "yes" : "NO")
              << ", an even density is 1 to 0.1 %: "
              << (uneven < 1e-3 ? "yes" : "NO " + std::to_string(uneven))
              << ", and 0 beyond: " << (beyond == 0. ? "yes" : "NO")
              << ", one point reaches some: " << (total(one) > 0. ? "yes" : "NO") << std::endl;
  }

  /// A square of two facets.
  Die facets()
  {
    const double h = 30.;
    return {"upper",
            TriangleSurface("square",
                            {Vec3({-h, -h, top}), Vec3({-h, h, top}), Vec3({h, h, top}), Vec3({h, -h, top})},
                            {{{0, 1, 2}}, {{0, 2, 3}}}),
            3.};
  }

  Vec3 mirrored(const Vec3 &x, const Vec3 &n)
  {
    return x - 2. * (x * n) * n;
  }

  /// The images of a point in planes through the axis, n of them in the whole.
  NodalVectors<double> images(const Vec3 &x, const std::vector<Vec3> &normals)
  {
    NodalVectors<double> all{x};
    for (std::size_t i = 0; i < all.size(); ++i)
      for (const Vec3 &n : normals)
      {
        const Vec3 image = mirrored(all[i], n);
        if (std::none_of(all.begin(), all.end(), [&](const Vec3 &y) { return (y - image).norm() < 1e-9; }))
          all.push_back(image);
      }
    return all;
  }

  void check_sector(const std::string       &name,
                    const TetMesh           &part,
                    const TetMesh           &whole,
                    const std::vector<Vec3> &normals,
                    const std::size_t        n_images,
                    Random                  &random)
  {
    const DieSites      of_part(upper(), part, down, reach), of_whole(upper(), whole, down, reach);
    std::vector<double> densities(of_part.size(), 0.), in_whole(of_whole.size(), 0.);
    bool                as_many = true;
    for (unsigned int i = 0; i < 40; ++i)
    {
      Vec3         x;
      const double amount = 1. + random.scalar();
      do
        x = Vec3({8. * random.scalar(), 8. * random.scalar(), top});
      while (std::any_of(normals.begin(), normals.end(), [&](const Vec3 &n) { return x * n > 0.; }));
      of_part.gather(x, amount, densities);
      const auto all = images(x, normals);
      as_many        = as_many && all.size() == n_images;
      for (const Vec3 &y : all)
        of_whole.gather(y, amount, in_whole);
    }
    double       apart = 0.;
    unsigned int found = 0;
    for (std::size_t s = 0; s < of_part.size(); ++s)
      for (std::size_t t = 0; t < of_whole.size(); ++t)
        if ((of_part.places()[s] - of_whole.places()[t]).norm() < 1e-9)
        {
          apart = std::max(apart, std::abs(densities[s] - in_whole[t]));
          found += in_whole[t] > 0.;
        }
    std::cout << name << ": images: " << (as_many ? "all" : "NOT ALL")
              << ", sites: " << (found > 10 ? "many" : "FEW")
              << ", densities of the whole: " << (apart < 1e-12 ? "yes" : "NO " + std::to_string(apart))
              << std::endl;
  }

  void check_plane_across_the_path(Random &random)
  {
    const TetMesh       half = half_box_mesh(Vec3({10., 8., 6.}), {{3, 6, 4}}); // symmetric at x = 0
    const Die           side("side", Vec3({0., 0., 6.}), down);
    const DieSites      along(side, half, down, reach), across(side, half, Vec3({1., 0., 0.}), reach);
    const Vec3          near({0.5, random.scalar(), 6.});
    std::vector<double> with(along.size(), 0.), without(across.size(), 0.);
    along.gather(near, 1., with);
    across.gather(near, 1., without);
    std::cout << "a plane across the path: no images: "
              << (total(without) < 0.8 * total(with) && total(without) > 0.3 * total(with) ? "yes" : "NO")
              << std::endl;
  }

  void check_transpose(Random &random)
  {
    const DieSites      sites(upper(), cylinder(90.), down, reach);
    std::vector<double> weights(sites.size());
    for (double &w : weights)
      w = random.scalar();
    double products = 0., gradients = 0.;
    for (unsigned int i = 0; i < 20; ++i)
    {
      const Vec3    y = Vec3({4., 4., top}) + 4. * random.vector(), dy = random.vector();
      Vector3<Dual> at;
      for (unsigned int c = 0; c < 3; ++c)
      {
        at[c]                 = y[c];
        at[c].fastAccessDx(0) = dy[c];
      }
      std::vector<Dual> densities(sites.size(), Dual(0.));
      sites.gather(at, Dual(1.), densities);
      Dual direct(0.);
      for (std::size_t s = 0; s < weights.size(); ++s)
        direct += weights[s] * densities[s];
      const auto sum = sites.sum(y, weights);
      products       = std::max(products, std::abs(sum.value - direct.val()));
      gradients      = std::max(gradients, std::abs(sum.gradient * dy - direct.dx(0)));
    }
    std::cout << "transpose: products: " << (products < 1e-13 ? "yes" : "NO")
              << ", gradients: " << (gradients < 1e-13 ? "yes" : "NO") << std::endl;
  }

  void check_fixed()
  {
    const DieSites small(upper(), cylinder(90.), down, reach),
      large(upper(), cylinder(90., 9.7), down, reach);
    unsigned int missing = 0;
    for (const Vec3 &x : small.places())
      missing += std::none_of(
        large.places().begin(), large.places().end(), [&](const Vec3 &z) { return (x - z).norm() < 1e-12; });
    std::cout << "of a larger billet: all sites of the smaller one: " << (missing == 0 ? "yes" : "NO")
              << std::endl;
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  Random                                   random;
  const Vec3                               tilted = Vec3({0.2, -0.3, -1.}) / Vec3({0.2, -0.3, -1.}).norm();
  check_density("plane", upper(), Vec3({0., 0., top}), down, random);
  check_density("tilted plane", {"upper", Vec3({1., 2., top}), tilted}, Vec3({1., 2., top}), tilted, random);
  check_density("facets", facets(), Vec3({0., 0., top}), down, random);
  const Vec3   x({-1., 0., 0.}), y({0., -1., 0.});
  const double c = 0.5, s = std::sqrt(3.) / 2.;
  check_sector("a quarter", cylinder(90.), cylinder(0.), {x, y}, 4, random);
  check_sector("60 degrees", cylinder(60.), cylinder(0.), {y, Vec3({-s, c, 0.})}, 6, random);
  check_plane_across_the_path(random);
  check_fixed();
  check_transpose(random);
}
