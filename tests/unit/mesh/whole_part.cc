// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// How often a model stands in the whole part, by planes through an edge or a corner: by hand 1, 2, 4 and 8 of
// a box; 360 degrees over the angle of a sector, also where no whole number of reflections makes a turn
// (120); across a plane normal to the die's path its force is another die's. What repeats without end has no
// whole.

#include <retroforge/mesh/whole_part.h>

#include <cmath>
#include <iostream>

using namespace retroforge;

namespace
{
  Plane plane(const double degrees)
  {
    const double angle = degrees * dealii::numbers::PI / 180.;
    return {Vec3(), Vec3({std::cos(angle), std::sin(angle), 0.})};
  }

  void show(const std::string &what, const std::vector<Plane> &planes, const Vec3 &path = Vec3({0., 0., -3.}))
  {
    TetMesh mesh;
    for (const Plane &cut : planes)
    {
      mesh.patches.emplace_back();
      mesh.patches.back().symmetry = cut;
    }
    const WholePart whole = whole_part(mesh, path);
    std::cout << what << ": " << whole.copies << " copies, force times " << whole.force << '\n';
  }
} // namespace

int main()
{
  const Plane x = plane(180.), y = plane(-90.), z{Vec3(), Vec3({0., 0., -1.})};
  show("no plane", {});
  show("half", {x});
  show("quarter", {x, y});
  show("quarter of two patches on a plane", {x, y, x});
  show("eighth", {x, y, z});
  show("half, cut across the path", {z});
  for (const double sector : {120., 90., 60., 36., 70.})
    show("sector of " + std::to_string(static_cast<int>(sector)), {y, plane(sector + 90.)});
  show("sector of 60, cut across", {y, plane(150.), z});
  show("slab", {plane(0.), plane(180.)});
  show("prism", {plane(0.), plane(120.), plane(240.)});
  show("oblique to the path", {x}, Vec3({1., 0., -1.}));
}
