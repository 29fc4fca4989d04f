// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/contact/level_gaps.h>
#include <retroforge/core/shares.h>
#include <retroforge/element/mini_element.templates.h>

#include <algorithm>
#include <map>
#include <set>

namespace retroforge
{
  namespace
  {
    template <typename Number>
    Vector3<Number> slip(const ContactNode<Number> &node)
    {
      return node.u - node.n * Number(node.u * node.n);
    }

    bool has_friction(const ContactNode<double> &node)
    {
      return node.Sf * node.alpha != 0.;
    }

    template <typename Number>
    Number face_area(const BoundaryFace &face, const NodalVectors<Number> &X)
    {
      using std::sqrt;
      const Vector3<Number> a = X[face.nodes[1]] - X[face.nodes[0]], b = X[face.nodes[2]] - X[face.nodes[0]];
      const Vector3<Number> c = cross(a, b);
      return 0.5 * sqrt(Number(c * c));
    }

    void reverse_face_area(const BoundaryFace         &face,
                           const NodalVectors<double> &X,
                           const double                area_bar,
                           NodalVectors<double>       &X_bar)
    {
      const Vec3 a = X[face.nodes[1]] - X[face.nodes[0]], b = X[face.nodes[2]] - X[face.nodes[0]];
      const Vec3 c      = cross(a, b);
      const Vec3 normal = c / c.norm();
      const Vec3 d1 = 0.5 * area_bar * cross(b, normal), d2 = 0.5 * area_bar * cross(normal, a);
      X_bar[face.nodes[1]] += d1;
      X_bar[face.nodes[2]] += d2;
      X_bar[face.nodes[0]] -= d1 + d2;
    }

    /// The common last step of the two reverse sweeps over a node: from (dv_bar, h_bar) to u, n, delta, tau.
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
  } // namespace

  template <typename Number>
  Number FrictionRamp::operator()(const Number &delta, const bool touching) const
  {
    if (sharp)
      return Number(touching ? 1. : 0.);
    const double d = value_of(delta);
    if (d <= 0. || d >= width)
      return Number(d <= 0. ? 1. : 0.);
    const Number t = delta / width;
    return 1. - t * t * t * (10. - t * (15. - 6. * t));
  }

  double FrictionRamp::derivative(const double delta) const
  {
    if (sharp || delta <= 0. || delta >= width)
      return 0.;
    const double t = delta / width;
    return -30. * t * t * (1. - t) * (1. - t) / width;
  }

  namespace
  {
    /// Where a die bulges into an edge by more than this part of its length, as seen from its ends.
    constexpr double least_bulge = 1e-6;

    /// One of the points looked at, as it sees a die.
    struct Seen
    {
      unsigned int point;
      DieFeature   feature;
      double       delta;
    };

    /// What points 0 … n - 1 see of die d within reach, ascending. Each rank looks at its share of them.
    /// @param position  of a point
    template <typename Position>
    std::vector<Seen> seen_by(const ContactView<double> &view,
                              const unsigned int         d,
                              const std::size_t          n,
                              const double               reach,
                              const Position            &position)
    {
      std::vector<Seen> seen;
      const auto [begin, end] = share_of_rank(n, view.comm);
      for (std::size_t i = begin; i < end; ++i)
      {
        const Vec3 x = position(i);
        if (const DieFeature feature = view.dies[d].closest(x, view.states[d].displacement, reach);
            feature.found())
          seen.push_back(
            {static_cast<unsigned int>(i), feature, view.dies[d].project(x, view.states[d], feature).delta});
      }
      return joined(std::move(seen), view.comm);
    }

    /// Adds the middles of edges in reach of die d that are deeper in it than their ends.
    /// @param delta  of each node to this die; infinite out of reach
    void add_edges(const ContactView<double> &view,
                   const unsigned int         d,
                   const std::vector<double> &delta,
                   const FrictionRamp        &ramp,
                   const double               reach,
                   std::vector<ContactPair>  &pairs)
    {
      const auto            &X     = view.X;
      const auto            &edges = view.topology.surface_edges;
      std::vector<NodeIndex> ends;
      const auto             middle = [&](const std::size_t e) {
        return ContactPoint::middle(edges[e][0], edges[e][1]).position(X);
      };
      for (const auto &[e, feature, at_middle] : seen_by(view, d, edges.size(), reach, middle))
      {
        const auto &[a, b] = edges[e];
        if (at_middle <= reach &&
            at_middle < 0.5 * (delta[a] + delta[b]) - least_bulge * (X[a] - X[b]).norm())
        {
          pairs.push_back({ContactPoint::middle(a, b), d, at_middle <= ramp.width, feature});
          for (const NodeIndex k : edges[e])
            if (!(delta[k] <= reach))
              ends.push_back(k);
        }
      }
      std::sort(ends.begin(), ends.end());
      ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
      const auto     node      = [&](const std::size_t i) { return X[ends[i]]; };
      constexpr auto any_reach = std::numeric_limits<double>::max();
      for (const Seen &seen : seen_by(view, d, ends.size(), any_reach, node))
        pairs.push_back({ContactPoint::node(ends[seen.point]), d, false, seen.feature});
    }
  } // namespace

  std::vector<ContactPair> find_contact_pairs(const ContactView<double> &view,
                                              const FrictionRamp        &ramp,
                                              const double               reach,
                                              const bool                 with_edges)
  {
    const auto              &X     = view.X;
    const auto              &edges = view.topology.surface_edges;
    std::vector<NodeIndex>   nodes;
    std::vector<ContactPair> pairs;
    for (NodeIndex k = 0; k < X.size(); ++k)
      if (view.topology.is_on_surface(k))
        nodes.push_back(k);
    const auto node   = [&](const std::size_t i) { return X[nodes[i]]; };
    const auto middle = [&](const std::size_t e) {
      const auto &[a, b] = edges[e];
      return ContactPoint::middle(a, b, view.edges->between(a, b));
    };
    for (unsigned int d = 0; d < view.dies.size(); ++d)
    {
      const auto add = [&](const ContactPoint &point, const Seen &seen) {
        if (seen.delta <= reach)
          pairs.push_back({point, d, seen.delta <= ramp.width, seen.feature});
      };
      std::vector<double> delta(X.size(), std::numeric_limits<double>::infinity());
      for (const Seen &seen : seen_by(view, d, nodes.size(), reach, node))
      {
        delta[nodes[seen.point]] = seen.delta;
        add(ContactPoint::node(nodes[seen.point]), seen);
      }
      if (view.edges)
        for (const Seen &seen : seen_by(
               view, d, edges.size(), reach, [&](const std::size_t e) { return middle(e).position(X); }))
          add(middle(seen.point), seen);
      else if (with_edges && view.dies[d].surface())
        add_edges(view, d, delta, ramp, reach, pairs);
    }
    return pairs;
  }

  namespace
  {
    /// Of each pair, as far as it is this rank's to project: the gap and the normal.
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
    /// (pair of a node, pair of an edge at it), in a fixed order; as often as the edge stands at the node in
    /// the whole, so that a sector's nodes touch as those of the whole do.
    std::vector<std::array<unsigned int, 2>> touched_by_edges(const Topology                 &topology,
                                                              const std::vector<ContactPair> &pairs)
    {
      std::map<std::pair<unsigned int, NodeIndex>, unsigned int> of_node;
      for (unsigned int p = 0; p < pairs.size(); ++p)
        if (pairs[p].point.is_node())
          of_node[{pairs[p].die, pairs[p].point.nodes[0]}] = p;
      std::vector<std::array<unsigned int, 2>> touched;
      for (unsigned int p = 0; p < pairs.size(); ++p)
        if (const ContactPoint &point = pairs[p].point; !point.has_own_velocity())
        {
          const std::array<NodeIndex, 2> ends{{point.nodes[0], point.nodes[1]}};
          const auto                    &edges = topology.surface_edges;
          const auto                     edge  = std::lower_bound(edges.begin(), edges.end(), ends);
          AssertThrow(edge != edges.end() && *edge == ends, dealii::ExcInternalError());
          for (unsigned int i = 0; i < 2; ++i)
            if (const auto found = of_node.find({pairs[p].die, ends[i]}); found != of_node.end())
              touched.insert(
                touched.end(), topology.edge_images[edge - edges.begin()][i], {{found->second, p}});
        }
      return touched;
    }

    /// Adds to the ramps' derivatives those of the points' own ramps: the reverse of how edges let nodes
    /// touch.
    std::vector<double> reverse_touched_by_edges(const ContactSet<double>  &contact,
                                                 const FrictionRamp        &ramp,
                                                 const std::vector<double> &ramps_bar)
    {
      std::vector<double> own_bar = ramps_bar, at;
      for (unsigned int p = 0; p < contact.pairs.size(); ++p)
        at.push_back(ramp(contact.projections[p].delta, contact.pairs[p].touching));
      std::vector<double> before; // of the node, at each step
      for (const auto &[node, edge] : contact.touched_by_edges)
      {
        before.push_back(at[node]);
        at[node] += (1. - at[node]) * at[edge];
      }
      for (std::size_t i = contact.touched_by_edges.size(); i-- > 0;)
      {
        const auto &[node, edge] = contact.touched_by_edges[i];
        own_bar[edge] += (1. - before[i]) * own_bar[node];
        own_bar[node] *= 1. - at[edge];
      }
      return own_bar;
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
        m[i] = edges->between(mesh.faces[f].nodes[i], mesh.faces[f].nodes[(i + 1) % 3]);
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

  template <typename Number>
  ContactSet<Number> make_contact_set(const ContactView<Number>      &view,
                                      const std::vector<ContactPair> &pairs,
                                      const ContactApproach<Number>  &approach)
  {
    ContactSet<Number> contact;
    const auto &[mesh, topology, dies, states, X, edges, comm] = view;
    contact.edge_stiffness                                     = approach.edge_stiffness;
    contact.pairs                                              = pairs;
    contact.projections                                        = projected(view, pairs);
    contact.tau                                                = approach.tau;
    contact.approach                                           = approach.law;
    contact.quadratic                                          = edges != nullptr;
    PairOfVelocityNode index;
    for (unsigned int p = 0; p < pairs.size(); ++p)
    {
      if (pairs[p].point.has_own_velocity())
        index[{pairs[p].die, pairs[p].point.velocity_node}] = p;
      contact.ramps.push_back(approach.ramp(contact.projections[p].delta, pairs[p].touching));
    }
    if (edges)
    {
      contact.middles_around = middles_around(topology, *edges, index, pairs);
      contact.chords         = find_chords(view, pairs, index);
      level_gaps(X, approach.ramp, contact);
    }
    contact.touched_by_edges = touched_by_edges(topology, pairs);
    for (const auto &[node, edge] : contact.touched_by_edges)
      contact.ramps[node] += (1. - contact.ramps[node]) * contact.ramps[edge];
    // A triangle is visited from its first pair of each die.
    for (unsigned int p = 0; p < pairs.size(); ++p)
      if (const ContactPoint &point = pairs[p].point; point.has_own_velocity() &&
                                                      value_of(states[pairs[p].die].friction) != 0. &&
                                                      value_of(contact.ramps[p]) > 0.)
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
                           std::vector<DieState<double>> &dies_bar)
  {
    std::vector<double> gaps_bar = bar.delta;
    if (contact.quadratic)
      reverse_level_gaps(view.X, ramp, contact, bar.ramp, gaps_bar, X_bar);
    else
    {
      const std::vector<double> ramps_bar = reverse_touched_by_edges(contact, ramp, bar.ramp);
      for (unsigned int p = 0; p < gaps_bar.size(); ++p)
        gaps_bar[p] += ramps_bar[p] * ramp.derivative(contact.projections[p].delta);
    }
    for (unsigned int p = 0; p < contact.pairs.size(); ++p)
    {
      // Of the sums of all ranks, a rank has the part of its own points.
      if (gaps_bar[p] == 0. && bar.n[p].norm_square() == 0.)
        continue;
      const ContactPair &pair    = contact.pairs[p];
      DieState<double>  &die_bar = dies_bar[pair.die];
      Vec3               at_point;
      view.dies[pair.die].reverse_project(pair.point.position(view.X),
                                          view.states[pair.die].displacement,
                                          pair.feature,
                                          gaps_bar[p],
                                          bar.n[p],
                                          at_point,
                                          die_bar.displacement,
                                          die_bar.vertices.empty() ? nullptr : &die_bar.vertices);
      pair.point.add_to_position(at_point, X_bar);
    }
  }

  namespace
  {
    /// Of a face's area, what counts for a point of it.
    template <typename Number>
    double part_of_face(const ContactSet<Number> &contact, const unsigned int p)
    {
      const ContactPoint &point = contact.pairs[p].point;
      if (contact.quadratic)
        return point.is_node() ? 1. / 12. : 1. / 4.;
      return (point.is_node() ? 1. : contact.edge_stiffness) / 3.;
    }

    /// And what of it each corner of a friction face has.
    template <typename Number>
    double corner_part(const ContactSet<Number> &contact)
    {
      return contact.quadratic ? 1. / 12. : 1. / 3.;
    }
  } // namespace

  template <typename Number>
  ContactAreas<Number> contact_areas(const TetMesh              &mesh,
                                     const Topology             &topology,
                                     const ContactSet<Number>   &contact,
                                     const NodalVectors<Number> &X)
  {
    ContactAreas<Number> areas;
    areas.S.assign(contact.pairs.size(), Number(0.));
    areas.Sf.assign(contact.pairs.size(), Number(0.));
    for (unsigned int p = 0; p < contact.pairs.size(); ++p)
      contact.pairs[p].point.for_each_face(mesh, topology, [&](const unsigned int f) {
        areas.S[p] += part_of_face(contact, p) * face_area(mesh.faces[f], X);
      });
    for (const auto &face : contact.friction_faces)
    {
      const Number part = corner_part(contact) * face.weight * face_area(mesh.faces[face.face], X);
      for (const unsigned int p : face.points)
        areas.Sf[p] += part;
    }
    return areas;
  }

  void reverse_contact_areas(const TetMesh              &mesh,
                             const Topology             &topology,
                             const ContactSet<double>   &contact,
                             const NodalVectors<double> &X,
                             const ContactAreas<double> &areas_bar,
                             NodalVectors<double>       &X_bar,
                             ContactSetBar              &bar)
  {
    for (unsigned int p = 0; p < contact.pairs.size(); ++p)
      if (areas_bar.S[p] != 0.)
        contact.pairs[p].point.for_each_face(mesh, topology, [&](const unsigned int f) {
          reverse_face_area(mesh.faces[f], X, areas_bar.S[p] * part_of_face(contact, p), X_bar);
        });
    for (const auto &face : contact.friction_faces)
    {
      const double part_bar =
        (areas_bar.Sf[face.points[0]] + areas_bar.Sf[face.points[1]] + areas_bar.Sf[face.points[2]]) *
        corner_part(contact);
      reverse_face_area(mesh.faces[face.face], X, part_bar * face.weight, X_bar);
      const double weight_bar = part_bar * face_area(mesh.faces[face.face], X);
      for (unsigned int c = 0; c < 3; ++c)
        bar.ramp[face.points[c]] +=
          weight_bar * contact.ramps[face.points[(c + 1) % 3]] * contact.ramps[face.points[(c + 2) % 3]];
    }
  }

  template <typename Number>
  Vector3<Number> contact_force(const ContactNode<Number> &node,
                                const MaterialLaw<Number> &law,
                                const ContactLaw<Number>  &contact)
  {
    Vector3<Number> force;
    if (node.active)
      force += node.n * Number(contact.rho * node.S * approach_excess(node));
    if (value_of(node.Sf) * value_of(node.alpha) != 0.)
    {
      const Vector3<Number> dv = slip(node);
      force += dv * FrictionLaw<Number>{law, contact}(Number(node.Sf * node.alpha), Number(dv * dv));
    }
    return force;
  }

  template <typename Number>
  Number friction_power(const ContactNode<Number> &node,
                        const MaterialLaw<Number> &law,
                        const ContactLaw<Number>  &contact)
  {
    if (value_of(node.Sf) * value_of(node.alpha) == 0.)
      return Number(0.);
    const Vector3<Number> dv  = slip(node);
    const Number          dv2 = dv * dv;
    return FrictionLaw<Number>{law, contact}(Number(node.Sf * node.alpha), dv2) * dv2;
  }

  double contact_potential(const ContactNode<double> &node,
                           const MaterialLaw<double> &law,
                           const ContactLaw<double>  &contact)
  {
    const double              h   = node.active ? approach_excess(node) : 0.;
    const Vec3                dv  = slip(node);
    const double              dv2 = dv * dv;
    const FrictionLaw<double> friction{law, contact};
    return 0.5 * contact.rho * node.S * h * h +
           (has_friction(node) ? friction(node.Sf * node.alpha, dv2) * friction.potential_ratio(dv2) : 0.);
  }

  dealii::Tensor<2, 3> contact_tangent(const ContactNode<double> &node,
                                       const MaterialLaw<double> &law,
                                       const ContactLaw<double>  &contact)
  {
    dealii::Tensor<2, 3> tangent;
    if (node.active)
      tangent += contact.rho * node.S * outer_product(node.n, node.n);
    if (has_friction(node))
    {
      const Vec3                dv  = slip(node);
      const double              dv2 = dv * dv;
      const FrictionLaw<double> friction{law, contact};
      const double              factor = friction(node.Sf * node.alpha, dv2);
      tangent -= factor * outer_product(node.n, node.n);
      for (unsigned int i = 0; i < 3; ++i)
        tangent[i][i] += factor;
      if (const double slope = friction.slope(dv2); slope != 0.)
        tangent += factor * slope * outer_product(dv, dv);
    }
    return tangent;
  }

  ContactNodeBar reverse_contact_force(const ContactNode<double> &node,
                                       const MaterialLaw<double> &law,
                                       const ContactLaw<double>  &contact,
                                       const Vec3                &lambda)
  {
    ContactNodeBar bar;
    double         h_bar = 0.;
    if (node.active)
    {
      const double h = approach_excess(node), lambda_n = lambda * node.n;
      h_bar           = contact.rho * node.S * lambda_n;
      bar.S           = contact.rho * h * lambda_n;
      bar.n           = contact.rho * node.S * h * lambda;
      bar.contact.rho = node.S * h * lambda_n;
    }
    Vec3 dv_bar;
    if (has_friction(node))
    {
      const Vec3                dv  = slip(node);
      const double              dv2 = dv * dv, product = lambda * dv;
      const FrictionLaw<double> friction{law, contact};
      const double              factor = friction(node.Sf * node.alpha, dv2);
      bar.Sf                           = factor * product / node.Sf;
      bar.alpha                        = factor * product / node.alpha;
      friction.reverse(dv2, factor * product, bar.law, bar.contact);
      dv_bar = factor * (lambda + friction.slope(dv2) * product * dv);
    }
    reverse_kinematics(node, dv_bar, h_bar, bar);
    return bar;
  }

  ContactNodeBar reverse_friction_power(const ContactNode<double> &node,
                                        const MaterialLaw<double> &law,
                                        const ContactLaw<double>  &contact,
                                        const double               weight)
  {
    ContactNodeBar bar;
    if (!has_friction(node))
      return bar;
    const Vec3                dv  = slip(node);
    const double              dv2 = dv * dv;
    const FrictionLaw<double> friction{law, contact};
    const double              factor = weight * friction(node.Sf * node.alpha, dv2);
    bar.Sf                           = factor * dv2 / node.Sf;
    bar.alpha                        = factor * dv2 / node.alpha;
    friction.reverse(dv2, factor * dv2, bar.law, bar.contact);
    reverse_kinematics(node, factor * (2. + friction.slope(dv2) * dv2) * dv, 0., bar);
    return bar;
  }

#define RETROFORGE_INSTANTIATE(Number)                                                                 \
  template Number FrictionRamp::operator()(const Number &, bool) const;                                \
  template ContactSet<Number>   make_contact_set(                                                      \
      const ContactView<Number> &, const std::vector<ContactPair> &, const ContactApproach<Number> &); \
  template ContactAreas<Number> contact_areas(                                                         \
    const TetMesh &, const Topology &, const ContactSet<Number> &, const NodalVectors<Number> &);      \
  template Vector3<Number> contact_force(                                                              \
    const ContactNode<Number> &, const MaterialLaw<Number> &, const ContactLaw<Number> &);             \
  template Number friction_power(                                                                      \
    const ContactNode<Number> &, const MaterialLaw<Number> &, const ContactLaw<Number> &);
  RETROFORGE_INSTANTIATE(double)
  RETROFORGE_INSTANTIATE(Dual)
#undef RETROFORGE_INSTANTIATE
} // namespace retroforge
