// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/contact/edge_points.h>

#include <algorithm>
#include <map>

namespace retroforge
{
  namespace
  {
    /// Ends of edges, by pairs, and how far a die bulges in between.
    class EdgeEnds
    {
    public:
      explicit EdgeEnds(const std::vector<ContactPair> &pairs)
          : ends_(pairs.size(), {{invalid_index, invalid_index}})
      {
        std::map<std::pair<unsigned int, NodeIndex>, unsigned int> of_node;
        for (unsigned int p = 0; p < pairs.size(); ++p)
          if (pairs[p].point.is_node())
            of_node[{pairs[p].die, pairs[p].point.nodes[0]}] = p;
        for (unsigned int p = 0; p < pairs.size(); ++p)
          if (!pairs[p].point.has_own_velocity())
            for (unsigned int i = 0; i < 2; ++i)
              if (const auto found = of_node.find({pairs[p].die, pairs[p].point.nodes[i]});
                  found != of_node.end())
                ends_[p][i] = found->second;
      }

      /// For the pair of an edge without a velocity of its own, the pairs of its ends; invalid_index for an end that
      /// does not see the die, and for all other pairs.
      const std::array<unsigned int, 2> &operator[](const unsigned int m) const { return ends_[m]; }

      /// Whether both ends see the die.
      bool both(const unsigned int m) const
      {
        return ends_[m][0] != invalid_index && ends_[m][1] != invalid_index;
      }

      /// b_m [mm]
      template <typename Number>
      Number bulge(const ContactSet<Number> &contact, const unsigned int m) const
      {
        const auto delta = [&](const unsigned int p) { return contact.projections[p].delta; };
        return 0.5 * (delta(ends_[m][0]) + delta(ends_[m][1])) - delta(m);
      }

      /// Adds those of b_m, the derivative in which is bulge_bar.
      void reverse_bulge(const unsigned int m, const double bulge_bar, std::vector<double> &gaps_bar) const
      {
        for (const unsigned int end : ends_[m])
          gaps_bar[end] += 0.5 * bulge_bar;
        gaps_bar[m] -= bulge_bar;
      }

    private:
      std::vector<std::array<unsigned int, 2>> ends_;
    };

    /// (pair of a node, pair of an edge at it), in a fixed order; as often as the edge stands at the node in
    /// the whole, so that a sector's nodes touch as those of the whole do.
    std::vector<std::array<unsigned int, 2>> touched_by_edges(const Topology                 &topology,
                                                              const std::vector<ContactPair> &pairs)
    {
      const EdgeEnds                           ends(pairs);
      std::vector<std::array<unsigned int, 2>> touched;
      for (unsigned int p = 0; p < pairs.size(); ++p)
        if (const ContactPoint &point = pairs[p].point; !point.has_own_velocity())
        {
          const auto &edges = topology.surface_edges;
          const auto  edge  = std::lower_bound(edges.begin(), edges.end(), point.nodes);
          AssertThrow(edge != edges.end() && *edge == point.nodes, dealii::ExcInternalError());
          for (unsigned int i = 0; i < 2; ++i)
            if (ends[p][i] != invalid_index)
              touched.insert(touched.end(), topology.edge_images[edge - edges.begin()][i], {{ends[p][i], p}});
        }
      return touched;
    }

    /// The parts g_m with which edges that touch count for their ends (FrictionRamp): all where an end does not see the
    /// die, and where ramps are sharp.
    class BulgingParts
    {
    public:
      BulgingParts(const std::vector<ContactPair> &pairs, const FrictionRamp &ramp)
          : ramp_(ramp), ends_(pairs)
      {
      }

      template <typename Number>
      Number operator()(const ContactSet<Number> &contact, const unsigned int m) const
      {
        return is_whole(m) ? Number(1.)
                           : ramp_.part_of_edge(Number(ends_.bulge(contact, m) / contact.scales[m]));
      }

      /// Adds the derivatives of  part_bar * (*this)(contact, m).
      void reverse(const ContactSet<double> &contact,
                   const unsigned int        m,
                   const double              part_bar,
                   std::vector<double>      &gaps_bar,
                   std::vector<double>      &scales_bar) const
      {
        if (is_whole(m))
          return;
        const double s = contact.scales[m], b = ends_.bulge(contact, m),
                     slope = part_bar * ramp_.slope_of_edge(b / s) / s;
        ends_.reverse_bulge(m, slope, gaps_bar);
        scales_bar[m] -= slope * b / s;
      }

    private:
      bool is_whole(const unsigned int m) const { return ramp_.sharp || !ends_.both(m); }

      FrictionRamp ramp_;
      EdgeEnds     ends_;
    };
  } // namespace

  template <typename Number>
  void let_edges_touch(const Topology &topology, const FrictionRamp &ramp, ContactSet<Number> &contact)
  {
    contact.touched_by_edges = touched_by_edges(topology, contact.pairs);
    const BulgingParts part_of(contact.pairs, ramp);
    for (const auto &[node, edge] : contact.touched_by_edges)
      contact.ramps[node] += (1. - contact.ramps[node]) * part_of(contact, edge) * contact.ramps[edge];
  }

  void reverse_edges_touch(const ContactSet<double> &contact,
                           const FrictionRamp       &ramp,
                           std::vector<double>      &ramps_bar,
                           std::vector<double>      &gaps_bar,
                           std::vector<double>      &scales_bar)
  {
    const BulgingParts  part_of(contact.pairs, ramp);
    std::vector<double> at;
    for (unsigned int p = 0; p < contact.pairs.size(); ++p)
      at.push_back(own_ramp(contact, ramp, p, contact.projections[p].delta));
    std::vector<double> before; // of the node, at each step
    for (const auto &[node, edge] : contact.touched_by_edges)
    {
      before.push_back(at[node]);
      at[node] += (1. - at[node]) * part_of(contact, edge) * at[edge];
    }
    for (std::size_t i = contact.touched_by_edges.size(); i-- > 0;)
    {
      const auto &[node, edge] = contact.touched_by_edges[i];
      const double part = part_of(contact, edge), missing_bar = (1. - before[i]) * ramps_bar[node];
      part_of.reverse(contact, edge, missing_bar * at[edge], gaps_bar, scales_bar);
      ramps_bar[edge] += missing_bar * part;
      ramps_bar[node] *= 1. - part * at[edge];
    }
  }

  template void let_edges_touch(const Topology &, const FrictionRamp &, ContactSet<double> &);
  template void let_edges_touch(const Topology &, const FrictionRamp &, ContactSet<Dual> &);
} // namespace retroforge
