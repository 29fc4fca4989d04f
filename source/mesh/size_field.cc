// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/mesh/size_field.h>

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/affine_constraints.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace retroforge
{
  namespace
  {
    // A leaf carries the size linearly, so it may be somewhat longer than the size itself.
    constexpr double leaf_per_size = 2.;

    struct Edge
    {
      unsigned int a, b;
      double       length;
    };
  } // namespace

  void SizeBounds::check(const std::string &where) const
  {
    if (smallest > 0 && largest >= smallest && gradient > 0)
      return;
    std::ostringstream what;
    what << "sizes from " << smallest << " to " << largest << ", gradient " << gradient;
    throw Error(where,
                what.str(),
                "0 < smallest size <= largest size and 0 < gradient must hold",
                "set positive sizes in ascending order");
  }

  // Cubes of edge `edge_` side by side, each the root of an octree; a value at each vertex of the leaves.
  class GradedSize::Forest
  {
  public:
    Forest(const Box                                 &region,
           const std::function<double(const Vec3 &)> &wanted,
           const std::vector<Vec3>                   &points,
           const SizeBounds                          &bounds)
        : bounds_(bounds), tree_(dealii::Triangulation<3>::limit_level_difference_at_vertices), dofs_(tree_)
    {
      const auto bounded = [&](const Vec3 &x) {
        return std::clamp(wanted(x), bounds_.smallest, bounds_.largest);
      };
      make_roots(region);
      while (flag(bounded, points))
        tree_.execute_coarsening_and_refinement();
      dofs_.distribute_dofs(dealii::FE_Q<3>(1));
      dealii::DoFTools::make_hanging_node_constraints(dofs_, hanging_);
      hanging_.close();
      set_values(bounded, points);
      limit_gradient();
    }

    unsigned int n_leaves() const { return tree_.n_active_cells(); }

    double value(const Vec3 &x) const
    {
      const auto [leaf, t] = locate(x);
      double sum           = 0;
      for (unsigned int v = 0; v < 8; ++v)
        sum += values_[leaf->vertex_dof_index(v, 0)] * (v & 1 ? t[0] : 1 - t[0]) * (v & 2 ? t[1] : 1 - t[1]) *
               (v & 4 ? t[2] : 1 - t[2]);
      return sum;
    }

  private:
    using Leaf = dealii::DoFHandler<3>::cell_iterator;

    // Roots as long as a leaf of the largest size, or as the region where that is less.
    void make_roots(const Box &region)
    {
      const Vec3   width   = region.upper - region.lower;
      const double longest = std::max({width[0], width[1], width[2], bounds_.smallest});
      edge_                = std::min(leaf_per_size * bounds_.largest, longest);
      origin_              = region.lower;
      dealii::Point<3> upper(origin_);
      for (unsigned int d = 0; d < 3; ++d)
      {
        n_roots_[d] = std::max(1., std::ceil(width[d] / edge_ * (1 - 1e-12)));
        upper[d] += n_roots_[d] * edge_;
      }
      dealii::GridGenerator::subdivided_hyper_rectangle(
        tree_, {n_roots_[0], n_roots_[1], n_roots_[2]}, dealii::Point<3>(origin_), upper);
    }

    // The leaf that contains x, or the closest point of the region, and the coordinates in it from 0 to 1.
    // Roots are numbered with x running fastest, children likewise.
    std::pair<Leaf, std::array<double, 3>> locate(const Vec3 &x) const
    {
      std::array<double, 3>       t;
      std::array<unsigned int, 3> root;
      for (unsigned int d = 0; d < 3; ++d)
      {
        t[d]    = std::clamp((x[d] - origin_[d]) / edge_, 0., static_cast<double>(n_roots_[d]));
        root[d] = std::min(static_cast<unsigned int>(t[d]), n_roots_[d] - 1);
        t[d] -= root[d];
      }
      Leaf cell(&tree_, 0, root[0] + n_roots_[0] * (root[1] + n_roots_[1] * root[2]), &dofs_);
      while (cell->has_children())
      {
        unsigned int child = 0;
        for (unsigned int d = 0; d < 3; ++d)
        {
          t[d] *= 2;
          if (t[d] >= 1)
          {
            child |= 1u << d;
            t[d] -= 1;
          }
        }
        cell = cell->child(child);
      }
      return {cell, t};
    }

    double length(const unsigned int level) const { return std::ldexp(edge_, -static_cast<int>(level)); }

    // Flags leaves that are too long; whether there are any.
    template <typename Size>
    bool flag(const Size &size, const std::vector<Vec3> &points)
    {
      bool any = false;
      for (const auto &cell : tree_.active_cell_iterators())
      {
        double least = size(cell->center());
        for (unsigned int v = 0; v < 8; ++v)
          least = std::min(least, size(cell->vertex(v)));
        if (length(cell->level()) > leaf_per_size * least * (1 + 1e-12))
        {
          cell->set_refine_flag();
          any = true;
        }
      }
      for (const Vec3 &x : points)
      {
        const Leaf leaf = locate(x).first;
        if (length(leaf->level()) > leaf_per_size * size(x) * (1 + 1e-12))
        {
          leaf->set_refine_flag();
          any = true;
        }
      }
      return any;
    }

    template <typename Size>
    void set_values(const Size &size, const std::vector<Vec3> &points)
    {
      values_.assign(dofs_.n_dofs(), 0.);
      for (const auto &cell : dofs_.active_cell_iterators())
        for (unsigned int v = 0; v < 8; ++v)
          if (double &value = values_[cell->vertex_dof_index(v, 0)]; value == 0.)
            value = size(cell->vertex(v));
      for (const Vec3 &x : points)
      {
        const Leaf leaf = locate(x).first;
        for (unsigned int v = 0; v < 8; ++v)
          lower(leaf->vertex_dof_index(v, 0), size(x));
      }
    }

    std::vector<Edge> edges() const
    {
      std::vector<Edge> all;
      for (const auto &cell : dofs_.active_cell_iterators())
        for (unsigned int v = 0; v < 8; ++v)
          for (unsigned int d = 0; d < 3; ++d)
            if (!(v & (1u << d)))
              all.push_back({cell->vertex_dof_index(v, 0),
                             cell->vertex_dof_index(v | (1u << d), 0),
                             length(cell->level())});
      return all;
    }

    // Makes a value at most `bound`. A hanging vertex has the mean of others, which are lowered in its place.
    bool lower(const unsigned int dof, const double bound)
    {
      if (values_[dof] <= bound * (1 + 1e-12))
        return false;
      values_[dof] = bound;
      if (hanging_.is_constrained(dof))
        for (const auto &[other, weight] : *hanging_.get_constraint_entries(dof))
          values_[other] = std::min(values_[other], bound);
      return true;
    }

    // Slopes along all edges of leaves at most gradient/sqrt(3): the components of the gradient of a
    // trilinear function are means of those. Values only fall, and not below the smallest, so the sweeps come
    // to an end.
    void limit_gradient()
    {
      const double slope = bounds_.gradient / std::sqrt(3.);
      const auto   all   = edges();
      for (bool changed = true; changed;)
      {
        changed = false;
        for (unsigned int dof = 0; dof < values_.size(); ++dof)
          if (hanging_.is_constrained(dof))
          {
            values_[dof] = 0;
            for (const auto &[other, weight] : *hanging_.get_constraint_entries(dof))
              values_[dof] += weight * values_[other];
          }
        for (const Edge &e : all)
        {
          changed = lower(e.a, values_[e.b] + slope * e.length) || changed;
          changed = lower(e.b, values_[e.a] + slope * e.length) || changed;
        }
      }
    }

    const SizeBounds                  bounds_;
    Vec3                              origin_;
    double                            edge_ = 0;
    std::array<unsigned int, 3>       n_roots_;
    dealii::Triangulation<3>          tree_;
    dealii::DoFHandler<3>             dofs_;
    dealii::AffineConstraints<double> hanging_;
    std::vector<double>               values_;
  };

  GradedSize::GradedSize(const double uniform) : uniform_(uniform) {}

  GradedSize::GradedSize(const Box                                 &region,
                         const std::function<double(const Vec3 &)> &wanted,
                         const std::vector<Vec3>                   &points,
                         const SizeBounds                          &bounds)
      : uniform_(bounds.largest)
  {
    bounds.check("size field");
    forest_ = std::make_shared<const Forest>(region, wanted, points, bounds);
  }

  double GradedSize::operator()(const Vec3 &x) const
  {
    return forest_ ? forest_->value(x) : uniform_;
  }

  unsigned int GradedSize::n_leaves() const
  {
    return forest_ ? forest_->n_leaves() : 0;
  }
} // namespace retroforge
