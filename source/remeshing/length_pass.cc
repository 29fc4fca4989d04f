// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/remeshing/collapse.h>
#include <retroforge/remeshing/fit_pass.h>
#include <retroforge/remeshing/length_pass.h>
#include <retroforge/remeshing/peel.h>
#include <retroforge/remeshing/split.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

namespace retroforge
{
  namespace
  {
    struct WeightedEdge
    {
      double    length; ///< relative to the wanted one
      NodeIndex a, b;
      bool      operator<(const WeightedEdge &other) const
      {
        return std::tie(length, a, b) < std::tie(other.length, other.a, other.b);
      }
    };

    // Edges of the cells from `first` on, each once.
    std::vector<std::array<NodeIndex, 2>> edges_of_cells(const EditableMesh &mesh, const CellIndex first)
    {
      std::vector<std::array<NodeIndex, 2>> edges;
      for (CellIndex c = first; c < mesh.n_cells(); ++c)
        if (mesh.is_alive(c))
          for (unsigned int i = 0; i < 4; ++i)
            for (unsigned int j = i + 1; j < 4; ++j)
            {
              const auto [a, b] = std::minmax(mesh.cell(c)[i], mesh.cell(c)[j]);
              edges.push_back({{a, b}});
            }
      std::sort(edges.begin(), edges.end());
      edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
      return edges;
    }

    // All edges, each once, found at its smaller node: no sort, which would take longer than all the rest.
    std::vector<std::array<NodeIndex, 2>> all_edges(const EditableMesh &mesh)
    {
      std::vector<std::array<NodeIndex, 2>> edges;
      edges.reserve(8 * mesh.n_nodes());
      std::vector<NodeIndex> met_from(mesh.n_nodes(), invalid_index);
      for (NodeIndex a = 0; a < mesh.n_nodes(); ++a)
        for (const CellIndex c : mesh.cells_at(a))
          for (const NodeIndex b : mesh.cell(c))
            if (b > a && met_from[b] != a)
            {
              met_from[b] = a;
              edges.push_back({{a, b}});
            }
      return edges;
    }

    template <typename Condition>
    void add_edges(const RemeshingContext &context,
                   const CellIndex         first,
                   std::set<WeightedEdge> &queue,
                   const Condition        &wanted)
    {
      for (const auto &[a, b] : first == 0 ? all_edges(context.mesh) : edges_of_cells(context.mesh, first))
        if (wanted(a, b))
          queue.insert({context.relative_length(a, b), a, b});
    }

    // Quality a change in length may cost: what the quality pass can repair.
    double quality_bound(const RemeshingContext &context, const double before)
    {
      return std::min(before, 0.5 * std::sin(context.parameters.goal_angle * M_PI / 180));
    }

    // Splits do not go below, whatever there was before.
    constexpr double lowest_quality = 0.1;

    std::optional<CavityChange>
    better_collapse(const RemeshingContext &context, const NodeIndex a, const NodeIndex b)
    {
      std::optional<CavityChange> best;
      for (const auto &[from, to] : {std::array<NodeIndex, 2>{{a, b}}, std::array<NodeIndex, 2>{{b, a}}})
      {
        const double before = minimum_quality(context.mesh, context.mesh.cells_at(from));
        auto         change =
          plan_collapse(context, from, to, quality_bound(context, before), context.parameters.longest_edge);
        if (change && (!best || change->quality_after > best->quality_after))
          best = std::move(change);
      }
      return best;
    }

    unsigned int collapse_short_edges(RemeshingContext &context, const CellIndex first)
    {
      const auto is_short = [&](const NodeIndex a, const NodeIndex b) {
        return context.is_shorter(a, b, context.parameters.shortest_edge);
      };
      std::set<WeightedEdge> queue;
      add_edges(context, first, queue, is_short);
      unsigned int n_done = 0;
      while (!queue.empty())
      {
        const WeightedEdge edge = *queue.begin();
        queue.erase(queue.begin());
        if (!context.mesh.is_used(edge.a) || !context.mesh.is_used(edge.b) ||
            !context.mesh.is_edge(edge.a, edge.b))
          continue;
        if (const auto change = better_collapse(context, edge.a, edge.b))
        {
          const CellIndex next = context.mesh.n_cells();
          context.apply(*change);
          add_edges(context, next, queue, is_short);
          ++n_done;
        }
      }
      return n_done;
    }

    using Edge = std::array<NodeIndex, 2>;

    // Returns the edges split: the new nodes are theirs, in this order.
    // @param straight  edges whose new node must reach its place at once
    std::vector<Edge> split_long_edges(RemeshingContext     &context,
                                       const CellIndex       first,
                                       const std::set<Edge> &straight,
                                       const bool            all_straight)
    {
      const auto is_long = [&](const NodeIndex a, const NodeIndex b) {
        return context.is_longer(a, b, context.parameters.longest_edge);
      };
      std::set<WeightedEdge> queue;
      add_edges(context, first, queue, is_long);
      std::vector<Edge> done;
      while (!queue.empty())
      {
        const WeightedEdge edge = *queue.rbegin();
        queue.erase(std::prev(queue.end()));
        if (!context.mesh.is_edge(edge.a, edge.b))
          continue;
        const double before = minimum_quality(context.mesh, context.mesh.cells_at_edge(edge.a, edge.b));
        // Halving an edge at most halves the quality, about; but not time and again.
        const double bound  = std::max(0.3 * before, std::min(0.9 * before, lowest_quality));
        const Edge   nodes  = {{edge.a, edge.b}};
        auto         change = plan_split(context, edge.a, edge.b, bound, SplitAt::middle);
        if (!change)
          if (const auto peel = plan_peel(context, edge.a, edge.b))
          {
            context.apply(*peel);
            continue;
          }
        if (!change && !all_straight && !straight.count(nodes))
          change = plan_split(context, edge.a, edge.b, bound, SplitAt::towards);
        if (change)
        {
          const CellIndex next = context.mesh.n_cells();
          context.apply(*change);
          add_edges(context, next, queue, is_long);
          done.push_back(nodes);
        }
      }
      return done;
    }

    // Splits, and takes back those whose nodes cannot be brought out of the dies.
    unsigned int split_and_fit(RemeshingContext &context, const CellIndex first)
    {
      const EditableMesh     before  = context.mesh;
      const auto             written = context.tape ? std::make_optional(*context.tape) : std::nullopt;
      constexpr unsigned int n_tries = 4;
      std::set<Edge>         straight;
      for (unsigned int i = 0;; ++i)
      {
        const bool all_straight = i == n_tries;
        const auto done         = split_long_edges(context, first, straight, all_straight);
        const auto stuck = all_straight ? std::vector<NodeIndex>() : fit_pass(context, before.n_nodes());
        if (stuck.empty())
          return done.size();
        for (const NodeIndex node : stuck)
          straight.insert(done[node - before.n_nodes()]);
        context.mesh = before;
        if (written)
          *context.tape = *written;
      }
    }
  } // namespace

  void length_pass(RemeshingContext &context, RemeshingReport &report)
  {
    CellIndex first = 0;
    for (unsigned int sweep = 0; sweep < context.parameters.max_sweeps; ++sweep)
    {
      const CellIndex    next      = context.mesh.n_cells();
      const unsigned int collapses = collapse_short_edges(context, first);
      const unsigned int splits    = split_and_fit(context, first);
      report.n_length_collapses += collapses;
      report.n_length_splits += splits;
      if (collapses + splits == 0)
        return;
      first = next;
    }
  }
} // namespace retroforge
