// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/types.h>

#include <array>
#include <vector>

namespace retroforge
{
  enum class NodeKind
  {
    interior,
    surface, ///< inside one region
    ridge,   ///< on one curve
    corner
  };

  /// Faces seen from one point: with it as fourth corner each makes a positively oriented cell.
  using Cavity = std::vector<std::array<NodeIndex, 3>>;

  /// A step of a search that raised the quality.
  struct SearchStep
  {
    double       part;      ///< of the size of the cavity
    unsigned int direction; ///< of those that its place allows
  };

  /// How the position of a node was found, with the decisions on the way, so that it can be found again at other
  /// positions of the nodes around.
  struct Placement
  {
    enum class How
    {
      put,     ///< in its place
      towards, ///< a part of the way there
      search   ///< from its place (of a new node) or where it was, by steps
    };

    How                      how = How::put;
    std::array<NodeIndex, 2> between =
      {}; ///< begins in the middle of two nodes, or at one that is named twice
    NodeKind                kind    = NodeKind::interior; ///< with the feature the place, see Place
    unsigned int            feature = static_cast<unsigned int>(-1);
    double                  part    = 1.;
    Cavity                  cavity;   ///< of a search
    unsigned int            axis = 0; ///< that its directions are found by
    std::vector<SearchStep> steps;
  };
} // namespace retroforge
