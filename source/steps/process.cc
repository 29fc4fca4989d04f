// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/mpi.h>

#include <retroforge/steps/process.h>

namespace retroforge
{
  template <typename Number>
  Number Process<Number>::speed() const
  {
    AssertIndexRange(leading_die, dies.size());
    using std::sqrt;
    const Vector3<Number> &v = dies[leading_die].velocity;
    return sqrt(Number(v * v));
  }

  template <typename Number>
  Number Process<Number>::time(const double stroke) const
  {
    return stretch * stroke / speed();
  }

  template <typename Number>
  Physics<Number> Process<Number>::at_stroke(const double stroke) const
  {
    Physics<Number> physics{material, contact, dies};
    const Number    passed = time(stroke);
    for (auto &die : physics.dies)
      die.displacement += die.velocity * passed;
    return physics;
  }

  template struct Process<double>;
  template struct Process<Dual>;

  void reverse_at_stroke(const Process<double> &process,
                         const StrokeStep      &step,
                         const double           approach,
                         const PhysicsBar      &bar,
                         Process<double>       &process_bar)
  {
    AssertDimension(bar.dies.size(), process.dies.size());
    AssertDimension(process_bar.dies.size(), process.dies.size());
    process_bar.material.numbers.resize(process.material.numbers.size(), 0.);
    add_numbers(bar.material, process_bar.material);
    add_numbers(bar.contact, process_bar.contact);
    // In stretch/speed, by which all times are made of strokes.
    double pace_bar = (bar.dt + approach * bar.tau) * step.step;
    auto   dies_bar = bar.dies;
    for (std::size_t d = 0; d < dies_bar.size(); ++d)
    {
      dies_bar[d].velocity += process.time(step.stroke) * dies_bar[d].displacement;
      pace_bar += dies_bar[d].displacement * process.dies[d].velocity * step.stroke;
    }
    add_numbers(dies_bar, process_bar.dies);
    const double       speed   = process.speed();
    const unsigned int leading = process.leading_die;
    process_bar.stretch += pace_bar / speed;
    process_bar.dies[leading].velocity -=
      pace_bar * process.stretch / std::pow(speed, 3) * process.dies[leading].velocity;
  }

  Process<double> no_process_derivatives(const std::vector<Die> &dies)
  {
    Process<double> bar;
    bar.dies = no_derivatives(dies);
    for_each_number([](double &x) { x = 0.; }, bar);
    return bar;
  }

  void sum_over_ranks(Process<double> &process_bar, MPI_Comm comm)
  {
    std::vector<double> numbers;
    for_each_number([&](const double &x) { numbers.push_back(x); }, process_bar);
    dealii::Utilities::MPI::sum(numbers, comm, numbers);
    auto next = numbers.begin();
    for_each_number([&](double &x) { x = *next++; }, process_bar);
  }
} // namespace retroforge
