// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
// Proves: a damaged STL file is refused with an Error, or read as a surface that a die can be made of, whose
// vertices are finite, whose indices exist, and to which distances are numbers.
#include "mutate.h"

#include <retroforge/geometry/die.h>
#include <retroforge/geometry/stl_file.h>

#include <filesystem>

using namespace retroforge;

const std::string file = "damaged.stl";

/// A box without its top: twelve edges, a rim.
TriangleSurface tray()
{
  const NodalVectors<double> X = {Vec3({0., 0., 0.}),
                                  Vec3({4., 0., 0.}),
                                  Vec3({4., 3., 0.}),
                                  Vec3({0., 3., 0.}),
                                  Vec3({-0.1, -0.1, 2.}),
                                  Vec3({4.1, -0.1, 2.}),
                                  Vec3({4.1, 3.1, 2.}),
                                  Vec3({-0.1, 3.1, 2.})};
  std::vector<Triangle>      triangles{{{0, 1, 2}}, {{0, 2, 3}}};
  for (unsigned int i = 0; i < 4; ++i)
  {
    const unsigned int j = (i + 1) % 4;
    triangles.push_back({{i, 4 + i, 4 + j}});
    triangles.push_back({{i, 4 + j, j}});
  }
  return TriangleSurface("tray", X, triangles);
}

std::vector<std::string> whole_files()
{
  std::vector<std::string> files;
  for (const StlFormat format : {StlFormat::ascii, StlFormat::binary})
  {
    write_stl(file, tray(), format);
    files.push_back(fuzz::bytes_of(file));
  }
  std::string solid = files[1];
  solid.replace(0, 5, "solid"); // as some programs begin binary files
  files.push_back(solid);
  files.push_back("SOLID two\n" + files[0].substr(6) + "solid\nendsolid\n");
  return files;
}

void check_surface(const TriangleSurface &surface)
{
  for (const Vec3 &x : surface.vertices())
    fuzz::require(std::isfinite(x.norm()), "a vertex is not finite");
  for (const Triangle &triangle : surface.triangles())
    for (const unsigned int v : triangle)
      fuzz::require(v < surface.vertices().size(), "a vertex does not exist");
  const Die  die("die", surface, 0.1 * surface.diagonal());
  const Vec3 middle = 0.5 * (surface.box().first + surface.box().second);
  for (const Vec3 &x : {Vec3({1., 1., 1.}), middle, surface.vertices()[0]})
  {
    const DieFeature feature = die.closest(x, Vec3());
    if (feature.facet == invalid_index)
      continue;
    fuzz::require(feature.facet < die.n_facets(), "a facet does not exist");
    const Projection<double> projection = die.project(x, Vec3(), feature);
    fuzz::require(std::isfinite(projection.delta) && std::isfinite(projection.n.norm()),
                  "a distance is not finite");
  }
}

int main()
{
  const auto whole = whole_files();
  fuzz::run("STL", file, [&](fuzz::Random &random) {
    fuzz::write_bytes(file, fuzz::mutate(random.one_of(whole), random));
    check_surface(read_stl(file));
  });
  fuzz::run("STL, foreign", file, [&](fuzz::Random &random) {
    std::filesystem::remove_all(file);
    std::string noise(random.below(400), '\0');
    for (char &c : noise)
      c = static_cast<char>(random.below(256));
    if (random.below(20) == 0)
      std::filesystem::create_directory(file);
    else
      fuzz::write_bytes(file,
                        random.below(2) == 0   ? noise
                        : random.below(2) == 0 ? whole[1].substr(0, 84) + noise
                                               : whole[1]);
    check_surface(read_stl(file));
  });
}
