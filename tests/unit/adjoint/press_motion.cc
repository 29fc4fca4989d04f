// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors

// A press driven by a crank, known to the tests only (../steps/crank_press.h), in whole runs of a block under
// a tilted die, both pairs of elements. The derivative of the energy by the numbers of the motion and the
// speed: by the adjoint and by the direct method, to 1e-10; differences of replays, to 1e-6; the remainder of
// second order; differences of runs that decide everything. The energy is less than at constant speed, since
// the crank is slower here.

#include "../steps/crank_press.h"
#include "recorded_run.h"

#include <deal.II/base/mpi.h>

#include <cmath>
#include <iostream>

using namespace retroforge;

namespace
{
  std::string yes(const bool holds)
  {
    return holds ? "yes" : "NO";
  }

  double relative_error(const double found, const double right)
  {
    return std::abs(found / right - 1.);
  }

  /// A number of the process by which derivatives are taken.
  struct Way
  {
    std::string  name;
    bool         speed  = false;
    unsigned int number = 0; ///< of the motion, else

    template <typename Number>
    Number &of(Process<Number> &process) const
    {
      return speed ? process.dies[1].velocity[2] : process.operations[0].motion.numbers[number];
    }
  };

  Parameters crank_scene(const bool quadratic)
  {
    Parameters p           = tilted_block();
    p.press.motion_type    = "crank";
    p.press.motion_numbers = {8., 5.};
    if (quadratic)
    {
      p.discretization.choice.pair = ElementPair::taylor_hood;
      p.billet.element_size        = 20.;
    }
    return p;
  }

  void check(const std::string &name, const Parameters &parameters)
  {
    const RecordedRun   run(parameters);
    const AdjointResult bar   = run.adjoint();
    Parameters          plain = parameters;
    plain.press.motion_type   = "constant speed";
    plain.press.motion_numbers.clear();
    std::cout << name << ", less energy than at constant speed: "
              << yes(run.state().energy.total() < RecordedRun(plain).state().energy.total()) << "\n";
    for (const Way &way : {Way{"radius", false, CrankPress::radius},
                           Way{"height", false, CrankPress::height},
                           Way{"speed", true, 0}})
    {
      Process<double> process_bar = bar.process, at = run.process();
      const double    adjoint = way.of(process_bar), size = std::abs(way.of(at));
      auto            along         = converted<Dual>(run.process());
      way.of(along).fastAccessDx(0) = 1.;
      NodalVectors<Dual> X;
      convert(run.X_0(), X);
      const auto energy = [&](const double change) {
        Process<double> process = run.process();
        way.of(process) += change;
        return run.replayed_energy(process, run.X_0());
      };
      double best = 1e300, order = 0.;
      for (const double h : {1e-3, 1e-4, 1e-5})
        best =
          std::min(best, relative_error((energy(h * size) - energy(-h * size)) / (2. * h * size), adjoint));
      const double here      = energy(0.);
      const auto   remainder = [&](const double t) {
        return std::abs(energy(t * size) - here - t * size * adjoint);
      };
      for (const double h : {1e-2, 4e-3})
        if (const double found = std::log2(remainder(h) / remainder(0.5 * h));
            std::abs(found - 2.) < std::abs(order - 2.))
          order = found;
      std::cout << "  by the " << way.name << ": direct method within 1e-10: "
                << yes(relative_error(run.derivative(along, X), adjoint) < 1e-10)
                << ", differences within 1e-6: " << yes(best < 1e-6)
                << ", remainder of second order: " << yes(std::abs(order - 2.) < 0.1) << "\n";
    }
    const auto free = [&](const double change) {
      Parameters other = parameters;
      other.press.motion_numbers[CrankPress::radius] += change;
      return RecordedRun(other).state().energy.total();
    };
    constexpr double h = 1e-3;
    std::cout << "  runs that decide everything, by the radius: within 1e-5: "
              << yes(relative_error((free(h) - free(-h)) / (2. * h),
                                    bar.process.operations[0].motion.numbers[0]) < 1e-5)
              << "\n";
  }
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  add_crank_press();
  check("mini element", crank_scene(false));
  check("quadratic velocities", crank_scene(true));
}
