// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/types.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace retroforge
{
  /// The smallest box with edges along the axes that contains the points.
  struct BoundingBox
  {
    Vec3 lower, upper;

    explicit BoundingBox(const Vec3 &x) : lower(x), upper(x) {}
    template <std::size_t n>
    explicit BoundingBox(const std::array<Vec3, n> &points) : BoundingBox(points[0])
    {
      for (const Vec3 &x : points)
        include(x);
    }
    void include(const Vec3 &x);
    bool intersects(const BoundingBox &other) const;

    /// Returns the square distance of x to the closest point of the box, 0 inside.
    double square_distance(const Vec3 &x) const
    {
      double square = 0.;
      for (unsigned int i = 0; i < 3; ++i)
      {
        const double outside = std::max({lower[i] - x[i], x[i] - upper[i], 0.});
        square += outside * outside;
      }
      return square;
    }
  };

  /// A binary tree of boxes, each standing for an item of which the caller knows the shape.
  ///
  /// What a search returns does not depend on the shape of the tree: ties are decided by the items' numbers.
  /// Unlike Boost's R-tree, which deal.II hands out, it allocates nothing in a query.
  class BoxTree
  {
  public:
    BoxTree() = default;
    explicit BoxTree(const std::vector<BoundingBox> &boxes);

    /// Numbers of the boxes that contain x, ascending.
    std::vector<unsigned int> containing(const Vec3 &x) const { return intersecting(BoundingBox(x)); }

    /// Numbers of the boxes that have points in common with `box`, ascending.
    std::vector<unsigned int> intersecting(const BoundingBox &box) const;

    /// The item nearest to x, the first of several; invalid_index when there is none.
    /// @param square_distance  of an item to x; the item must lie in its box
    template <typename SquareDistance>
    unsigned int closest(const Vec3 &x, const SquareDistance &square_distance) const
    {
      unsigned int best        = invalid_index;
      double       best_square = std::numeric_limits<double>::max();
      minimise([&](const unsigned int branch) { return box(branch).square_distance(x); },
               [&](const unsigned int item) {
                 const double square = square_distance(item);
                 if (square < best_square || (square == best_square && item < best))
                 {
                   best        = item;
                   best_square = square;
                 }
                 return best_square;
               },
               best_square);
      return best;
    }

    /// Branch and bound: visits at least the items whose value is at most the final bound, promising ones
    /// first.
    /// @param lower  of a branch: no item in it has a smaller value
    /// @param visit  of an item: looks at it and returns the bound from then on, which must not rise
    template <typename Lower, typename Visit>
    void minimise(const Lower &lower, const Visit &visit, double bound) const;

    /// The box of a branch, as `lower` above needs it.
    const BoundingBox &box(const unsigned int branch) const { return branches_[branch].box; }

    /// The smallest of the items' values in each branch.
    std::vector<double> minima(const std::vector<double> &value_of_item) const;

  private:
    // Children of a branch are `left` and `left + 1`; a leaf has left = 0 and items_[begin ... end - 1].
    struct Branch
    {
      BoundingBox  box;
      unsigned int begin, end;
      unsigned int left = 0;
    };

    void split(unsigned int branch, const std::vector<BoundingBox> &boxes);

    std::vector<Branch>       branches_;
    std::vector<unsigned int> items_;
    std::vector<BoundingBox>  boxes_; ///< boxes of items_
  };

  template <typename Lower, typename Visit>
  void BoxTree::minimise(const Lower &lower, const Visit &visit, double bound) const
  {
    if (branches_.empty())
      return;
    using Entry = std::pair<double, unsigned int>; // a branch and its lower bound
    std::array<Entry, 64> open;                    // one per level, and halving 2^32 items takes 32
    unsigned int          n_open = 0;
    open[n_open++]               = {lower(0u), 0u};
    while (n_open > 0)
    {
      const auto [least, b] = open[--n_open];
      if (least > bound)
        continue;
      const Branch &branch = branches_[b];
      if (branch.left == 0)
      {
        for (unsigned int i = branch.begin; i < branch.end; ++i)
          bound = visit(items_[i]);
        continue;
      }
      Entry near = {lower(branch.left), branch.left}, far = {lower(branch.left + 1), branch.left + 1};
      if (far.first < near.first)
        std::swap(near, far);
      open[n_open++] = far;
      open[n_open++] = near;
    }
  }
} // namespace retroforge
