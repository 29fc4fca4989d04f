// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/contact/level_gaps.h>
#include <retroforge/contact/surface_rates.h>
#include <retroforge/core/shares.h>

#include <algorithm>
#include <map>
#include <set>

namespace retroforge
{
  void reverse_kinematics(const ContactNode<double> &node,
                          const Vec3                &dv_bar,
                          const double               h_bar,
                          ContactNodeBar            &bar)
  {
    const double un = node.u * node.n, dv_n = dv_bar * node.n;
    bar.u += dv_bar - dv_n * node.n + h_bar * node.n;
    bar.n += -un * dv_bar - dv_n * node.u + h_bar * node.u;
    bar.delta -= h_bar * approach_slope(node.delta, node.tau, node.approach);
    bar.tau += h_bar * approach_speed(node.delta, node.tau, node.approach) / node.tau;
  }

  namespace
  {
    /// Returns gap and normal of each pair that is this rank's to project.
    template <typename Number>
    std::vector<Projection<Number>> projections_of(const ContactView<Number>      &view,
                                                   const std::vector<ContactPair> &pairs,
                                                   const std::size_t               begin,
                                                   const std::size_t               end)
    {
      std::vector<Projection<Number>> projections;
      for (std::size_t p = begin; p < end; ++p)
        projections.push_back(view.dies[pairs[p].die].project(
          pairs[p].point.position(view.X), view.states[pairs[p].die], pairs[p].feature));
      return projections;
    }

    std::vector<Projection<double>> projected(const ContactView<double>      &view,
                                              const std::vector<ContactPair> &pairs)
    {
      const auto [begin, end] = share_of_rank(pairs.size(), view.comm);
      std::vector<std::array<double, 4>> numbers;
      for (const auto &[delta, n] : projections_of(view, pairs, begin, end))
        numbers.push_back({{delta, n[0], n[1], n[2]}});
      std::vector<Projection<double>> projections;
      for (const auto &of : joined(std::move(numbers), view.comm))
        projections.push_back({of[0], Vec3({of[1], of[2], of[3]})});
      return projections;
    }

    /// A tangent is carried by all ranks alike.
    std::vector<Projection<Dual>> projected(const ContactView<Dual>        &view,
                                            const std::vector<ContactPair> &pairs)
    {
      return projections_of(view, pairs, 0, pairs.size());
    }
  } // namespace

  namespace
  {
    using Ends = std::array<unsigned int, 2>;

    /// For each pair of an edge without a velocity of its own, the pairs of its ends; invalid_index for an end that
    /// does not see the die, and for all others.
    std::vector<Ends> ends_of_edges(const std::vector<ContactPair> &pairs)
    {
      std::map<std::pair<unsigned int, NodeIndex>, unsigned int> of_node;
      for (unsigned int p = 0; p < pairs.size(); ++p)
        if (pairs[p].point.is_node())
          of_node[{pairs[p].die, pairs[p].point.nodes[0]}] = p;
      std::vector<Ends> ends(pairs.size(), {{invalid_index, invalid_index}});
      for (unsigned int p = 0; p < pairs.size(); ++p)
        if (!pairs[p].point.has_own_velocity())
          for (unsigned int i = 0; i < 2; ++i)
            if (const auto found = of_node.find({pairs[p].die, pairs[p].point.nodes[i]});
                found != of_node.end())
              ends[p][i] = found->second;
      return ends;
    }

    /// (pair of a node, pair of an edge at it), in a fixed order; as often as the edge stands at the node in
    /// the whole, so that a sector's nodes touch as those of the whole do.
    std::vector<std::array<unsigned int, 2>> touched_by_edges(const Topology                 &topology,
                                                              const std::vector<ContactPair> &pairs)
    {
      const std::vector<Ends>                  ends = ends_of_edges(pairs);
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

    /// The parts with which edges that touch count for their ends,  g_m = 1 - w(4 b_m/s_m):  none where the die
    /// only begins to bulge into the edge, so that nothing jumps there; all where it bulges by a quarter of the
    /// ramp's width. Where b_m is small beside that, the ends are as near as the edge and need none: of ends that
    /// are b_m away from a die which the edge touches, at least 0.99 touch. (By 1 - w(b_m/s_m) it was 0.75, and
    /// friction on the hub too low.) Also all where an end does not see the die, and where ramps are sharp.
    class BulgingParts
    {
    public:
      BulgingParts(const std::vector<ContactPair> &pairs, const FrictionRamp &ramp)
          : ramp_(ramp), ends_(ramp.sharp ? std::vector<Ends>() : ends_of_edges(pairs))
      {
      }

      template <typename Number>
      Number operator()(const ContactSet<Number> &contact, const unsigned int m) const
      {
        return is_whole(m)
                 ? Number(1.)
                 : Number(1. - ramp_(Number(steepness * bulge(contact, m) / contact.scales[m]), false));
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
        const double s = contact.scales[m], b = bulge(contact, m),
                     slope = -part_bar * steepness * ramp_.derivative(steepness * b / s) / s;
        for (const unsigned int end : ends_[m])
          gaps_bar[end] += 0.5 * slope;
        gaps_bar[m] -= slope;
        scales_bar[m] -= slope * b / s;
      }

    private:
      static constexpr double steepness = 4.;

      bool is_whole(const unsigned int m) const
      {
        return ends_.empty() || ends_[m][0] == invalid_index || ends_[m][1] == invalid_index;
      }

      /// b_m = (delta_a + delta_b)/2 - delta_m  [mm]
      template <typename Number>
      Number bulge(const ContactSet<Number> &contact, const unsigned int m) const
      {
        const auto delta = [&](const unsigned int p) { return contact.projections[p].delta; };
        return 0.5 * (delta(ends_[m][0]) + delta(ends_[m][1])) - delta(m);
      }

      FrictionRamp      ramp_;
      std::vector<Ends> ends_;
    };

    /// Makes the derivatives in the ramps those in the points' own, and adds those in gaps and scales: the reverse of
    /// how edges let nodes touch.
    void reverse_touched_by_edges(const ContactSet<double> &contact,
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
  } // namespace

  namespace
  {
    /// The triangles of velocity nodes that a face is made of.
    template <typename Use>
    void
    for_each_triangle(const TetMesh &mesh, const MiddleNodes *edges, const unsigned int f, const Use &use)
    {
      const auto &k = mesh.faces[f].nodes;
      if (!edges)
        return use(k);
      std::array<NodeIndex, 3> m; // between corner i and the next
      for (unsigned int i = 0; i < 3; ++i)
        m[i] = edges->between(k[i], k[(i + 1) % 3]);
      use({{k[0], m[0], m[2]}});
      use({{k[1], m[1], m[0]}});
      use({{k[2], m[2], m[1]}});
      use({{m[0], m[1], m[2]}});
    }
  } // namespace

  namespace
  {
    using PairOfVelocityNode = std::map<std::pair<unsigned int, NodeIndex>, unsigned int>; // by die and node

    /// ContactSet::middles_around
    std::vector<std::vector<unsigned int>> middles_around(const Topology                 &topology,
                                                          const MiddleNodes              &edges,
                                                          const PairOfVelocityNode       &index,
                                                          const std::vector<ContactPair> &pairs)
    {
      std::vector<std::vector<unsigned int>> around(pairs.size());
      std::vector<char>                      all(pairs.size(), 1);
      std::set<unsigned int>                 dies;
      for (const ContactPair &pair : pairs)
        dies.insert(pair.die);
      for (std::size_t e = 0; e < topology.surface_edges.size(); ++e)
        for (const unsigned int d : dies)
        {
          const auto &ends   = topology.surface_edges[e];
          const auto  middle = index.find({d, edges.between(ends[0], ends[1])});
          for (unsigned int i = 0; i < 2; ++i)
            if (const auto vertex = index.find({d, ends[i]}); vertex != index.end())
            {
              if (middle == index.end())
                all[vertex->second] = 0;
              else
                around[vertex->second].push_back(middle->second);
            }
        }
      for (unsigned int p = 0; p < pairs.size(); ++p)
        if (!all[p])
          around[p].clear();
      return around;
    }
  } // namespace

  namespace
  {
    /// Where a point of a pair is on its die, as that stands at the start of the run.
    template <typename Number>
    Vector3<Number> on_die(const ContactView<Number> &view, const ContactPair &pair)
    {
      return pair.point.position(view.X) - view.states[pair.die].displacement;
    }

    template <typename Number>
    std::vector<std::vector<Number>> weights_of_zones(const ContactView<Number>      &view,
                                                      const std::vector<ContactPair> &pairs)
    {
      if (std::all_of(
            view.dies.begin(), view.dies.end(), [](const Die &die) { return die.zones.boxes.empty(); }))
        return {};
      std::vector<std::vector<Number>> weights(pairs.size());
      for (unsigned int p = 0; p < pairs.size(); ++p)
        for (unsigned int z = 0; z < view.dies[pairs[p].die].zones.boxes.size(); ++z)
          weights[p].push_back(view.dies[pairs[p].die].zones.weight(z, on_die(view, pairs[p])));
      return weights;
    }

    void reverse_weights_of_zones(const ContactView<double>              &view,
                                  const std::vector<ContactPair>         &pairs,
                                  const std::vector<std::vector<double>> &weights_bar,
                                  NodalVectors<double>                   &X_bar,
                                  std::vector<DieState<double>>          &dies_bar)
    {
      for (unsigned int p = 0; p < weights_bar.size(); ++p)
        for (unsigned int z = 0; z < weights_bar[p].size(); ++z)
        {
          const Vec3 at_point =
            weights_bar[p][z] * view.dies[pairs[p].die].zones.gradient(z, on_die(view, pairs[p]));
          pairs[p].point.add_to_position(at_point, X_bar);
          dies_bar[pairs[p].die].displacement -= at_point;
        }
    }
  } // namespace

  template <typename Number>
  ContactSet<Number> make_contact_set(const ContactView<Number>      &view,
                                      const std::vector<ContactPair> &pairs,
                                      const ContactApproach<Number>  &approach)
  {
    AssertDimension(view.X.size(), view.mesh.n_nodes());
    AssertDimension(view.states.size(), view.dies.size());
    Assert(std::all_of(pairs.begin(),
                       pairs.end(),
                       [&](const ContactPair &pair) { return pair.die < view.dies.size(); }),
           dealii::ExcMessage("a pair is of a die that is not there"));
    Assert(value_of(approach.tau) > 0., dealii::ExcMessage("gaps close within a positive time"));
    ContactSet<Number> contact;
    const auto &[mesh, topology, dies, states, X, edges, comm, velocity] = view;
    contact.edge_stiffness                                               = approach.edge_stiffness;
    contact.counts_closing                                               = approach.counts_closing;
    contact.pairs                                                        = pairs;
    contact.projections                                                  = projected(view, pairs);
    contact.tau                                                          = approach.tau;
    contact.approach                                                     = approach.law;
    contact.quadratic                                                    = edges != nullptr;
    contact.rates                                                        = surface_rates(view, pairs);
    contact.zones                                                        = weights_of_zones(view, pairs);
    const RampScales<Number> scales(approach.ramp, states);
    PairOfVelocityNode       index;
    for (unsigned int p = 0; p < pairs.size(); ++p)
    {
      if (pairs[p].point.has_own_velocity())
        index[{pairs[p].die, pairs[p].point.velocity_node}] = p;
      const auto metal = view.velocity_of(pairs[p].point);
      contact.scales.push_back(scales(pairs[p].die, contact.projections[p].n, metal ? &*metal : nullptr));
      contact.ramps.push_back(own_ramp(contact, approach.ramp, p, contact.projections[p].delta));
    }
    if (edges)
    {
      contact.middles_around = middles_around(topology, *edges, index, pairs);
      contact.chords         = find_chords(view, pairs, index);
      level_gaps(X, approach.ramp, contact);
    }
    contact.touched_by_edges = touched_by_edges(topology, pairs);
    const BulgingParts part_of(pairs, approach.ramp);
    for (const auto &[node, edge] : contact.touched_by_edges)
      contact.ramps[node] += (1. - contact.ramps[node]) * part_of(contact, edge) * contact.ramps[edge];
    // A triangle is visited from its first pair of each die.
    for (unsigned int p = 0; p < pairs.size(); ++p)
      if (const ContactPoint &point = pairs[p].point;
          point.has_own_velocity() && states[pairs[p].die].rubs() && value_of(contact.ramps[p]) > 0.)
        point.for_each_face(mesh, topology, [&](const unsigned int f) {
          for_each_triangle(mesh, edges, f, [&](const std::array<NodeIndex, 3> &corners) {
            if (std::find(corners.begin(), corners.end(), point.velocity_node) == corners.end())
              return;
            typename ContactSet<Number>::Face face{f, {}, Number(1.)};
            for (unsigned int c = 0; c < 3; ++c)
            {
              const auto found = index.find({pairs[p].die, corners[c]});
              if (found == index.end() || found->second < p || !(value_of(contact.ramps[found->second]) > 0.))
                return;
              face.points[c] = found->second;
              face.weight *= contact.ramps[found->second];
            }
            contact.friction_faces.push_back(face);
          });
        });
    return contact;
  }

  void reverse_contact_set(const ContactView<double>     &view,
                           const ContactSet<double>      &contact,
                           const FrictionRamp            &ramp,
                           const ContactSetBar           &bar,
                           NodalVectors<double>          &X_bar,
                           NodalVectors<double>          &velocity_bar,
                           std::vector<DieState<double>> &dies_bar)
  {
    AssertDimension(bar.delta.size(), contact.pairs.size());
    AssertDimension(bar.ramp.size(), contact.pairs.size());
    AssertDimension(bar.n.size(), contact.pairs.size());
    AssertDimension(X_bar.size(), view.X.size());
    AssertDimension(velocity_bar.size(), view.X.size());
    AssertDimension(dies_bar.size(), view.dies.size());
    reverse_surface_rates(view, contact.pairs, bar.rates, X_bar, velocity_bar, dies_bar);
    reverse_weights_of_zones(view, contact.pairs, bar.zones, X_bar, dies_bar);
    std::vector<double> gaps_bar = bar.delta, scales_bar(contact.pairs.size(), 0.);
    if (contact.quadratic)
      reverse_level_gaps(view.X, ramp, contact, bar.ramp, gaps_bar, scales_bar, X_bar);
    else
    {
      std::vector<double> ramps_bar = bar.ramp;
      reverse_touched_by_edges(contact, ramp, ramps_bar, gaps_bar, scales_bar);
      for (unsigned int p = 0; p < gaps_bar.size(); ++p)
        reverse_own_ramp(
          contact, ramp, p, contact.projections[p].delta, ramps_bar[p], gaps_bar[p], scales_bar[p]);
    }
    const RampScales<double> scales(ramp, view.states);
    for (unsigned int p = 0; p < contact.pairs.size(); ++p)
    {
      // Of the sums of all ranks, a rank has the part of its own points.
      if (gaps_bar[p] == 0. && scales_bar[p] == 0. && bar.n[p].norm_square() == 0.)
        continue;
      const ContactPair &pair    = contact.pairs[p];
      DieState<double>  &die_bar = dies_bar[pair.die];
      Vec3               at_point, metal_bar, n_bar = bar.n[p];
      const auto         metal = view.velocity_of(pair.point);
      scales.reverse(pair.die,
                     contact.projections[p].n,
                     metal ? &*metal : nullptr,
                     scales_bar[p],
                     n_bar,
                     metal_bar,
                     dies_bar);
      if (metal)
        pair.point.add_to_position(metal_bar, velocity_bar);
      view.dies[pair.die].reverse_project(pair.point.position(view.X),
                                          view.states[pair.die].displacement,
                                          pair.feature,
                                          gaps_bar[p],
                                          n_bar,
                                          at_point,
                                          die_bar.displacement,
                                          die_bar.vertices.empty() ? nullptr : &die_bar.vertices);
      pair.point.add_to_position(at_point, X_bar);
    }
  }

  template ContactSet<double> make_contact_set(const ContactView<double> &,
                                               const std::vector<ContactPair> &,
                                               const ContactApproach<double> &);
  template ContactSet<Dual>   make_contact_set(const ContactView<Dual> &,
                                               const std::vector<ContactPair> &,
                                               const ContactApproach<Dual> &);
} // namespace retroforge
