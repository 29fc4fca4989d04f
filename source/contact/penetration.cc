// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/contact/penetration.h>

namespace retroforge
{
  Penetration deepest_point(const TetMesh                       &mesh,
                            const Topology                      &topology,
                            const std::vector<Die>              &dies,
                            const std::vector<DieState<double>> &states,
                            const NodalVectors<double>          &X)
  {
    Penetration deepest;
    const auto  look = [&](const Vec3 &x, const double within) {
      for (unsigned int d = 0; d < dies.size(); ++d)
        if (const double depth = dies[d].depth_of(x, states[d].displacement, within); depth > deepest.depth)
          deepest = {depth, x, d};
    };
    std::vector<double> longest(X.size(), 0.);
    for (const auto &[a, b] : topology.surface_edges)
    {
      const double length = (X[a] - X[b]).norm();
      longest[a]          = std::max(longest[a], length);
      longest[b]          = std::max(longest[b], length);
      look(0.5 * (X[a] + X[b]), length);
    }
    for (NodeIndex k = 0; k < X.size(); ++k)
      if (topology.is_on_surface(k))
        look(X[k], longest[k]);
    for (const BoundaryFace &face : mesh.faces)
      if (mesh.is_surface(face))
        look((X[face.nodes[0]] + X[face.nodes[1]] + X[face.nodes[2]]) / 3.,
             std::max(longest[face.nodes[0]], std::max(longest[face.nodes[1]], longest[face.nodes[2]])));
    return deepest;
  }
} // namespace retroforge
