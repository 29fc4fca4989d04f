// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/distributed/tria.h>

#include <deal.II/grid/grid_generator.h>

#include <retroforge/remeshing/size_octree.h>

#include <cmath>
#include <queue>

namespace retroforge
{
  namespace
  {
    using Octree = dealii::parallel::distributed::Triangulation<3>;

    // Leaves are at most this times as large as the smallest length inside. Fields between parallel dies are
    // constant across a leaf, others change by the growth times its edge.
    constexpr double       coarseness = 1.5;
    constexpr unsigned int n_levels   = 20; // keys of three times as many bits

    /// Every third bit of a key.
    std::uint64_t spread(const std::uint32_t i)
    {
      std::uint64_t bits = 0;
      for (unsigned int b = 0; b <= n_levels; ++b)
        bits |= static_cast<std::uint64_t>((i >> b) & 1u) << (3 * b);
      return bits;
    }

    std::uint64_t morton_key(const std::array<std::uint32_t, 3> &lattice)
    {
      return spread(lattice[0]) | (spread(lattice[1]) << 1) | (spread(lattice[2]) << 2);
    }

    BoundingBox box_of(const Octree::active_cell_iterator &cell)
    {
      BoundingBox box(cell->vertex(0));
      box.include(cell->vertex(7));
      return box;
    }

    double width(const BoundingBox &box)
    {
      return box.upper[0] - box.lower[0];
    }

    BoundingBox around(const std::vector<BoundingBox> &boxes)
    {
      Assert(!boxes.empty(), dealii::ExcMessage("an octree has a domain"));
      BoundingBox all = boxes[0];
      for (const BoundingBox &box : boxes)
      {
        all.include(box.lower);
        all.include(box.upper);
      }
      return all;
    }

    /// Whether boxes of a tree meet a box: found without listing them.
    bool meets(const BoxTree &tree, const std::vector<BoundingBox> &boxes, const BoundingBox &box)
    {
      bool       found   = false;
      const auto outside = [&](const BoundingBox &other) { return other.intersects(box) ? 0. : 1.; };
      tree.minimise([&](const unsigned int branch) { return found ? 1. : outside(tree.box(branch)); },
                    [&](const unsigned int item) {
                      found = found || boxes[item].intersects(box);
                      return found ? -1. : 0.;
                    },
                    0.);
      return found;
    }

    /// A cube on a lattice of its own edge's eighth part, so that it holds the box whatever its place.
    std::pair<Vec3, double> root_around(const BoundingBox &box, const double finest)
    {
      const Vec3 extent = box.upper - box.lower;
      double     edge   = finest;
      while (edge * 7. / 8. < *std::max_element(extent.begin_raw(), extent.end_raw()))
        edge *= 2.;
      Vec3 origin;
      for (unsigned int i = 0; i < 3; ++i)
        origin[i] = edge / 8. * std::floor(box.lower[i] / (edge / 8.));
      return {origin, edge};
    }

    /// Divides cubes until each is small enough for what the source may want inside.
    void refine(Octree                         &octree,
                const BoxTree                  &tree,
                const std::vector<BoundingBox> &domain,
                const SizeSource               &source,
                const SizeOctreeLimits         &limits,
                const double                    finest)
    {
      for (bool again = true; again;)
      {
        again = false;
        for (const auto &cell : octree.active_cell_iterators())
        {
          const BoundingBox box  = box_of(cell);
          const double      edge = width(box);
          if (edge < 1.5 * finest || edge <= coarseness * limits.smallest || !meets(tree, domain, box))
            continue;
          const double least = source.below(cell->center(), 0.5 * std::sqrt(3.) * edge);
          if (least >= limits.largest || edge <= coarseness * std::max(least, limits.smallest))
            continue;
          cell->set_refine_flag();
          again = true;
        }
        if (again)
          octree.execute_coarsening_and_refinement();
      }
    }

    /// Lengths at the vertices, the source's where leaves meet the domain.
    std::vector<double> wanted(const Octree                   &octree,
                               const BoxTree                  &tree,
                               const std::vector<BoundingBox> &domain,
                               const SizeSource               &source,
                               const SizeOctreeLimits         &limits)
    {
      std::vector<double> size(octree.n_vertices(), limits.largest);
      std::vector<bool>   known(octree.n_vertices(), false);
      for (const auto &cell : octree.active_cell_iterators())
        if (const BoundingBox box = box_of(cell);
            meets(tree, domain, box) &&
            source.below(cell->center(), 0.5 * std::sqrt(3.) * width(box)) < limits.largest)
          for (const unsigned int v : cell->vertex_indices())
            if (const auto k = cell->vertex_index(v); !known[k])
            {
              known[k] = true;
              size[k]  = std::clamp(source.at(cell->vertex(v)), limits.smallest, limits.largest);
            }
      return size;
    }

    /// Lessens lengths so that between corners of one leaf they change by at most the growth times their
    /// distance: the smallest first, each of which is final when its turn comes.
    void grade(const Octree &octree, const SizeOctreeLimits &limits, std::vector<double> &size)
    {
      std::vector<std::vector<Octree::active_cell_iterator>> around(size.size());
      for (const auto &cell : octree.active_cell_iterators())
        for (const unsigned int v : cell->vertex_indices())
          around[cell->vertex_index(v)].push_back(cell);
      using Entry = std::pair<double, unsigned int>;
      std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue;
      for (unsigned int k = 0; k < size.size(); ++k)
        if (size[k] < limits.largest)
          queue.emplace(size[k], k);
      const auto &x = octree.get_vertices();
      while (!queue.empty())
      {
        const auto [length, k] = queue.top();
        queue.pop();
        if (length > size[k])
          continue;
        for (const auto &cell : around[k])
          for (const unsigned int v : cell->vertex_indices())
          {
            const unsigned int other  = cell->vertex_index(v);
            const double       graded = length + limits.growth * x[k].distance(x[other]);
            if (graded < size[other])
            {
              size[other] = graded;
              queue.emplace(graded, other);
            }
          }
      }
    }
  } // namespace

  SizeOctree::SizeOctree(const std::vector<BoundingBox> &domain,
                         const SizeSource               &source,
                         const SizeOctreeLimits         &limits)
  {
    Assert(limits.smallest > 0. && limits.largest >= limits.smallest && limits.growth > 0.,
           dealii::ExcMessage("lengths and their growth are positive"));
    const double finest       = limits.smallest;
    const auto [origin, edge] = root_around(around(domain), finest);
    origin_                   = origin;
    unit_                     = edge / (1u << n_levels);
    Octree                 octree(MPI_COMM_SELF,
                  dealii::Triangulation<3>::limit_level_difference_at_vertices,
                  Octree::Settings::no_automatic_repartitioning);
    const dealii::Point<3> lower(origin);
    dealii::GridGenerator::hyper_rectangle(octree, lower, lower + edge * dealii::Tensor<1, 3>({1., 1., 1.}));
    const BoxTree tree(domain);
    refine(octree, tree, domain, source, limits, finest);
    std::vector<double> size = wanted(octree, tree, domain, source, limits);
    grade(octree, limits, size);

    leaves_.reserve(octree.n_active_cells());
    for (const auto &cell : octree.active_cell_iterators())
    {
      Leaf                         leaf;
      std::array<std::uint32_t, 3> lattice;
      for (unsigned int i = 0; i < 3; ++i)
        lattice[i] = std::lround((cell->vertex(0)[i] - origin[i]) / unit_);
      leaf.key   = morton_key(lattice);
      leaf.width = 1u << (n_levels - cell->level());
      for (const unsigned int v : cell->vertex_indices())
        leaf.size[v] = size[cell->vertex_index(v)];
      leaves_.push_back(leaf);
    }
    std::sort(leaves_.begin(), leaves_.end(), [](const Leaf &a, const Leaf &b) { return a.key < b.key; });
  }

  const SizeOctree::Leaf &SizeOctree::leaf_at(const std::array<std::uint32_t, 3> &lattice) const
  {
    const auto after = std::upper_bound(
      leaves_.begin(), leaves_.end(), morton_key(lattice), [](const std::uint64_t key, const Leaf &leaf) {
        return key < leaf.key;
      });
    return *std::prev(after);
  }

  double SizeOctree::operator()(const Vec3 &x) const
  {
    std::array<std::uint32_t, 3> lattice;
    std::array<double, 3>        place; // in units
    for (unsigned int i = 0; i < 3; ++i)
    {
      place[i]   = std::clamp((x[i] - origin_[i]) / unit_, 0., std::ldexp(1., n_levels));
      lattice[i] = std::min(static_cast<std::uint32_t>(place[i]), (1u << n_levels) - 1u);
    }
    const Leaf           &leaf = leaf_at(lattice);
    std::array<double, 3> part; // of the leaf's edge
    for (unsigned int i = 0; i < 3; ++i)
    {
      const std::uint32_t lower = lattice[i] / leaf.width * leaf.width;
      part[i]                   = (place[i] - lower) / leaf.width;
    }
    double size = 0.;
    for (unsigned int v = 0; v < 8; ++v)
      size += (v & 1 ? part[0] : 1. - part[0]) * (v & 2 ? part[1] : 1. - part[1]) *
              (v & 4 ? part[2] : 1. - part[2]) * leaf.size[v];
    return size;
  }
} // namespace retroforge
