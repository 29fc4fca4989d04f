// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// Ends of increments that follow the state (steps/moved_ends.h), of a process whose first operation goes at constant
// speed and whose second one is driven by a crank, and on a block whose inner nodes are a little off their places.
// - The process of moved ends: the given one where they have not moved; else dies begin where their stroke has them, go
//   on to where the stroke of the end has them, in a time in proportion to the length; other operations stay.
//   Its reverse and that of what objectives see of such an increment against dual numbers.
// - How far an end moves: in closed form where positions are ahead along the increment's own motion, by the stroke that
//   fits best the strains of any other, nothing by translations, rotations and where nothing flows, and less than b.
//   Its reverse against dual numbers, and the order of the remainder of Taylor's expansion. On the last mesh of an
//   operation a part of how far the increment begins beside its record, whatever the positions are.
// - Which ends follow what: up to the last new mesh of each operation the state, at most to the middle of the shorter one
//   of the increments that meet there; from there on starts, and ever less of them; none where no mesh was made anew within
//   an operation.

#include <deal.II/base/mpi.h>

#include "../mesh/block_mesh.h"
#include "../random_numbers.h"
#include "crank_press.h"
#include <retroforge/steps/moved_ends.h>
#include <retroforge/time/objective_trace.h>

#include <iostream>

using namespace retroforge;

namespace
{
  RandomNumbers numbers;

  std::string yes(const bool holds)
  {
    return holds ? "yes" : "NO";
  }

  std::vector<Die> three_planes()
  {
    return {Die("lower", Vec3(), Vec3({0., 0., 1.})),
            Die("upper", Vec3({0., 0., 30.}), Vec3({0., 0., -1.})),
            Die("second", Vec3({0., 0., 20.}), Vec3({0., 0., -1.}))};
  }

  Process<double> two_operations(const unsigned int crank)
  {
    Process<double> process;
    process.material = MaterialLaw<double>{1.7, 0.14, 1e-3};
    process.dies.resize(3);
    process.dies[0].displacement = Vec3({0., 0., 1.});
    process.dies[1].displacement = Vec3({0.2, 0., -0.4});
    process.dies[1].velocity     = Vec3({5., 0., -100.});
    process.dies[2].velocity     = Vec3({3., 0., -40.});
    process.operations           = {{{0, 1}, 1, 1.1, {}}, {{0, 2}, 2, 0.9, {{50., 30.}, crank}}};
    return process;
  }

  double largest_difference(const Process<double> &a, const Process<double> &b)
  {
    double largest = 0.;
    for_each_number(
      [&](const double &x, const double &y) { largest = std::max(largest, std::abs(x - y)); }, a, b);
    return largest;
  }

  /// Farthest that a die is from where it is in another place of the press [mm].
  double apart(const Physics<double> &a, const Physics<double> &b)
  {
    double largest = 0.;
    for (std::size_t d = 0; d < a.dies.size(); ++d)
      largest = std::max(largest, (a.dies[d].displacement - b.dies[d].displacement).norm());
    return largest;
  }

  void check_process(const Process<double> &process, const StrokeStep &at)
  {
    std::cout << "operation " << at.operation << " from " << at.stroke << " by " << at.step << " mm\n"
              << "  nothing has moved: the same numbers: "
              << yes(largest_difference(with_moved_ends(process, at, MovedEnds<double>{}), process) == 0.)
              << "\n";
    const MovedEnds<double> moved{0.13, -0.21};
    const auto              to  = with_moved_ends(process, at, moved);
    const double            end = at.stroke + at.step + moved.end, dt = to.duration(at);
    Physics<double>         dies = to.over(at);
    std::cout << "  dies begin where that stroke has them: "
              << yes(apart(dies, process.at_stroke(at.stroke + moved.start, at.operation)) < 1e-14);
    for (DieState<double> &die : dies.dies)
      die.displacement += die.velocity * dt;
    const auto there = process.at_stroke(end, at.operation);
    double     off   = 0.;
    for (const unsigned int d : process.operations[at.operation].dies)
      off = std::max(off, (dies.dies[d].displacement - there.dies[d].displacement).norm());
    const double longer = (at.step + moved.end - moved.start) / at.step;
    const auto   others = process.operations.size() - 1 - at.operation;
    std::cout << ", and end where theirs has them: " << yes(off < 1e-14)
              << "\n  time in proportion to the length: "
              << yes(std::abs(dt / (longer * process.duration(at)) - 1.) < 1e-14)
              << ", mean velocities as they were: "
              << yes((to.over(at).dies[1 + at.operation].velocity -
                      process.over(at).dies[1 + at.operation].velocity)
                       .norm() < 1e-12)
              << ", the other operation as it was: "
              << yes(to.duration({4., 2., static_cast<unsigned int>(others)}) ==
                     process.duration({4., 2., static_cast<unsigned int>(others)}))
              << "\n";
    const auto at_start =
      with_moved_ends(process, {at.stroke, 0., at.operation}, MovedEnds<double>{0.13, 0.13});
    std::cout << "  dies at a start that has moved: "
              << yes(apart(at_start.at_stroke(at.stroke, at.operation),
                           process.at_stroke(at.stroke + 0.13, at.operation)) < 1e-14)
              << "\n";
  }

  Process<Dual> along(const Process<double> &process, const Process<double> &direction)
  {
    Process<Dual> dual;
    convert(process, dual);
    for_each_number([](Dual &x, const double &x_dot) { x.fastAccessDx(0) = x_dot; }, dual, direction);
    return dual;
  }

  MovedEnds<Dual> along(const MovedEnds<double> &direction)
  {
    MovedEnds<Dual> ends{Dual(0.), Dual(0.)};
    ends.start.fastAccessDx(0) = direction.start;
    ends.end.fastAccessDx(0)   = direction.end;
    return ends;
  }

  /// Of all numbers of the process, and of the ends.
  struct Direction
  {
    Process<double>   process;
    MovedEnds<double> ends{numbers.scalar(), numbers.scalar()};

    explicit Direction(const Process<double> &of_shape) : process(of_shape)
    {
      for_each_number([](double &x) { x = numbers.scalar(); }, process);
    }

    double dot(const Process<double> &bar, const MovedEnds<double> &ends_bar) const
    {
      double sum = ends.start * ends_bar.start + ends.end * ends_bar.end;
      for_each_number([&](const double &x, const double &y) { sum += x * y; }, process, bar);
      return sum;
    }
  };

  /// Of a sum of all that an increment has of the process, with random weights.
  double defect_of_process(const Process<double> &process, const std::vector<Die> &dies, const StrokeStep &at)
  {
    constexpr double approach = 0.3;
    PhysicsBar       bar(dies);
    for_each_number([](double &x) { x = numbers.scalar(); }, static_cast<Physics<double> &>(bar));
    bar.dt = numbers.scalar(), bar.tau = numbers.scalar(), bar.time = numbers.scalar();
    const Direction     direction(process);
    const Process<Dual> moved = with_moved_ends(along(process, direction.process), at, along(direction.ends));
    const Physics<Dual> physics = moved.over(at);
    double              forward = (bar.dt + approach * bar.tau) * moved.duration(at).dx(0) +
                     bar.time * moved.whole_time(at.stroke, at.operation).dx(0);
    for_each_number([&](const Dual &x, const double &x_bar) { forward += x_bar * x.dx(0); },
                    physics,
                    static_cast<const Physics<double> &>(bar));
    Process<double> process_bar = no_process_derivatives(process, dies);
    reverse_over(process, at, approach, bar, process_bar);
    return std::abs(direction.dot(process_bar, reverse_moved_ends(process, at, process_bar)) / forward - 1.);
  }

  IncrementRecord record_of(const StrokeStep &at)
  {
    IncrementRecord record;
    record.stroke    = at.stroke;
    record.step      = at.step;
    record.operation = at.operation;
    return record;
  }

  double defect_of_row(const Process<double> &process, const std::vector<Die> &dies, const StrokeStep &at)
  {
    const PathRow<double> row_bar{
      {}, numbers.scalar(), numbers.scalar(), numbers.scalar(), numbers.scalar(), 0., 0.};
    const Direction direction(process);
    const auto   row = row_of<Dual>(record_of(at), along(process, direction.process), along(direction.ends));
    const double forward = row_bar.dt * row.dt.dx(0) + row_bar.time * row.time.dx(0) +
                           row_bar.stroke * row.stroke.dx(0) + row_bar.step * row.step.dx(0);
    PhysicsBar bar(dies);
    bar.dt = row_bar.dt, bar.time = row_bar.time;
    Process<double> process_bar = no_process_derivatives(process, dies);
    reverse_over(process, at, 0., bar, process_bar);
    return std::abs(
      direction.dot(process_bar, reverse_row(record_of(at), process.duration(at), row_bar)) / forward - 1.);
  }

  void check_rows(const Process<double> &process)
  {
    const StrokeStep first{5., 2., 0}, second{7., 1., 0};
    const auto       was = row_of<double>(record_of(first), process, {}),
               row       = row_of<double>(record_of(first), process, {0.13, -0.21}),
               next      = row_of<double>(record_of(second), process, {-0.21, 0.1});
    std::cout << "rows: as recorded: "
              << yes(was.stroke == 5. && was.step == 2. && was.dt == process.duration(first) &&
                     was.time == process.time(5., 0))
              << ", strokes: "
              << yes(std::abs(row.stroke - 5.13) < 1e-14 && std::abs(row.stroke + row.step - 6.79) < 1e-14)
              << ", places by decision: " << yes(row.place == 6. && row.length == 2.)
              << ", one begins when the other ends: " << yes(std::abs(row.time + row.dt - next.time) < 1e-15)
              << "\n";
  }

  /// The block of an increment, and how its metal moves.
  class Block
  {
  public:
    const StrokeStep      at{5., 2., 0};
    const double          b = 0.7;
    const Process<double> process;
    TetMesh mesh = block_mesh({{3, 2, 4}}, [](unsigned int, unsigned int, unsigned int) { return true; });
    NodalVectors<double> V, made;

    explicit Block(const Process<double> &of_press) : process(of_press)
    {
      for (Vec3 &x : mesh.X)
      {
        const bool inner = x[0] > 0. && x[0] < 3. && x[1] > 0. && x[1] < 2. && x[2] > 0. && x[2] < 4.;
        x                = 5. * x + (inner ? 0.8 : 0.) * numbers.vector();
        V.push_back(5. * upset(x) + cross_product_3d(Vec3({1., -2., 3.}), x));
        made.push_back(from() * x);
      }
    }

    /// From a place now to that when the mesh was made.
    static dealii::Tensor<2, 3> from()
    {
      return dealii::Tensor<2, 3>({{0.8, -0.3, 0.1}, {0.3, 0.9, 0.}, {0., 0., 1.3}});
    }

    static Vec3 upset(const Vec3 &x) { return Vec3({0.5 * x[0], 0.5 * x[1], -x[2]}); }

    /// Of a mesh that was made at other positions, from which it was stretched, sheared and turned.
    FollowingEnd end(const NodalVectors<double> &velocity) const
    {
      return {mesh, made, mesh.X, velocity, process, at, {1., b}};
    }

    NodalVectors<double> ahead(const double d) const
    {
      NodalVectors<double> X = mesh.X;
      for (std::size_t k = 0; k < X.size(); ++k)
        X[k] += d / at.step * process.duration(at) * V[k];
      return X;
    }

    /// Returns the part of what velocities do in the increment that strains as these displacements do, at the least
    /// squares of what is left.
    double part_of(const NodalVectors<double> &velocity, const NodalVectors<double> &X) const
    {
      const double dt = process.duration(at);
      double       a = 0., b2 = 0.;
      for (const auto &cell : mesh.cells)
      {
        dealii::Tensor<2, 3> edges, moved, strained; // a column per edge from the first corner
        for (unsigned int c = 0; c < 3; ++c)
          for (unsigned int i = 0; i < 3; ++i)
          {
            edges[i][c]    = mesh.X[cell[c + 1]][i] - mesh.X[cell[0]][i];
            moved[i][c]    = dt * (velocity[cell[c + 1]][i] - velocity[cell[0]][i]);
            strained[i][c] = X[cell[c + 1]][i] - X[cell[0]][i] - edges[i][c];
          }
        const auto   e = dealii::deviator(dealii::symmetrize(moved * invert(edges)));
        const auto   f = dealii::deviator(dealii::symmetrize(strained * invert(edges)));
        const double v = determinant(edges);
        a += v * (e * f);
        b2 += v * (e * e);
      }
      return a / b2;
    }
  };

  void check_end(const std::string &name, const Block &block)
  {
    const auto   small       = [](const double x) { return yes(std::abs(x) < 1e-12); };
    const double b           = block.b;
    const auto   stroke_less = [b](const double t) { return b * t / std::sqrt(b * b + t * t); };
    const auto   end         = block.end(block.V);
    double       off = 0., off_with_start = 0.;
    for (const double d : {-0.9, -1e-3, 0.2, 3.})
    {
      off = std::max(off, std::abs(end.moved(0., block.made, block.ahead(d)) - stroke_less(-d)));
      off_with_start =
        std::max(off_with_start, std::abs(end.moved(0.3, block.made, block.ahead(d)) - stroke_less(0.3 - d)));
    }
    std::cout << name << ", ahead by a stroke: " << small(off)
              << ", with a start that moves: " << small(off_with_start) << "\n";
    std::cout << "  by less than b: "
              << yes(std::abs(end.moved(0., block.made, block.ahead(100.))) < b &&
                     end.moved(0., block.made, block.ahead(100.)) < -0.99 * b &&
                     end.moved(0., block.made, block.ahead(-100.)) < b &&
                     end.moved(0., block.made, block.ahead(-100.)) > 0.99 * b)
              << "\n";
    NodalVectors<double> there = block.mesh.X;
    for (Vec3 &x : there)
      x += Vec3({0.4, -0.7, 0.3});
    std::cout << "  a translation: " << small(end.moved(0., block.made, there));
    const auto rotated = [&](const double angle) {
      NodalVectors<double> X = block.mesh.X;
      for (Vec3 &x : X)
        x = Vec3({x[0],
                  std::cos(angle) * x[1] - std::sin(angle) * x[2],
                  std::sin(angle) * x[1] + std::cos(angle) * x[2]});
      return end.moved(0., block.made, X);
    };
    const double order = std::log2(rotated(2e-3) / rotated(1e-3));
    std::cout << ", a rotation in second order: " << yes(std::abs(order - 2.) < 0.01);
    const auto still = block.end(NodalVectors<double>(block.mesh.n_nodes()));
    std::cout << ", nothing flows: "
              << yes(still.moved(0., block.made, block.ahead(1.)) == 0. &&
                     std::abs(still.moved(0.2, block.made, block.ahead(1.)) - stroke_less(0.2)) < 1e-15)
              << "\n";
    const NodalVectors<double> V  = numbers.vectors(block.mesh.n_nodes()),
                               dX = numbers.vectors(block.mesh.n_nodes());
    const auto of_any             = block.end(V);
    const auto X_at               = [&](const double h) {
      NodalVectors<double> X = block.mesh.X;
      for (std::size_t k = 0; k < X.size(); ++k)
        X[k] += h * dX[k];
      return X;
    };
    const double least = stroke_less(-block.at.step * block.part_of(V, X_at(1e-3)));
    std::cout << "  of any motion, the stroke that fits best: "
              << yes(std::abs(of_any.moved(0., block.made, X_at(1e-3)) / least - 1.) < 1e-10) << "\n";

    // Another shape of the mesh when it was made, and the same motion since.
    NodalVectors<double> made = block.made, now = block.mesh.X;
    for (std::size_t k = 0; k < made.size(); ++k)
    {
      const Vec3 d = 0.01 * Vec3({made[k][0] + made[k][1], -0.3 * made[k][2], 2. * made[k][2]});
      made[k] += d;
      now[k] += invert(block.from()) * d;
    }
    std::cout << "  what it was made with: " << small(of_any.moved(0., made, now))
              << ", else: " << yes(std::abs(of_any.moved(0., block.made, now)) > 1e-4) << "\n";

    const double bar = numbers.scalar(), start_dot = numbers.scalar();
    const auto   with_derivatives = [](const NodalVectors<double> &at, const NodalVectors<double> &d_at) {
      NodalVectors<Dual> dual;
      convert(at, dual);
      for_each_number([](Dual &x, const double &d) { x.fastAccessDx(0) = d; }, dual, d_at);
      return dual;
    };
    const NodalVectors<double> dM     = numbers.vectors(block.mesh.n_nodes());
    const NodalVectors<Dual>   X_dual = with_derivatives(block.mesh.X, dX),
                             M_dual   = with_derivatives(block.made, dM);
    Dual start(0.);
    start.fastAccessDx(0)            = start_dot;
    NodalVectors<double>       X_bar = numbers.vectors(block.mesh.n_nodes()), M_bar = X_bar;
    const NodalVectors<double> was       = X_bar;
    const double               start_bar = of_any.reverse_moved(bar, M_bar, X_bar);
    const double               reverse =
      start_bar * start_dot + dot(X_bar, dX) - dot(was, dX) + dot(M_bar, dM) - dot(was, dM);
    std::cout << "  dot product: "
              << yes(std::abs(bar * of_any.moved(start, M_dual, X_dual).dx(0) / reverse - 1.) < 1e-12);
    const double slope     = (dot(X_bar, dX) - dot(was, dX)) / bar;
    const auto   remainder = [&](const double h) {
      return std::abs(of_any.moved(0., block.made, X_at(h)) - h * slope);
    };
    const double h = 0.05 * b / std::abs(slope);
    std::cout << ", remainder at least of second order: "
              << yes(std::log2(remainder(h) / remainder(0.5 * h)) > 1.95) << "\n";
  }

  void check_last_mesh(const Block &block)
  {
    const FollowingEnd end(
      block.mesh, block.made, block.mesh.X, block.V, block.process, block.at, {0.75, 0.});
    NodalVectors<double> X_bar(block.mesh.n_nodes()), M_bar = X_bar;
    const double         start_bar = end.reverse_moved(2., M_bar, X_bar);
    std::cout << "on the last mesh, part of the start: "
              << yes(std::abs(end.moved(0.4, block.made, block.ahead(0.3)) - 0.3) < 1e-15)
              << ", reverse: " << yes(start_bar == 1.5 && dot(X_bar, X_bar) + dot(M_bar, M_bar) == 0.)
              << "\n";
  }

  void check_rules()
  {
    const std::vector<StrokeStep> increments = {
      {0., 2., 0}, {2., 1., 0}, {3., 2., 0}, {5., 1., 0}, {6., 3., 0}, {0., 1., 1}, {1., 3., 1}};
    const auto                       rules  = following_rules(increments, {0, 2, 5});
    const std::vector<FollowingRule> wanted = {
      {1., 0.5}, {1., 0.5}, {2. / 3., 0.}, {0.75, 0.}, {0., 0.}, {0.75, 0.}, {0., 0.}};
    bool same = rules.size() == wanted.size();
    for (std::size_t i = 0; same && i < rules.size(); ++i)
      same = std::abs(rules[i].of_start - wanted[i].of_start) < 1e-15 && rules[i].most == wanted[i].most;
    // Of the stroke of 9 mm 6 are left at the one new mesh on the way.
    const auto held = following_rules(increments, {0, 2, 5}, 0.67),
               led  = following_rules(increments, {0, 2, 5}, 0.66);
    std::cout << "a new mesh with too little of the stroke left: held: " << yes(held.empty())
              << ", with enough: " << yes(led == rules) << "; of two the later one: "
              << yes(following_rules(increments, {1, 4}, 0.4) == following_rules(increments, {1})) << "\n";
    std::cout << "rules of two operations: " << yes(same) << ", new meshes between operations only: none: "
              << yes(following_rules(increments, {0, 5}).empty()) << "\n";
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const auto                               dies    = three_planes();
  const Process<double>                    process = two_operations(add_crank_press());
  for (const StrokeStep &at : {StrokeStep{5., 2., 0}, StrokeStep{5., 2., 1}, StrokeStep{0., 1., 1}})
    check_process(process, at);
  for (const StrokeStep &at :
       {StrokeStep{5., 2., 0}, StrokeStep{5., 2., 1}, StrokeStep{0., 1., 1}, StrokeStep{5., 0., 1}})
    std::cout << "operation " << at.operation << " from " << at.stroke << " by " << at.step
              << " mm, dot product: " << yes(defect_of_process(process, dies, at) < 1e-12)
              << (at.step > 0. ? ", of rows: " + yes(defect_of_row(process, dies, at) < 1e-12) : "") << "\n";
  check_rows(process);
  const Block block(process);
  check_end("an end", block);
  check_last_mesh(block);
  check_rules();
}
