// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Derivatives of contact and friction at one node, and of what they need of the mesh. Proved:
// - the force is the gradient of the potential (differences of fourth order), the tangent the derivative of
// the force,
//   symmetric;
// - the reverse sweeps of force, friction power and the moments of closing agree with forward differentiation in each of their 18
// inputs:
//   pressed or not, sliding or stuck (zero slip), Newtonian without regularisation, without friction area;
// - the same of friction after Tresca, and after Coulomb, which follows the pressure, but for the symmetry of its
// tangent; tractions are those of the formulas; a law that is not known is refused by its name, with those that are, and so is
// a coefficient that a law has not;
// - the same within a layer, whose approach speed is smooth through zero and slower than delta/tau outside;
// - gaps, ramps, areas under two tilted dies: <A x, y> = <x, A^T y> for A the forward derivative, where the
// smooth ramp,
//   the sharp one and the dies' displacements count; the same with a triangulated, curved die, as a smooth
//   surface and as facets: there normals change, the die's vertices count, and middles of edges are contact
//   points, with a penalty of their own, that let nodes touch in their place: by the formula a node's ramp is
//   1 - (1 - w) product (1 - g w_edge), g = 1 - w(4 b) with the die's bulge b, of edges of all kinds, an edge's area the stiffness times a third of its faces;
// - the same for quadratic velocities, whose middles have velocities of their own: gaps to the curved die are
// levelled
//   by the formulas of level_gaps.h, a vertex has a twelfth of its faces' area, a middle a quarter;
// - the smooth ramp joins 1 and 0 with zero slope and curvature.

#include <deal.II/base/mpi.h>

#include <retroforge/contact/contact_areas.h>
#include <retroforge/contact/interface_law.h>

#include <retroforge/core/error.h>

#include <algorithm>

#include "../element/element_test_tools.h"
#include "../mesh/block_mesh.h"
#include "wavy_sheet.h"

#include "../discretization/middles_of.h"

using namespace retroforge;

/// The inputs of a node's force in the order u, n, delta, tau, S, Sf, alpha, limit, e^2, K, m, e0, rho, v0.
constexpr unsigned int n_inputs = 18;
const char *const      names[]  = {"u",
                                   "u",
                                   "u",
                                   "n",
                                   "n",
                                   "n",
                                   "delta",
                                   "tau",
                                   "S",
                                   "Sf",
                                   "alpha",
                                   "limit",
                                   "e^2",
                                   "K",
                                   "m",
                                   "e0",
                                   "rho",
                                   "v0"};

template <typename Number>
struct NodeCase
{
  ContactNode<Number> node;
  NortonHoff<Number>  law;
  ContactLaw<Number>  contact;

  std::array<Number *, n_inputs> inputs()
  {
    return {{&node.u[0],
             &node.u[1],
             &node.u[2],
             &node.n[0],
             &node.n[1],
             &node.n[2],
             &node.delta,
             &node.tau,
             &node.S,
             &node.Sf,
             &node.alpha,
             &node.shear_limit,
             &node.rate2,
             &law.K,
             &law.m,
             &law.e0,
             &contact.rho,
             &contact.v0}};
  }
};

/// The case with input i as the variable; none, where there is no such input.
NodeCase<Dual> vary(NodeCase<double> c, const unsigned int i)
{
  NodeCase<Dual> d;
  d.node.active        = c.node.active;
  d.node.approach      = c.node.approach;
  d.node.interface_law = c.node.interface_law;
  const auto from      = c.inputs();
  const auto to        = d.inputs();
  for (unsigned int k = 0; k < n_inputs; ++k)
    *to[k] = k == i ? Dual(1, 0, *from[k]) : Dual(*from[k]);
  return d;
}

std::array<double, n_inputs> values(const ContactNodeBar &bar)
{
  return {{bar.u[0],
           bar.u[1],
           bar.u[2],
           bar.n[0],
           bar.n[1],
           bar.n[2],
           bar.delta,
           bar.tau,
           bar.S,
           bar.Sf,
           bar.alpha,
           bar.shear_limit,
           bar.rate2,
           bar.law.K,
           bar.law.m,
           bar.law.e0,
           bar.contact.rho,
           bar.contact.v0}};
}

void check_potential(const NodeCase<double> &c, Errors &errors)
{
  const double        step = 1e-3;
  std::vector<double> gradient;
  for (unsigned int i = 0; i < 3; ++i)
  {
    const auto at = [&](const double factor) {
      NodeCase<double> moved = c;
      moved.node.u[i] += factor * step;
      return contact_potential(moved.node, moved.law, moved.contact);
    };
    gradient.push_back((8. * (at(1.) - at(-1.)) - (at(2.) - at(-2.))) / (12. * step));
  }
  const Vec3 force = contact_force(c.node, c.law, c.contact);
  errors.compare(
    "force as gradient of the potential", std::vector<double>(force.begin_raw(), force.end_raw()), gradient);
}

void check_tangent(const NodeCase<double> &c, Errors &errors)
{
  const auto          tangent = contact_tangent(c.node, c.law, c.contact);
  std::vector<double> closed, transposed, expected;
  for (unsigned int j = 0; j < 3; ++j)
  {
    const NodeCase<Dual> d     = vary(c, j);
    const auto           force = contact_force(d.node, d.law, d.contact);
    for (unsigned int i = 0; i < 3; ++i)
    {
      closed.push_back(tangent[i][j]);
      transposed.push_back(tangent[j][i]);
      expected.push_back(force[i].dx(0));
    }
  }
  errors.compare("tangent", closed, expected);
  if (interface_law(c.node.interface_law).has_potential())
    errors.compare("symmetry of the tangent", closed, transposed);
}

void check_reverse(const NodeCase<double> &c, const Vec3 &lambda, Errors &errors)
{
  const double                 weight     = -0.7;
  const auto                   force_bar  = values(reverse_contact_force(c.node, c.law, c.contact, lambda));
  const auto                   power_bar  = values(reverse_friction_power(c.node, c.law, c.contact, weight));
  const double                 rest_speed = 0.9;
  double                       rest_speed_bar = 0.;
  const bool                   sinks          = c.node.u[0] > 0.; // random
  const ClosingMoments<double> weights{{0.4, -1.1, 0.6, 0.8, -0.5}};
  const auto                   closing_bar =
    values(reverse_closing_moments(c.node, c.contact, rest_speed, sinks, weights, rest_speed_bar));
  const auto along = [&](const ClosingMoments<Dual> &moments) {
    double sum = 0.;
    for (std::size_t i = 0; i < weights.size(); ++i)
      sum += weights[i] * moments[i].dx(0);
    return sum;
  };
  std::map<std::string, std::vector<double>> force[2], power[2], closing[2];
  for (unsigned int i = 0; i < n_inputs; ++i)
  {
    const NodeCase<Dual> d = vary(c, i);
    const auto           f = contact_force(d.node, d.law, d.contact);
    force[0][names[i]].push_back(force_bar[i]);
    force[1][names[i]].push_back(lambda[0] * f[0].dx(0) + lambda[1] * f[1].dx(0) + lambda[2] * f[2].dx(0));
    power[0][names[i]].push_back(power_bar[i]);
    power[1][names[i]].push_back(weight * friction_power(d.node, d.law, d.contact).dx(0));
    const auto moments = closing_moments(d.node, d.contact, Dual(rest_speed), sinks);
    closing[0][names[i]].push_back(closing_bar[i]);
    closing[1][names[i]].push_back(along(moments));
  }
  const NodeCase<Dual> fixed = vary(c, n_inputs);
  errors.compare("closing moments in the rest speed",
                 rest_speed_bar,
                 along(closing_moments(fixed.node, fixed.contact, Dual(1, 0, rest_speed), sinks)));
  for (const auto &[name, value] : force[0])
  {
    errors.compare("lambda·force in " + name, value, force[1][name]);
    errors.compare("friction power in " + name, power[0][name], power[1][name]);
    errors.compare("closing moments in " + name, closing[0][name], closing[1][name]);
  }
}

NodeCase<double> random_case(Random &random, const double m, const double v0)
{
  NodeCase<double> c;
  const Vec3       n = random.vector();
  c.node             = {random.vector(), n / n.norm(), random.scalar(), 0.3, 1.7, 1.2, 0.4, true, {}};
  c.law              = {1.693, m, 0.05};
  c.contact          = {23., v0};
  c.node.shear_limit = 0.7;
  c.node.rate2       = 1.9;
  c.node.active      = approach_excess(c.node) > 0.;
  return c;
}

double check_nodes(const std::string &title,
                   const double       m,
                   const double       v0,
                   const bool         sliding,
                   const double       Sf,
                   const ApproachLaw &law          = {},
                   const unsigned int friction_law = 0)
{
  Random       random;
  Errors       errors;
  unsigned int n_active = 0;
  for (unsigned int k = 0; k < 20; ++k)
  {
    NodeCase<double> c = random_case(random, m, v0);
    if (!sliding)
      c.node.u = random.scalar() * c.node.n;
    c.node.Sf            = Sf;
    c.node.approach      = law;
    c.node.interface_law = friction_law;
    c.node.active        = approach_excess(c.node) > 0.;
    n_active += c.node.active;
    check_tangent(c, errors);
    check_reverse(c, random.vector(), errors);
  }
  std::cout << title << ", m = " << m << std::endl
            << "  pressed and free nodes: " << (n_active > 3 && n_active < 17 ? "yes" : "NO") << std::endl;
  errors.print(1e-12);
  return errors.largest();
}

/// What the lower of the two dies is.
enum class Lower
{
  plane,
  smooth,
  facets
};

/// The corner of a billet between two tilted dies, its nodes scattered.
struct CornerScene
{
  TetMesh                       mesh;
  Topology                      topology;
  MiddleNodes                   mesh_edges;
  bool                          quadratic;
  NodalVectors<double>          X;
  NodalVectors<double>          V; ///< of the increment before; empty where it is not known
  std::vector<Die>              dies;
  std::vector<DieState<double>> states;
  std::vector<ContactPair>      pairs;
  FrictionRamp                  ramp;
  double                        edge_stiffness = 0.3;

  CornerScene(const FrictionRamp &ramp, Random &random, const Lower lower, const bool quadratic)
      : mesh(half_box_mesh(Vec3({10., 8., 6.}), {{3, 6, 4}}))
      , topology(mesh)
      , mesh_edges(middles_of(mesh))
      , quadratic(quadratic)
      , X(mesh.X)
      , ramp(ramp)
  {
    for (Vec3 &x : X)
      x += 0.1 * random.vector();
    const Vec3 up = Vec3({0.1, -0.15, 1.}), side = Vec3({-1., 0.1, 0.2});
    dies = {Die("lower", Vec3({0., 0., 0.1}), up / up.norm()),
            Die("side", Vec3({5., 0., 0.}), side / side.norm())};
    if (lower != Lower::plane)
      dies[0] = Die("lower", wavy_sheet(quadratic ? 0.7 : 0.3), 2., {lower == Lower::smooth, 60., 1.});
    states = {{Vec3({0.3, -0.2, 0.9}), 0.1 * random.vector(), 0.3, {}},
              {Vec3({-0.7, 0.4, 0.1}), 0.1 * random.vector(), 0.2, {}}};
    pairs  = find_contact_pairs(view(states, X, V), ramp, 1.5 * ramp.width, true);
  }

  /// The metal comes to the dies here, and leaves them there.
  void move(Random &random)
  {
    for (std::size_t k = 0; k < X.size(); ++k)
      V.push_back(0.7 * random.vector());
  }

  template <typename Number>
  ContactView<Number> view(const std::vector<DieState<Number>> &states,
                           const NodalVectors<Number>          &X,
                           const NodalVectors<Number>          &V) const
  {
    return {mesh, topology, dies, states, X, quadratic ? &mesh_edges : nullptr, MPI_COMM_SELF, &V};
  }

  template <typename Number>
  ContactSet<Number> contact(const std::vector<DieState<Number>> &states,
                             const NodalVectors<Number>          &X,
                             const NodalVectors<Number>          &V) const
  {
    return make_contact_set<Number>(view(states, X, V), pairs, {ramp, Number(0.3), 0., edge_stiffness});
  }
};

/// What moves along a direction.
struct Moved
{
  bool nodes, dies, vertices;

  std::string name() const
  {
    std::string name;
    for (const auto &[moves, what] :
         {std::make_pair(nodes, "nodes"), std::make_pair(dies, "dies"), std::make_pair(vertices, "vertices")})
      if (moves)
        name += (name.empty() ? "" : " and ") + std::string(what);
    return name;
  }
};

double dot(const Vec3 &a, const Vec3 &b)
{
  return a * b;
}

double dot(const double a, const double b)
{
  return a * b;
}

template <typename T>
double dot(const std::vector<T> &a, const std::vector<T> &b)
{
  double sum = 0.;
  for (std::size_t k = 0; k < a.size(); ++k)
    sum += dot(a[k], b[k]);
  return sum;
}

Vector3<Dual> with_direction(const Vec3 &x, const Vec3 &x_dot)
{
  Vector3<Dual> d;
  for (unsigned int i = 0; i < 3; ++i)
  {
    d[i]                 = Dual(1, 0, x[i]);
    d[i].fastAccessDx(0) = x_dot[i];
  }
  return d;
}

/// One random direction of nodes and dies, and the set and areas along it.
void check_mesh(const CornerScene &scene, Random &random, const Moved &moved, Errors &errors)
{
  NodalVectors<double> X_dot(scene.X.size()), V_dot;
  NodalVectors<Dual>   X, V;
  for (const Vec3 &v : scene.V)
  {
    V_dot.push_back(moved.nodes ? random.vector() : Vec3());
    V.push_back(with_direction(v, V_dot.back()));
  }
  for (std::size_t k = 0; k < scene.X.size(); ++k)
  {
    X_dot[k] = moved.nodes ? random.vector() : Vec3();
    X.push_back(with_direction(scene.X[k], X_dot[k]));
  }
  std::vector<Vec3>                 displacement_dot, velocity_dot;
  std::vector<NodalVectors<double>> vertices_dot;
  std::vector<DieState<Dual>>       states;
  for (unsigned int d = 0; d < scene.dies.size(); ++d)
  {
    const DieState<double> &state = scene.states[d];
    displacement_dot.push_back(moved.dies ? random.vector() : Vec3());
    velocity_dot.push_back(moved.dies && (scene.ramp.wall < 1. || state.interface_law != 0) ? random.vector()
                                                                                            : Vec3());
    states.push_back({with_direction(state.velocity, velocity_dot.back()),
                      with_direction(state.displacement, displacement_dot.back()),
                      Dual(state.friction),
                      {},
                      state.interface_law});
    vertices_dot.emplace_back();
    if (!scene.dies[d].surface())
      continue;
    for (const Vec3 &x : scene.dies[d].surface()->vertices())
    {
      vertices_dot[d].push_back(moved.vertices ? random.vector() : Vec3());
      states[d].vertices.push_back(with_direction(x, vertices_dot[d].back()));
    }
  }
  const auto contact = scene.contact(scene.states, scene.X, scene.V);
  const auto moving  = scene.contact(states, X, V);
  const auto areas   = contact_areas(scene.mesh, scene.topology, moving, X);

  const std::size_t    n = scene.pairs.size();
  ContactSetBar        bar(n);
  ContactAreas<double> areas_bar{std::vector<double>(n), std::vector<double>(n)};
  double               forward = 0.;
  for (unsigned int p = 0; p < n; ++p)
  {
    bar.delta[p]    = random.scalar();
    bar.ramp[p]     = random.scalar();
    bar.n[p]        = random.vector();
    areas_bar.S[p]  = random.scalar();
    areas_bar.Sf[p] = random.scalar();
    if (!contact.rates.empty() && scene.states[scene.pairs[p].die].interface_law != 0)
    {
      bar.rates[p] = random.scalar();
      forward += bar.rates[p] * moving.rates[p].dx(0);
    }
    forward += bar.delta[p] * moving.projections[p].delta.dx(0) + bar.ramp[p] * moving.ramps[p].dx(0) +
               areas_bar.S[p] * areas.S[p].dx(0) + areas_bar.Sf[p] * areas.Sf[p].dx(0);
    for (unsigned int i = 0; i < 3; ++i)
      forward += bar.n[p][i] * moving.projections[p].n[i].dx(0);
  }
  NodalVectors<double>          X_bar(scene.X.size()), V_bar(scene.X.size());
  std::vector<DieState<double>> dies_bar(scene.dies.size());
  for (unsigned int d = 0; d < scene.dies.size(); ++d)
    dies_bar[d].vertices.resize(scene.dies[d].surface() ? scene.dies[d].surface()->vertices().size() : 0);
  reverse_contact_areas(scene.mesh, scene.topology, contact, scene.X, areas_bar, X_bar, bar);
  reverse_contact_set(
    scene.view(scene.states, scene.X, scene.V), contact, scene.ramp, bar, X_bar, V_bar, dies_bar);
  double backward = dot(X_dot, X_bar) + dot(V_dot, V_bar);
  for (unsigned int d = 0; d < scene.dies.size(); ++d)
    backward += dot(displacement_dot[d], dies_bar[d].displacement) +
                dot(velocity_dot[d], dies_bar[d].velocity) + dot(vertices_dot[d], dies_bar[d].vertices);
  errors.compare(moved.name(), backward, forward);
  // All vertices moved alike are a displacement of the die.
  for (unsigned int d = 0; d < scene.dies.size(); ++d)
    if (scene.dies[d].surface())
    {
      Vec3 sum;
      for (const Vec3 &x : dies_bar[d].vertices)
        sum += x;
      for (unsigned int i = 0; i < 3; ++i)
        errors.compare("vertices' derivatives summed", sum[i], dies_bar[d].displacement[i]);
    }
}

/// Own ramps of points, not those that edges give to nodes.
std::vector<double> own_ramps(const CornerScene &scene, const ContactSet<double> &contact)
{
  std::vector<double> ramps;
  for (unsigned int p = 0; p < contact.pairs.size(); ++p)
    ramps.push_back(own_ramp(contact, scene.ramp, p, contact.projections[p].delta));
  return ramps;
}

/// The part of an edge's ramp by which it counts for its ends.
double bulging_part(const CornerScene &scene, const ContactSet<double> &contact, const unsigned int edge)
{
  if (scene.ramp.sharp)
    return 1.;
  double bulge = -contact.projections[edge].delta;
  for (unsigned int p = 0; p < contact.pairs.size(); ++p)
    if (const auto &[point, die, touching, feature] = contact.pairs[p];
        point.is_node() && die == contact.pairs[edge].die &&
        (point.nodes[0] == contact.pairs[edge].point.nodes[0] ||
         point.nodes[0] == contact.pairs[edge].point.nodes[1]))
      bulge += 0.5 * contact.projections[p].delta;
  return 1. - scene.ramp(4. * bulge / contact.scales[edge], false);
}

bool in_plane(const CornerScene &scene, const NodeIndex k)
{
  return scene.topology.fixed_directions[k].size() > 0;
}

/// Counts pairs of edges and nodes that only edges let touch; compares nodes' ramps and edges' areas with the
/// formulas. An edge that leaves the plane of symmetry has an image beyond it, at the same node.
void check_edges(const CornerScene &scene, const ContactSet<double> &contact, Errors &errors)
{
  const std::vector<double> own     = own_ramps(scene, contact);
  unsigned int              n_edges = 0, n_touching = 0, n_by_edges = 0, n_by_one = 0;
  for (unsigned int p = 0; p < contact.pairs.size(); ++p)
  {
    const ContactPair &pair = contact.pairs[p];
    n_edges += !pair.point.is_node();
    n_touching += !pair.point.is_node() && own[p] > 0.;
    if (!pair.point.is_node())
      continue;
    double       free = 1. - own[p];
    unsigned int n    = 0;
    for (unsigned int q = 0; q < contact.pairs.size(); ++q)
    {
      const ContactPair &other = contact.pairs[q];
      if (other.point.is_node() || other.die != pair.die || own[q] == 0. ||
          (other.point.nodes[0] != pair.point.nodes[0] && other.point.nodes[1] != pair.point.nodes[0]))
        continue;
      const bool has_image = in_plane(scene, other.point.nodes[0]) != in_plane(scene, other.point.nodes[1]);
      free *= std::pow(1. - bulging_part(scene, contact, q) * own[q],
                       has_image && in_plane(scene, pair.point.nodes[0]) ? 2 : 1);
      ++n;
    }
    errors.compare("ramps of nodes at edges", 1. + contact.ramps[p], 2. - free); // some touch by 1e-12
    n_by_edges += own[p] == 0. && contact.ramps[p] > 0.;
    n_by_one += n == 1;
  }
  const ContactAreas<double> areas = contact_areas(scene.mesh, scene.topology, contact, scene.X);
  for (unsigned int p = 0; p < contact.pairs.size(); ++p)
    if (const auto &nodes = contact.pairs[p].point.nodes; !contact.pairs[p].point.is_node())
    {
      double thirds = 0.;
      for (const BoundaryFace &face : scene.mesh.faces)
        if (const auto &c = face.nodes;
            scene.mesh.is_surface(face) &&
            std::count(c.begin(), c.end(), nodes[0]) + std::count(c.begin(), c.end(), nodes[1]) == 2)
          thirds += cross(scene.X[c[1]] - scene.X[c[0]], scene.X[c[2]] - scene.X[c[0]]).norm() / 6.;
      errors.compare("areas of edges", areas.S[p], scene.edge_stiffness * thirds);
    }
  std::cout << "  middles of edges are points: " << (n_edges > 0 ? "yes, " : "none")
            << (n_edges > 0 ? std::to_string(n_edges) : "") << "\n";
  if (n_edges > 0)
    std::cout << "  edges that touch: " << (n_touching > 3 ? "yes, " : "NO, ") << n_touching
              << "\n  nodes that only edges let touch: " << (n_by_edges > 1 ? "yes, " : "NO, ") << n_by_edges
              << "\n  nodes with one edge that touches: " << (n_by_one > 1 ? "yes, " : "NO, ") << n_by_one
              << std::endl;
}

/// Gaps of all points as they are found, before any is levelled.
std::vector<double> own_gaps(const CornerScene &scene, const ContactSet<double> &contact)
{
  std::vector<double> gaps;
  for (const auto &[point, die, touching, feature] : contact.pairs)
    gaps.push_back(scene.dies[die].project(point.position(scene.X), scene.states[die], feature).delta);
  return gaps;
}

/// Counts edges of quadratic velocities that are bulges of a die; compares gaps, ramps and areas with the
/// formulas.
void check_middles(const CornerScene &scene, const ContactSet<double> &contact, Errors &errors)
{
  const std::vector<double>  own   = own_gaps(scene, contact);
  const ContactAreas<double> areas = contact_areas(scene.mesh, scene.topology, contact, scene.X);
  const auto                 pair  = [&](const unsigned int die, const NodeIndex a, const NodeIndex b) {
    for (unsigned int q = 0; q < contact.pairs.size(); ++q)
      if (contact.pairs[q].die == die && contact.pairs[q].point.nodes == std::array<NodeIndex, 2>{{a, b}})
        return q;
    return invalid_index;
  };
  const auto ramp = [&](const unsigned int p, const double gap) {
    return own_ramp(contact, scene.ramp, p, gap);
  };
  unsigned int n_kind[3] = {0, 0, 0}; // smooth, between, sharp
  for (unsigned int d = 0; d < scene.dies.size(); ++d)
  {
    std::vector<double> sum(scene.X.size(), 0.), weight(scene.X.size(), 0.25);
    struct Edge
    {
      unsigned int m, a, b;
      double       c;
    };
    std::vector<Edge> edges;
    if (scene.dies[d].surface())
      for (const auto &[i, j] : scene.topology.surface_edges)
        if (const unsigned int m = pair(d, i, j),
            a                    = pair(d, i, invalid_index),
            b                    = pair(d, j, invalid_index);
            m != invalid_index && a != invalid_index && b != invalid_index)
        {
          const double bulge = 0.5 * (own[a] + own[b]) - own[m];
          const double t =
            std::max(0., std::min(1., (std::abs(bulge) / (scene.X[i] - scene.X[j]).norm() - 0.06) / 0.09));
          const double c = 1. - std::pow(t, 3) * (10. - 15. * t + 6. * t * t);
          ++n_kind[t == 0. ? 0 : t < 1. ? 1 : 2];
          edges.push_back({m, a, b, c});
          for (const NodeIndex k : {i, j})
          {
            const double w =
              ramp(m, own[m]) * (in_plane(scene, i) != in_plane(scene, j) && in_plane(scene, k) ? 2. : 1.);
            sum[k] += w * c * bulge;
            weight[k] += w;
          }
        }
    std::vector<double> gap = own;
    for (unsigned int p = 0; p < gap.size(); ++p)
      if (const ContactPair &of_die = contact.pairs[p]; of_die.die == d && of_die.point.is_node())
        gap[p] -= sum[of_die.point.nodes[0]] / weight[of_die.point.nodes[0]];
    for (const auto &[m, a, b, c] : edges)
      gap[m] += ramp(a, gap[a]) * ramp(b, gap[b]) * c * (0.5 * (gap[a] + gap[b]) - gap[m]);
    for (unsigned int p = 0; p < gap.size(); ++p)
      if (contact.pairs[p].die == d)
      {
        errors.compare("levelled gaps", contact.projections[p].delta, gap[p]);
        errors.compare("ramps of levelled gaps", contact.ramps[p], ramp(p, gap[p]));
      }
  }
  for (unsigned int p = 0; p < contact.pairs.size(); ++p)
  {
    const ContactPoint &point = contact.pairs[p].point;
    double              third = 0.;
    for (const BoundaryFace &face : scene.mesh.faces)
      if (const auto &c = face.nodes; scene.mesh.is_surface(face) &&
                                      std::count(c.begin(), c.end(), point.nodes[0]) > 0 &&
                                      (point.is_node() || std::count(c.begin(), c.end(), point.nodes[1]) > 0))
        third += cross(scene.X[c[1]] - scene.X[c[0]], scene.X[c[2]] - scene.X[c[0]]).norm() / 6.;
    errors.compare("areas of vertices and middles", areas.S[p], third * (point.is_node() ? 0.25 : 0.75));
  }
  std::cout << "  edges at smooth and at sharp places of the die, and between:";
  for (const unsigned int n : {n_kind[0], n_kind[2], n_kind[1]})
    std::cout << " " << n;
  std::cout << std::endl;
}

/// e^2 of the file surface_rates.h by its formulas, face by face, beside those of pairs.
void check_rates(const CornerScene &scene, const ContactSet<double> &contact, Errors &errors)
{
  for (unsigned int p = 0; p < contact.pairs.size(); ++p)
  {
    if (scene.states[contact.pairs[p].die].interface_law == 0)
    {
      errors.compare("rates that nothing follows", contact.rates[p], 0.);
      continue;
    }
    double       sum = 0.;
    unsigned int n   = 0;
    for (unsigned int f = 0; f < scene.mesh.faces.size(); ++f)
    {
      const auto &c  = scene.mesh.faces[f].nodes;
      const auto &at = contact.pairs[p].point.nodes;
      if (!scene.mesh.is_surface(scene.mesh.faces[f]) || std::count(c.begin(), c.end(), at[0]) == 0 ||
          (at[1] != invalid_index && std::count(c.begin(), c.end(), at[1]) == 0))
        continue;
      for (const auto &k : scene.mesh.cells)
      {
        if (std::count_if(k.begin(), k.end(), [&](const NodeIndex node) {
              return std::count(c.begin(), c.end(), node) > 0;
            }) < 3)
          continue;
        // v = v_0 + L (x - x_0) at the other corners.
        dealii::Tensor<2, 3> from, to;
        for (unsigned int j = 0; j < 3; ++j)
          for (unsigned int i = 0; i < 3; ++i)
          {
            from[i][j] = scene.X[k[j + 1]][i] - scene.X[k[0]][i];
            to[i][j]   = scene.V[k[j + 1]][i] - scene.V[k[0]][i];
          }
        const dealii::Tensor<2, 3> L = to * invert(from), D = 0.5 * (L + transpose(L));
        sum += 2. / 3. * scalar_product(D, D);
        ++n;
      }
    }
    errors.compare("squares of strain rates", contact.rates[p], sum / n);
  }
}

double check_meshes(const FrictionRamp &ramp,
                    const Lower         lower,
                    const bool          quadratic,
                    const bool          moving = false,
                    const unsigned int  law    = 0)
{
  const bool  curved = lower != Lower::plane;
  Random      random;
  Errors      errors;
  CornerScene scene(ramp, random, lower, quadratic);
  if (moving)
    scene.move(random);
  scene.states[0].interface_law = law;
  const auto   contact          = scene.contact(scene.states, scene.X, scene.V);
  unsigned int n_partial = 0, n_faces[2] = {0, 0};
  for (const double w : contact.ramps)
    n_partial += w > 0. && w < 1.;
  for (const auto &face : contact.friction_faces)
    ++n_faces[contact.pairs[face.points[0]].die];
  unsigned int n_kind[DieFeature::n_kinds] = {};
  for (const ContactPair &pair : scene.pairs)
    ++n_kind[pair.feature.kind];
  std::cout << (ramp.sharp ? "sharp" : "smooth") << " ramp under "
            << (lower == Lower::plane    ? "two tilted dies"
                : lower == Lower::smooth ? "a curved and a tilted die"
                                         : "a die of facets and a tilted one")
            << (quadratic ? ", quadratic" : "") << std::endl
            << "  friction faces on both dies: " << (n_faces[0] > 3 && n_faces[1] > 3 ? "yes" : "NO")
            << std::endl
            << "  points on edges or vertices of a die: "
            << (n_kind[0] < scene.pairs.size() ? "some" : "none") << std::endl
            << "  nodes within the ramp: " << (n_partial > 3 ? "some" : "none") << std::endl;
  if (law != 0 && moving)
    check_rates(scene, contact, errors);
  if (quadratic)
    check_middles(scene, contact, errors);
  else
    check_edges(scene, contact, errors);
  for (unsigned int k = 0; k < 5; ++k)
  {
    check_mesh(scene, random, {true, true, false}, errors);
    check_mesh(scene, random, {true, false, false}, errors);
    check_mesh(scene, random, {false, true, false}, errors);
    if (curved)
    {
      check_mesh(scene, random, {false, false, true}, errors);
      check_mesh(scene, random, {true, true, true}, errors);
    }
  }
  errors.print(1e-12);
  return errors.largest();
}

void check_ramp()
{
  const FrictionRamp ramp{0.8, false};
  Errors             errors;
  bool               falls = true;
  double             last  = 1.;
  for (double delta = -0.1; delta < 0.95; delta += 0.013)
  {
    const Dual w = ramp(Dual(1, 0, delta), true);
    errors.compare("slope", 1. + ramp.derivative(delta), 1. + (w.hasFastAccess() ? w.dx(0) : 0.));
    falls = falls && w.val() <= last;
    last  = w.val();
  }
  const double near = 1e-6, far = ramp.width - near;
  // Twice differentiable: the slope leaves zero with the square of the distance.
  errors.compare("square law at contact, / 1e8",
                 1. + 1e-8 * ramp.derivative(2. * near) / ramp.derivative(near),
                 1. + 4e-8);
  errors.compare("square law out of reach, / 1e8",
                 1. + 1e-8 * ramp.derivative(far - near) / ramp.derivative(far),
                 1. + 4e-8);
  errors.compare("value at contact", ramp(near, true), ramp(-near, true));
  errors.compare("value out of reach", 1. + ramp(far, true), 1. + ramp(ramp.width + near, false));
  errors.compare("value halfway", ramp(0.4, true), 0.5);
  std::cout << "smooth ramp" << std::endl << "  falls: " << (falls ? "yes" : "NO") << std::endl;
  errors.print(1e-12);
}

void check_layer()
{
  const double tau = 0.3, layer = 0.4, step = 1e-3;
  Errors       errors;
  const auto   slope = [&](const double delta) {
    return approach_speed(Dual(1, 0, delta), Dual(tau), layer).dx(0) * tau;
  };
  errors.compare("slope 1/tau at the die", slope(0.), 1.);
  errors.compare("smooth through zero", slope(-1e-4 * step), slope(1e-4 * step));
  const ApproachLaw cut(layer, 0.1);
  const double      A = std::asinh(0.7 / layer);
  errors.compare("inside", approach_speed(-0.7, tau, cut), -layer / tau * A / std::sqrt(1. + 25. * A * A));
  errors.compare("bound inside", std::max(1., approach_speed(-1e250, tau, cut) / (-0.2 * layer / tau)), 1.);
  for (const double delta : {-2., -0.3, 0.4})
    errors.compare(
      "slope", approach_slope(delta, tau, cut), approach_speed(Dual(1, 0, delta), Dual(tau), cut).dx(0));
  errors.compare("asinh", approach_speed(0.7, tau, layer), layer / tau * std::asinh(0.7 / layer));
  for (const double l : {0., layer})
  {
    const ApproachLaw at_once(l, 0.1), slow(l, 0.1, 0.3);
    errors.compare("sunk edges come out slowly",
                   approach_speed(-0.7, tau, slow),
                   0.3 * approach_speed(-0.7, tau, at_once));
    errors.compare("and arrive as all", approach_speed(0.7, tau, slow), approach_speed(0.7, tau, at_once));
    for (const double delta : {-2., -0.3, 0.4})
      errors.compare("slope of edges",
                     approach_slope(delta, tau, slow),
                     approach_speed(Dual(1, 0, delta), Dual(tau), slow).dx(0));
    errors.compare("those of nodes",
                   approach_speed(-0.7, tau, slow.of(ContactPoint::node(0))),
                   approach_speed(-0.7, tau, at_once));
  }
  std::cout << "layer" << std::endl;
  errors.print(1e-12);
}

/// Laws that are known, one that nearly is, and a shear factor above 1.
void check_names()
{
  for (const auto &[law, friction] : {std::make_pair("Tresca", 1.),
                                      std::make_pair("Coulomb", 1.2),
                                      std::make_pair("Coulom", 0.1),
                                      std::make_pair("Tresca", 1.01)})
  {
    DieParameters die("upper");
    die.friction_law = law;
    die.friction     = friction;
    try
    {
      const DieState<double> state = initial_state(die);
      std::cout << "known: " << law << ", " << interface_law(state.interface_law).coefficient().name
                << ", limit " << state.shear_limit << std::endl;
    }
    catch (const Error &error)
    {
      std::cout << error.what() << std::endl;
    }
  }
}

/// Tractions without regularisation, sigma_0 = sqrt3^(m+1) K e^m.
void check_tractions()
{
  const MaterialLaw<double> metal(50., 0.2, 0.);
  const double  rate = 3., k = std::pow(std::sqrt(3.), 1.2) * 50. * std::pow(rate, 0.2) / std::sqrt(3.);
  Errors        errors;
  DieParameters die("upper");
  die.friction    = 0.3;
  die.shear_limit = 0.6;
  const auto tau  = [&](const std::string &law, const double slip, const double pressure) {
    die.friction_law = law;
    return friction_traction(initial_state(die).own_friction(), {slip, pressure, rate}, metal);
  };
  errors.compare("Tresca", tau("Tresca", 7., 100.), 0.3 * k);
  errors.compare("Tresca, at another slip", tau("Tresca", 0.7, 20.), 0.3 * k);
  errors.compare("Coulomb, little pressure", tau("Coulomb", 7., 1e-4 * k), 0.3 * 1e-4 * k);
  errors.compare("Coulomb, much pressure", tau("Coulomb", 7., 1e5 * k), 0.6 * k);
  errors.compare("Coulomb, at the limit", tau("Coulomb", 7., 2. * k), 0.6 * k * std::pow(2., -0.25));
  errors.compare("Coulomb, not pressed", tau("Coulomb", 7., 0.), 0.);
  std::cout << "tractions" << std::endl;
  errors.print(1e-12);
}

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  double                                   largest = 0.;
  for (const double m : {1., 0.5, 0.139, 0.05})
  {
    largest = std::max(largest, check_nodes("sliding", m, 0.1, true, 1.2));
    largest = std::max(largest, check_nodes("stuck", m, 0.1, false, 1.2));
  }
  largest = std::max(largest, check_nodes("sliding, not regularised", 1., 0., true, 1.2));
  largest = std::max(largest, check_nodes("without friction area", 0.139, 0.1, true, 0.));

  largest = std::max(largest, check_nodes("within a layer", 0.139, 0.1, true, 1.2, 0.4));
  largest = std::max(largest, check_nodes("within a layer, cut", 0.139, 0.1, true, 1.2, {0.4, 0.1}));

  for (const std::string name : {"Tresca", "Coulomb"})
  {
    const unsigned int law = find_interface_law(name, "test");
    for (const double m : {1., 0.139})
      largest = std::max(largest, check_nodes(name + ", sliding", m, 0.1, true, 1.2, {0.4, 0.1}, law));
    largest = std::max(largest, check_nodes(name + ", stuck", 0.139, 0.1, false, 1.2, {}, law));
  }
  check_names();
  check_tractions();

  // Exactly at rest against the die: zero to the power zero.
  Errors           at_rest;
  Random           random;
  NodeCase<double> c = random_case(random, 1., 0.);
  c.node.u           = Vec3();
  check_tangent(c, at_rest);
  check_reverse(c, random.vector(), at_rest);
  std::cout << "at rest, not regularised, m = 1" << std::endl;
  at_rest.print(1e-12);
  largest = std::max(largest, at_rest.largest());

  Errors potential;
  for (const std::string name : {"Norton", "Tresca"})
    for (const double m : {1., 0.5, 0.139})
      for (unsigned int k = 0; k < 20; ++k)
      {
        NodeCase<double> sliding   = random_case(random, m, 0.5);
        sliding.node.interface_law = find_interface_law(name, "test");
        check_potential(sliding, potential);
      }
  std::cout << "potential" << std::endl;
  potential.print(1e-9);

  for (const bool quadratic : {false, true})
    for (const Lower lower : {Lower::plane, Lower::smooth, Lower::facets})
      for (const bool sharp : {false, true})
        largest =
          std::max(largest, check_meshes({lower == Lower::plane ? 0.9 : 0.4, sharp}, lower, quadratic));
  std::cout << "narrower at walls" << std::endl;
  for (const bool quadratic : {false, true})
    for (const Lower lower : {Lower::plane, Lower::smooth, Lower::facets})
      largest =
        std::max(largest, check_meshes({lower == Lower::plane ? 0.9 : 0.6, false, 0.4}, lower, quadratic));
  std::cout << "metal that comes and goes" << std::endl;
  for (const bool quadratic : {false, true})
    for (const Lower lower : {Lower::plane, Lower::smooth, Lower::facets})
      largest = std::max(
        largest, check_meshes({lower == Lower::plane ? 0.9 : 0.6, false, 0.4}, lower, quadratic, true));
  std::cout << "a law that follows the strain rate of the metal" << std::endl;
  for (const bool moves : {false, true})
    for (const auto &[lower, quadratic] : {std::make_pair(Lower::plane, false),
                                           std::make_pair(Lower::plane, true),
                                           std::make_pair(Lower::smooth, false)})
      largest = std::max(largest,
                         check_meshes({lower == Lower::plane ? 0.9 : 0.6, false, 0.4},
                                      lower,
                                      quadratic,
                                      moves,
                                      find_interface_law("Tresca", "test")));
  check_ramp();
  check_layer();
  std::cout << "FIGURE contact_derivative_error " << largest << std::endl;
}
