// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/geometry/box_tree.h>

#include <numeric>

namespace retroforge
{
  namespace
  {
    // Looking at an item costs more than looking at a box.
    constexpr unsigned int leaf_size = 1;

    unsigned int longest_axis(const BoundingBox &box)
    {
      const Vec3   width = box.upper - box.lower;
      unsigned int axis  = 0;
      for (unsigned int other = 1; other < 3; ++other)
        if (width[other] > width[axis])
          axis = other;
      return axis;
    }
  } // namespace

  void BoundingBox::include(const Vec3 &x)
  {
    for (unsigned int i = 0; i < 3; ++i)
    {
      lower[i] = std::min(lower[i], x[i]);
      upper[i] = std::max(upper[i], x[i]);
    }
  }

  bool BoundingBox::intersects(const BoundingBox &other) const
  {
    for (unsigned int i = 0; i < 3; ++i)
      if (lower[i] > other.upper[i] || other.lower[i] > upper[i])
        return false;
    return true;
  }

  BoxTree::BoxTree(const std::vector<BoundingBox> &boxes) : items_(boxes.size())
  {
    if (boxes.empty())
      return;
    std::iota(items_.begin(), items_.end(), 0);
    branches_.push_back({boxes[0], 0, static_cast<unsigned int>(boxes.size())});
    for (unsigned int branch = 0; branch < branches_.size(); ++branch)
      split(branch, boxes);
    boxes_.reserve(items_.size());
    for (const unsigned int item : items_)
      boxes_.push_back(boxes[item]);
  }

  // By half of the items, along the longest edge of their box.
  void BoxTree::split(const unsigned int branch, const std::vector<BoundingBox> &boxes)
  {
    const unsigned int begin = branches_[branch].begin, end = branches_[branch].end;
    BoundingBox        box = boxes[items_[begin]];
    for (unsigned int i = begin; i < end; ++i)
    {
      box.include(boxes[items_[i]].lower);
      box.include(boxes[items_[i]].upper);
    }
    branches_[branch].box = box;
    if (end - begin <= leaf_size)
      return;
    const unsigned int axis = longest_axis(box), middle = begin + (end - begin) / 2;
    std::nth_element(items_.begin() + begin,
                     items_.begin() + middle,
                     items_.begin() + end,
                     [&](const unsigned int a, const unsigned int b) {
                       const double x = boxes[a].lower[axis] + boxes[a].upper[axis],
                                    y = boxes[b].lower[axis] + boxes[b].upper[axis];
                       return x != y ? x < y : a < b;
                     });
    branches_[branch].left = branches_.size();
    branches_.push_back({box, begin, middle});
    branches_.push_back({box, middle, end});
  }

  std::vector<unsigned int> BoxTree::intersecting(const BoundingBox &box) const
  {
    std::vector<unsigned int> found, open;
    if (!branches_.empty())
      open.push_back(0);
    while (!open.empty())
    {
      const Branch &branch = branches_[open.back()];
      open.pop_back();
      if (!branch.box.intersects(box))
        continue;
      if (branch.left != 0)
        open.insert(open.end(), {branch.left, branch.left + 1});
      else
        for (unsigned int i = branch.begin; i < branch.end; ++i)
          if (boxes_[i].intersects(box))
            found.push_back(items_[i]);
    }
    std::sort(found.begin(), found.end());
    return found;
  }

  std::vector<double> BoxTree::minima(const std::vector<double> &value_of_item) const
  {
    std::vector<double> smallest(branches_.size());
    for (unsigned int b = branches_.size(); b-- > 0;) // children come after their parents
      if (const unsigned int left = branches_[b].left; left != 0)
        smallest[b] = std::min(smallest[left], smallest[left + 1]);
      else
      {
        smallest[b] = std::numeric_limits<double>::max();
        for (unsigned int i = branches_[b].begin; i < branches_[b].end; ++i)
          smallest[b] = std::min(smallest[b], value_of_item[items_[i]]);
      }
    return smallest;
  }
} // namespace retroforge
