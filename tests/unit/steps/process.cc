// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// A process of two operations, the first at constant speed with dies 0 and 1, the second driven by a crank
// with dies 0 and 2.
// - Which dies are in the press, where they are, and how fast they go on the mean; dies that are not of the
//   operation stand still. Strokes lead dies to the same places whatever the motion.
// - Times: of the crank by its angle, r (a_1 - a_0) / v; they add up over increments; the mean speed times
//   the time is the path.
// - reverse_over against dual numbers: <A x_dot, y> = <x_dot, A^T y> for all numbers of the process, from
//   those of laws and dies, dt, tau and the time at the start; at the end of a stroke, too.
// - A motion that does not exist is refused with those there are.

#include <deal.II/base/mpi.h>

#include "../random_numbers.h"
#include "crank_press.h"
#include <retroforge/core/error.h>
#include <retroforge/steps/process.h>

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
    process.dies[1].velocity     = Vec3({0., 0., -100.});
    process.dies[2].velocity     = Vec3({3., 0., -40.});
    process.operations           = {{{0, 1}, 1, 1.1, {}, 8.}, {{0, 2}, 2, 0.9, {{50., 30.}, crank}}};
    return process;
  }

  /// All that the pull-back begins with, as a sum with random weights.
  struct Weights
  {
    PhysicsBar bar;
    double     approach = 0.3;

    explicit Weights(const std::vector<Die> &dies) : bar(dies)
    {
      for_each_number([](double &x) { x = numbers.scalar(); }, static_cast<Physics<double> &>(bar));
      bar.dt   = numbers.scalar();
      bar.tau  = numbers.scalar();
      bar.time = numbers.scalar();
    }

    double along(const Process<Dual> &process, const StrokeStep &at) const
    {
      const Physics<Dual> physics = process.over(at);
      const Dual          dt      = process.duration(at);
      double              sum     = (bar.dt + approach * bar.tau) * dt.dx(0) +
                   bar.time * process.whole_time(at.stroke, at.operation).dx(0);
      for_each_number([&](const Dual &x, const double &x_bar) { sum += x_bar * x.dx(0); },
                      physics,
                      static_cast<const Physics<double> &>(bar));
      return sum;
    }
  };

  double defect(const Process<double> &process, const std::vector<Die> &dies, const StrokeStep &at)
  {
    Process<Dual> along;
    convert(process, along);
    Process<double> direction = process, bar = no_process_derivatives(process, dies);
    for_each_number([](double &x) { x = numbers.scalar(); }, direction);
    for_each_number([](Dual &x, const double &x_dot) { x.fastAccessDx(0) = x_dot; }, along, direction);
    const Weights weights(dies);
    reverse_over(process, at, weights.approach, weights.bar, bar);
    double reverse = 0.;
    for_each_number([&](const double &x, const double &y) { reverse += x * y; }, direction, bar);
    return std::abs(weights.along(along, at) / reverse - 1.);
  }

  double nonzero_numbers_of_motion(const Process<double> &process, const std::vector<Die> &dies)
  {
    Process<double> bar = no_process_derivatives(process, dies);
    reverse_over(process, {4., 2., 1}, 0.3, Weights(dies).bar, bar);
    return std::min(std::abs(bar.operations[1].motion.numbers[0]),
                    std::abs(bar.operations[1].motion.numbers[1]));
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const auto                               dies    = three_planes();
  const Process<double>                    process = two_operations(add_crank_press());

  const auto first = process.over({5., 2., 0}), second = process.over({5., 2., 1});
  const auto in_press = [](const Physics<double> &physics) {
    return std::to_string(physics.dies[0].in_press) + std::to_string(physics.dies[1].in_press) +
           std::to_string(physics.dies[2].in_press);
  };
  std::cout << "in the press: " << in_press(first) << ", then " << in_press(second) << "\n"
            << "the other one stands still: "
            << yes(first.dies[2].velocity.norm() == 0. && second.dies[1].velocity.norm() == 0.) << "\n";

  const double v = process.dies[2].velocity.norm(), path = 0.9 * 5. / v;
  std::cout << "where they are: "
            << yes((first.dies[1].displacement - Vec3({0., 0., -5.5})).norm() < 1e-14 &&
                   (second.dies[2].displacement - path * process.dies[2].velocity).norm() < 1e-14 &&
                   second.dies[0].displacement == process.dies[0].displacement)
            << "\n"
            << "at constant speed: " << yes(first.dies[1].velocity == process.dies[1].velocity) << ", "
            << yes(std::abs(process.duration({5., 2., 0}) - 1.1 * 2. / 100.) < 1e-16) << "\n";

  const auto angle = [](const double gone) { return std::acos((30. - gone) / 50. - 1.); };
  std::cout
    << "the crank by its angle: "
    << yes(std::abs(process.duration({5., 2., 1}) - 0.9 * 50. * (angle(7.) - angle(5.)) / v) < 1e-14)
    << "\ntimes add up: "
    << yes(std::abs(process.time(7., 1) - process.time(5., 1) - process.duration({5., 2., 1})) < 1e-14)
    << "\nspeed times time is the path: "
    << yes((second.dies[2].velocity * process.duration({5., 2., 1}) - 0.9 * 2. / v * process.dies[2].velocity)
             .norm() < 1e-14)
    << ", slower than at the middle of the way: "
    << yes(second.dies[2].velocity.norm() < process.dies[2].velocity.norm()) << "\n";

  for (const StrokeStep &at : {StrokeStep{5., 2., 0}, StrokeStep{5., 2., 1}, StrokeStep{0., 2., 1}})
    std::cout << "operation " << at.operation << " from " << at.stroke
              << " mm, dot product: " << yes(defect(process, dies, at) < 1e-12) << "\n";
  std::cout << "the crank's numbers have derivatives: " << yes(nonzero_numbers_of_motion(process, dies) > 0.)
            << "\n";
  try
  {
    find_press_motion("cranck", "Press/motion");
  }
  catch (const Error &error)
  {
    std::cout << error.what() << "\n";
  }
}
