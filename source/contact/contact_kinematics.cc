// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/contact/edge_points.h>
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
    let_edges_touch(topology, approach.ramp, contact);
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
      reverse_edges_touch(contact, ramp, ramps_bar, gaps_bar, scales_bar);
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
