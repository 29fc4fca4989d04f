// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Vertices that move so that the volume is that of a quadratic velocity's flow. Proved on a block of random
// inner and outer nodes, whole or with planes of symmetry at x = 0 and y = 0:
// - the mesh's volume changes by the flux of the quadratic velocity through the surface, where all vertices
//   are free, or are held; by hand, a blade's faces give less; with freedoms 0 and 1, and no blade among the
//   vertices, equal parts to those that are free, or where none is to all three; the others, held beside free
//   ones, keep their velocity;
// - directions that a plane holds are left alone; a part moves as in the whole;
// - a blade (a flat tetrahedron) and a corner that three planes hold move by finite velocities;
// - <A x_dot, y> = <x_dot, A^T y> for X, V, freedom, A from Dual; remainders by Taylor are of order two;
// - the derivatives are continuous in the freedom where all are held, and where the normal's effect ends.
// A block upset to half its height by a quadratic flow without divergence keeps its volume but for the time
// scheme; with the velocities of its nodes alone it does not.

#include <retroforge/core/dual.h>
#include <retroforge/discretization/vertex_motion.h>
#include <retroforge/geometry/vector_algebra.h>
#include <retroforge/mesh/mesh_quality.h>

#include "../element/element_test_tools.h"
#include "../mesh/block_mesh.h"
#include "middles_of.h"

using namespace retroforge;

/// A mesh, its tables and what moves on it.
struct Motion
{
  TetMesh              mesh;
  Topology             topology;
  MiddleNodes          middles;
  NodalVectors<double> X, V;
  std::vector<double>  freedom;

  explicit Motion(const TetMesh &mesh)
      : mesh(mesh)
      , topology(mesh)
      , middles(middles_of(mesh))
      , X(mesh.X)
      , V(mesh.n_nodes() + middles.size())
      , freedom(mesh.n_nodes(), 1.)
  {
  }

  VertexMotionInput<double> input() const { return {mesh, topology, middles, X, V, freedom}; }
  NodalVectors<double>      velocities() const { return vertex_velocities(input()); }

  /// A flow's values at the nodes of the velocity.
  template <typename Flow>
  void interpolate(const Flow &flow)
  {
    for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
      V[k] = flow(X[k]);
    for (const auto &[a, b] : middles.ends())
      V[middles.between(a, b)] = flow(0.5 * (X[a] + X[b]));
  }
};

/// Between the face's nodes 0 and 1, 1 and 2, 2 and 0.
std::array<NodeIndex, 3> middles_of_face(const Motion &motion, const std::size_t f)
{
  const auto &n = motion.mesh.faces[f].nodes;
  return {{motion.middles.between(n[0], n[1]),
           motion.middles.between(n[1], n[2]),
           motion.middles.between(n[2], n[0])}};
}

/// Planes of symmetry at x = 0 and y = 0.
void cut(TetMesh &mesh)
{
  mesh.patches.push_back({"x0", Plane{Vec3(), Vec3({-1, 0, 0})}});
  mesh.patches.push_back({"y0", Plane{Vec3(), Vec3({0, -1, 0})}});
  for (BoundaryFace &face : mesh.faces)
    for (unsigned int d = 0; d < 2; ++d)
      if (mesh.X[face.nodes[0]][d] == 0. && mesh.X[face.nodes[1]][d] == 0. && mesh.X[face.nodes[2]][d] == 0.)
        face.patch = 2 + d;
}

/// Removes what a node's planes hold from its vector.
void hold(const Topology &topology, const NodeIndex k, Vec3 &v)
{
  for (const Vec3 &direction : topology.fixed_directions[k])
    v -= (v * direction) * direction;
}

/// Random positions, velocities and freedoms, on planes of symmetry within them.
Motion random_motion(RandomNumbers &random, const bool with_planes)
{
  TetMesh mesh = block_mesh({{2, 2, 3}}, [](unsigned int, unsigned int, unsigned int) { return true; });
  if (with_planes)
    cut(mesh);
  Motion motion(mesh);
  motion.V       = random.vectors(motion.V.size());
  motion.freedom = random.scalars(mesh.n_nodes());
  for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
  {
    Vec3 move = 0.1 * random.vector();
    hold(motion.topology, k, move);
    motion.X[k] += move;
    hold(motion.topology, k, motion.V[k]);
    motion.freedom[k] = 0.5 * (1. + motion.freedom[k]);
  }
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    if (!mesh.is_surface(mesh.faces[f]))
      for (const NodeIndex middle : middles_of_face(motion, f))
      {
        Vec3      &v      = motion.V[middle];
        const Vec3 normal = mesh.patches[mesh.faces[f].patch].symmetry->normal;
        v -= (v * normal) * normal;
      }
  return motion;
}

Vec3 area_vector(const Motion &motion, const std::size_t f)
{
  const auto &nodes = motion.mesh.faces[f].nodes;
  return 0.5 * cross(motion.X[nodes[1]] - motion.X[nodes[0]], motion.X[nodes[2]] - motion.X[nodes[0]]);
}

/// Volume that vertices with these velocities sweep, over all faces.
double swept(const Motion &motion, const NodalVectors<double> &w)
{
  double sum = 0.;
  for (std::size_t f = 0; f < motion.mesh.faces.size(); ++f)
    for (const NodeIndex k : motion.mesh.faces[f].nodes)
      sum += area_vector(motion, f) * w[k] / 3.;
  return sum;
}

/// s·(mean of the middles - mean of the vertices).
double missed(const Motion &motion, const std::size_t f)
{
  Vec3 sum;
  for (unsigned int i = 0; i < 3; ++i)
    sum += motion.V[middles_of_face(motion, f)[i]] - motion.V[motion.mesh.faces[f].nodes[i]];
  return area_vector(motion, f) * sum / 3.;
}

/// a_k of the header.
double effect(const Motion &motion, const NodeIndex k)
{
  Vec3   t;
  double A = 0.;
  for (const unsigned int f : motion.topology.surface_faces[k])
  {
    t += area_vector(motion, f) / 3.;
    A += area_vector(motion, f).norm() / 3.;
  }
  hold(motion.topology, k, t);
  const double x = std::min(t * t / (A * A) / least_effective_normal, 1.);
  return x * x * (3. - 2. * x);
}

/// What all faces give, and what is missed.
std::array<double, 2> given(const Motion &motion)
{
  std::array<double, 2> sums = {{0., 0.}};
  for (std::size_t f = 0; f < motion.mesh.faces.size(); ++f)
  {
    double held = 1., effects = 0.;
    for (const NodeIndex k : motion.mesh.faces[f].nodes)
    {
      held *= 1. - motion.freedom[k] * effect(motion, k);
      effects += effect(motion, k) / 3.;
    }
    if (motion.mesh.is_surface(motion.mesh.faces[f]))
    {
      sums[0] += (1. - held + held * effects) * missed(motion, f);
      sums[1] += missed(motion, f);
    }
  }
  return sums;
}

double least_effect(const Motion &motion)
{
  double least = 1.;
  for (NodeIndex k = 0; k < motion.mesh.n_nodes(); ++k)
    if (motion.topology.is_on_surface(k))
      least = std::min(least, effect(motion, k));
  return least;
}

void check_volume(RandomNumbers &random, const bool with_planes, Errors &errors)
{
  Motion       motion = random_motion(random, with_planes);
  const double nodal  = swept(motion, motion.V);
  errors.compare("volume, partly free", swept(motion, motion.velocities()), nodal + given(motion)[0]);
  errors.compare("no blade among the vertices", least_effect(motion), 1.);
  motion.freedom.assign(motion.freedom.size(), 1.);
  errors.compare("volume, all free", swept(motion, motion.velocities()), nodal + given(motion)[1]);

  // Some free, some held: equal parts.
  for (double &c : motion.freedom)
    c = random.scalar() > 0. ? 1. : 0.;
  NodalVectors<double> N(motion.X.size());
  std::vector<double>  d(motion.X.size(), 0.);
  for (std::size_t f = 0; f < motion.mesh.faces.size(); ++f)
    if (motion.mesh.is_surface(motion.mesh.faces[f]))
    {
      double n_free = 0.;
      for (const NodeIndex k : motion.mesh.faces[f].nodes)
        n_free += motion.freedom[k];
      for (const NodeIndex k : motion.mesh.faces[f].nodes)
      {
        N[k] += area_vector(motion, f) / 3.;
        if (n_free == 0.)
          d[k] += missed(motion, f) / 3.;
        else if (motion.freedom[k] == 1.)
          d[k] += missed(motion, f) / n_free;
      }
    }
  const auto w = motion.velocities();
  for (NodeIndex k = 0; k < w.size(); ++k)
  {
    Vec3 t = N[k];
    hold(motion.topology, k, t);
    const Vec3 expected = d[k] == 0. ? motion.V[k] : motion.V[k] + d[k] / (t * N[k]) * t;
    errors.compare("equal parts", {w[k][0], w[k][1], w[k][2]}, {expected[0], expected[1], expected[2]});
    double along = 0.;
    for (const Vec3 &direction : motion.topology.fixed_directions[k])
      along = std::max(along, std::abs((w[k] - motion.V[k]) * direction));
    errors.compare("held directions", 1. + along, 1.);
  }
}

/// A block, and the block with its mirror image at x = 0.
void check_whole(RandomNumbers &random, Errors &errors)
{
  Motion    part = random_motion(random, true);
  TetMesh   mesh = part.mesh;
  const int n    = mesh.n_nodes();
  // Nodes on the plane are their own images.
  std::vector<NodeIndex> image(n);
  for (NodeIndex k = 0; k < mesh.n_nodes() && k < NodeIndex(n); ++k)
    if (part.mesh.X[k][0] == 0.)
      image[k] = k;
    else
    {
      image[k] = mesh.X.size();
      mesh.X.push_back(Vec3({-part.mesh.X[k][0], part.mesh.X[k][1], part.mesh.X[k][2]}));
    }
  for (const auto &cell : part.mesh.cells)
    mesh.cells.push_back({{image[cell[0]], image[cell[2]], image[cell[1]], image[cell[3]]}});
  mesh.faces.clear();
  for (const BoundaryFace &face : part.mesh.faces)
    if (face.patch != 2)
    {
      mesh.faces.push_back(face);
      const auto &nodes = face.nodes;
      mesh.faces.push_back({{{image[nodes[0]], image[nodes[2]], image[nodes[1]]}}, face.patch});
    }
  Motion     whole(mesh);
  const auto mirrored = [](Vec3 v) {
    v[0] = -v[0];
    return v;
  };
  for (int k = 0; k < n; ++k)
    for (const bool mirror : {true, false})
    {
      const NodeIndex i = mirror ? image[k] : k;
      whole.X[i]        = mirror ? mirrored(part.X[k]) : part.X[k];
      whole.V[i]        = mirror ? mirrored(part.V[k]) : part.V[k];
      whole.freedom[i]  = part.freedom[k];
    }
  for (const auto &[a, b] : part.middles.ends())
  {
    const Vec3 v                                       = part.V[part.middles.between(a, b)];
    whole.V[whole.middles.between(image[a], image[b])] = mirrored(v);
    whole.V[whole.middles.between(a, b)]               = v;
  }
  const auto w = whole.velocities(), w_part = part.velocities();
  for (int k = 0; k < n; ++k)
    errors.compare(
      "a part as in the whole", {w[k][0], w[k][1], w[k][2]}, {w_part[k][0], w_part[k][1], w_part[k][2]});
}

/// Numbers of the motion, or a direction in them.
std::vector<double *> entries(NodalVectors<double> &X, NodalVectors<double> &V, std::vector<double> &freedom)
{
  std::vector<double *> all;
  for (auto *vectors : {&X, &V})
    for (Vec3 &v : *vectors)
      for (unsigned int i = 0; i < 3; ++i)
        all.push_back(&v[i]);
  for (double &c : freedom)
    all.push_back(&c);
  return all;
}

struct Direction
{
  NodalVectors<double> X, V;
  std::vector<double>  freedom;

  std::vector<double *> entries() { return ::entries(X, V, freedom); }
};

Direction zero_direction(const Motion &motion)
{
  return {NodalVectors<double>(motion.X.size()),
          NodalVectors<double>(motion.V.size()),
          std::vector<double>(motion.freedom.size(), 0.)};
}

Direction random_direction(const Motion &motion, RandomNumbers &random)
{
  return {
    random.vectors(motion.X.size()), random.vectors(motion.V.size()), random.scalars(motion.freedom.size())};
}

NodalVectors<double> tangent(const Motion &motion, const Direction &direction)
{
  const auto dual = [](const NodalVectors<double> &x, const NodalVectors<double> &x_dot) {
    NodalVectors<Dual> y(x.size());
    for (std::size_t k = 0; k < x.size(); ++k)
      for (unsigned int i = 0; i < 3; ++i)
      {
        y[k][i]                 = Dual(1, 0, x[k][i]);
        y[k][i].fastAccessDx(0) = x_dot[k][i];
      }
    return y;
  };
  const auto        X = dual(motion.X, direction.X), V = dual(motion.V, direction.V);
  std::vector<Dual> freedom;
  for (std::size_t k = 0; k < motion.freedom.size(); ++k)
  {
    freedom.emplace_back(1, 0, motion.freedom[k]);
    freedom.back().fastAccessDx(0) = direction.freedom[k];
  }
  NodalVectors<double> w_dot;
  for (const auto &v : vertex_velocities<Dual>({motion.mesh, motion.topology, motion.middles, X, V, freedom}))
    w_dot.push_back(Vec3({v[0].dx(0), v[1].dx(0), v[2].dx(0)}));
  return w_dot;
}

double norm(const NodalVectors<double> &x)
{
  double sum = 0.;
  for (const Vec3 &v : x)
    sum += v * v;
  return std::isfinite(sum) ? std::sqrt(sum) : 1e300;
}

NodalVectors<double>
combined(const NodalVectors<double> &x, const double factor, const NodalVectors<double> &y)
{
  NodalVectors<double> z = x;
  for (std::size_t k = 0; k < z.size(); ++k)
    z[k] += factor * y[k];
  return z;
}

Motion moved(const Motion &motion, const double step, const Direction &direction)
{
  Motion after = motion;
  after.X      = combined(motion.X, step, direction.X);
  after.V      = combined(motion.V, step, direction.V);
  for (std::size_t k = 0; k < after.freedom.size(); ++k)
    after.freedom[k] += step * direction.freedom[k];
  return after;
}

void check_reverse(const std::string &what,
                   const Motion      &motion,
                   Direction          direction,
                   RandomNumbers     &random,
                   Errors            &errors)
{
  const auto      y   = random.vectors(motion.X.size());
  auto            bar = zero_direction(motion);
  VertexMotionBar reverse{bar.X, bar.V, bar.freedom};
  reverse_vertex_velocities(motion.input(), y, reverse);
  const auto w_dot   = tangent(motion, direction);
  double     forward = 0., backward = 0., size = 0.;
  for (std::size_t k = 0; k < y.size(); ++k)
  {
    forward += w_dot[k] * y[k];
    size += std::abs(w_dot[k] * y[k]);
  }
  const auto x_dot = direction.entries(), x_bar = entries(reverse.X, reverse.V, reverse.freedom);
  for (std::size_t i = 0; i < x_dot.size(); ++i)
    backward += *x_dot[i] * *x_bar[i];
  errors.compare(what, 1. + (backward - forward) / size, 1.);
}

/// Orders of the remainder over halvings.
void print_taylor(const std::string &what, const Motion &motion, const Direction &direction)
{
  const auto w = motion.velocities(), w_dot = tangent(motion, direction);
  std::cout << "  Taylor, " << what << ":";
  double last = 0.;
  for (const double step : {1e-2, 5e-3, 2.5e-3, 1.25e-3})
  {
    const double rest =
      norm(combined(combined(moved(motion, step, direction).velocities(), -1., w), -step, w_dot));
    if (rest < 1e-13 * norm(w))
      std::cout << " nothing";
    else if (last > 0.)
      std::cout << " " << std::log2(last / rest);
    last = rest;
  }
  std::cout << std::endl;
}

void check_derivatives(RandomNumbers &random, Errors &errors)
{
  const Motion motion = random_motion(random, true);
  Direction    all    = random_direction(motion, random);
  for (const std::string what : {"X", "V", "freedom", "all"})
  {
    auto part = zero_direction(motion);
    if (what == "X" || what == "all")
      part.X = all.X;
    if (what == "V" || what == "all")
      part.V = all.V;
    if (what == "freedom" || what == "all")
      part.freedom = all.freedom;
    check_reverse("dot product, " + what, motion, part, random, errors);
    print_taylor(what, motion, part);
  }
}

/// Derivatives at a distance to a point against those there, over halvings of the distance: order one where
/// they are continuous.
void print_continuity(const std::string &what,
                      const Motion      &at,
                      const Direction   &away,
                      const Direction   &direction)
{
  const auto there = tangent(at, direction);
  std::cout << "  derivatives approach " << what << ":";
  double last = 0.;
  for (const double distance : {1e-3, 5e-4, 2.5e-4})
  {
    const double difference = norm(combined(tangent(moved(at, distance, away), direction), -1., there));
    if (last > 0.)
      std::cout << " " << std::log2(last / difference);
    last = difference;
  }
  std::cout << std::endl;
}

/// A flat tetrahedron. The faces at vertex 0 cancel the more the shorter its edge 2-3 is.
Motion blade(RandomNumbers &random, const double length)
{
  TetMesh mesh;
  mesh.X       = {Vec3({0., -1., 0.}), Vec3({0., 1., 0.}), Vec3({-1., 0., 0.}), Vec3({-1., length, 0.035})};
  mesh.cells   = {{{0, 1, 2, 3}}};
  mesh.patches = {{"all", {}}};
  for (const CellFace &face : boundary_cell_faces(mesh.cells))
    mesh.faces.push_back({face.nodes, 0});
  Motion motion(mesh);
  motion.V = random.vectors(motion.V.size());
  motion.freedom.assign(4, 0.6);
  return motion;
}

void check_blades(RandomNumbers &random, Errors &errors)
{
  const Motion flat = blade(random, 0.2);
  double       fast = 0.;
  const auto   w    = flat.velocities();
  for (NodeIndex k = 0; k < 4; ++k)
    fast = std::max(fast, (w[k] - flat.V[k]).norm());
  std::cout << "  a blade's vertices move: "
            << (effect(flat, 0) < 1e-2 && fast > 0. && fast < 10. ? "yes" : "NO") << std::endl;
  errors.compare("volume of a blade", swept(flat, w), swept(flat, flat.V) + given(flat)[0]);
  check_reverse("dot product, a blade", flat, random_direction(flat, random), random, errors);

  // Where e = e_min at vertex 0.
  double low = 0.2, high = 2.;
  for (unsigned int k = 0; k < 60; ++k)
  {
    const double middle                                  = 0.5 * (low + high);
    (effect(blade(random, middle), 0) < 1. ? low : high) = middle;
  }
  const Motion    at        = blade(random, high);
  const Direction direction = random_direction(at, random);
  Direction       away      = zero_direction(at);
  away.X[3]                 = Vec3({0., 1., 0.});
  print_continuity("the least effective normal from above", at, away, direction);
  away.X[3] *= -1.;
  print_continuity("and from below", at, away, direction);

  // A vertex of the surface whose planes hold all directions.
  Motion     corner = random_motion(random, true);
  Rows<Vec3> fixed;
  for (NodeIndex k = 0; k < corner.mesh.n_nodes(); ++k)
  {
    const auto held = corner.topology.fixed_directions[k];
    if (k == corner.mesh.faces[0].nodes[0])
      fixed.entries.insert(fixed.entries.end(), {Vec3({1, 0, 0}), Vec3({0, 1, 0}), Vec3({0, 0, 1})});
    else
      fixed.entries.insert(fixed.entries.end(), held.begin(), held.end());
    fixed.begin.push_back(fixed.entries.size());
  }
  corner.topology.fixed_directions = fixed;
  const NodeIndex k                = corner.mesh.faces[0].nodes[0];
  errors.compare("a vertex held by three planes", 1. + (corner.velocities()[k] - corner.V[k]).norm(), 1.);
  check_reverse("dot product beside it", corner, random_direction(corner, random), random, errors);
}

void check_continuity(RandomNumbers &random)
{
  Motion    motion = random_motion(random, true);
  Direction away   = zero_direction(motion);
  away.freedom     = motion.freedom; // in [0, 1]
  motion.freedom.assign(motion.freedom.size(), 0.);
  const Direction direction = random_direction(motion, random);
  print_continuity("all held", motion, away, direction);
}

/// Part of its volume that a quarter of a block loses while it is upset from height 3 to 1.5 by
///   v = (x f'(z)/2, y f'(z)/2, -f(z)),  f = z + z (h - z)/h,  h the height;  f(0) = 0, f(h) = h.
double lost(const bool by_rule, const unsigned int n_steps)
{
  TetMesh mesh = block_mesh({{2, 2, 3}}, [](unsigned int, unsigned int, unsigned int) { return true; });
  cut(mesh);
  Motion motion(mesh);
  for (NodeIndex k = 0; k < mesh.n_nodes(); ++k)
    if (mesh.X[k][2] == 0. || mesh.X[k][2] == 3.)
      motion.freedom[k] = 0.;
  const auto velocities = [&] {
    double h = 0.;
    for (const Vec3 &x : motion.X)
      h = std::max(h, x[2]);
    motion.interpolate([h](const Vec3 &x) {
      const double slope = 2. - 2. * x[2] / h;
      return Vec3({0.5 * slope * x[0], 0.5 * slope * x[1], -x[2] * (2. - x[2] / h)});
    });
    return by_rule ? motion.velocities()
                   : NodalVectors<double>(motion.V.begin(), motion.V.begin() + mesh.n_nodes());
  };
  const double start = volume(mesh.cells, motion.X), dt = std::log(2.) / n_steps;
  for (unsigned int step = 0; step < n_steps; ++step)
  {
    const auto X = motion.X;
    motion.X     = combined(X, dt / 2., velocities()); // midpoint
    motion.X     = combined(X, dt, velocities());
  }
  return 1. - volume(mesh.cells, motion.X) / start;
}

int main()
{
  RandomNumbers random;
  Errors        errors;
  std::cout.precision(2);
  for (unsigned int k = 0; k < 5; ++k)
    for (const bool with_planes : {false, true})
      check_volume(random, with_planes, errors);
  check_whole(random, errors);
  check_derivatives(random, errors);
  check_blades(random, errors);
  check_continuity(random);
  errors.print(1e-13);
  const double nodal = lost(false, 20), rule = lost(true, 20), finer = lost(true, 40);
  std::cout << "volume lost by the nodes' velocities: " << nodal << "\nby the rule, less than 1/100 of it: "
            << (std::abs(rule) < 0.01 * std::abs(nodal) ? "yes" : "NO, " + std::to_string(rule))
            << "\nwith half the steps' length, order: " << std::log2(rule / finer) << std::endl;
}
