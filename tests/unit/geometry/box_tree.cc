// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// The tree of boxes against looking at all of them, for 0 to 2000 boxes, some of them points, some the same:
// the boxes that meet a box or contain a point, all and in ascending order; the closest item, of several the
// first; the smallest sum of a value of the item and its distance. A search looks at few items: of 2000 boxes
// whose edges are 5 % of the region, at less than 2 % on the average.

#include <iostream>

#include "../element/element_test_tools.h"
#include "geometry_test_tools.h"

using namespace retroforge;

std::vector<BoundingBox> some_boxes(const unsigned int n, Random &random)
{
  std::vector<BoundingBox> boxes;
  for (unsigned int i = 0; i < n; ++i)
    if (i % 5 == 4)
      boxes.push_back(boxes[i - 2]);
    else
    {
      boxes.emplace_back(random.vector());
      if (i % 3 > 0)
        boxes.back().include(boxes.back().lower + 0.1 * random.vector());
    }
  return boxes;
}

struct Brute
{
  const std::vector<BoundingBox> &boxes;

  std::vector<unsigned int> intersecting(const BoundingBox &box) const
  {
    std::vector<unsigned int> found;
    for (unsigned int i = 0; i < boxes.size(); ++i)
      if (boxes[i].intersects(box))
        found.push_back(i);
    return found;
  }

  unsigned int closest(const Vec3 &x) const
  {
    unsigned int best = invalid_index;
    for (unsigned int i = 0; i < boxes.size(); ++i)
      if (best == invalid_index || boxes[i].square_distance(x) < boxes[best].square_distance(x))
        best = i;
    return best;
  }

  double least(const Vec3 &x, const std::vector<double> &value) const
  {
    double best = 10.;
    for (unsigned int i = 0; i < boxes.size(); ++i)
      best = std::min(best, value[i] + boxes[i].square_distance(x));
    return best;
  }
};

double least(const BoxTree                  &tree,
             const std::vector<BoundingBox> &boxes,
             const Vec3                     &x,
             const std::vector<double>      &value)
{
  const auto minima = tree.minima(value);
  double     best   = 10.;
  tree.minimise(
    [&](const unsigned int b) { return minima[b] + tree.box(b).square_distance(x); },
    [&](const unsigned int i) { return best = std::min(best, value[i] + boxes[i].square_distance(x)); },
    best);
  return best;
}

void compare(const unsigned int n)
{
  Random              random;
  const auto          boxes = some_boxes(n, random);
  const BoxTree       tree(boxes);
  const Brute         brute{boxes};
  unsigned int        n_wrong = 0, n_met = 0;
  unsigned long       n_visited = 0;
  constexpr int       n_points  = 1000;
  std::vector<double> value;
  for (unsigned int i = 0; i < n; ++i)
    value.push_back(random.scalar());
  for (int i = 0; i < n_points; ++i)
  {
    const Vec3  x = 1.3 * random.vector();
    BoundingBox box(x);
    box.include(x + 0.2 * random.vector());
    const auto met = tree.intersecting(box);
    n_met += met.size();
    n_wrong += met != brute.intersecting(box);
    const Vec3 y = n == 0 ? x : boxes[i % n].lower;
    n_wrong += tree.containing(y) != brute.intersecting(BoundingBox(y));
    n_wrong +=
      tree.closest(y, [&](const unsigned int k) { return boxes[k].square_distance(y); }) != brute.closest(y);
    n_wrong += tree.closest(x, [&](const unsigned int k) {
      ++n_visited;
      return boxes[k].square_distance(x);
    }) != brute.closest(x);
    n_wrong += least(tree, boxes, x, value) != brute.least(x, value);
  }
  std::cout << n << " boxes: " << n_met << " met, wrong " << n_wrong << "\n";
  if (n >= 2000)
    std::cout << "looks at less than 2 % of them: " << yes(n_visited < 0.02 * n_points * n) << "\n";
}

int main()
{
  for (const unsigned int n : {0, 1, 2, 3, 4, 7, 100, 2000})
    compare(n);
}
