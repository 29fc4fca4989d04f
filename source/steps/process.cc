// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/core/error.h>
#include <retroforge/core/text.h>
#include <retroforge/steps/process.h>

#include <cmath>

namespace retroforge
{
  template <typename Number>
  const Vector3<Number> &Process<Number>::leading_velocity(const unsigned int operation) const
  {
    AssertIndexRange(operation, operations.size());
    AssertIndexRange(operations[operation].leading_die, dies.size());
    return dies[operations[operation].leading_die].velocity;
  }

  template <typename Number>
  Number Process<Number>::speed(const unsigned int operation) const
  {
    using std::sqrt;
    const Vector3<Number> &v = leading_velocity(operation);
    return sqrt(Number(v * v));
  }

  template <typename Number>
  Number Process<Number>::nominal_time(const double stroke, const unsigned int operation) const
  {
    return operations[operation].path_scale * stroke / speed(operation);
  }

  template <typename Number>
  Number Process<Number>::time(const double stroke, const unsigned int operation) const
  {
    return duration({0., stroke, operation});
  }

  template <typename Number>
  Number Process<Number>::duration(const StrokeStep &at) const
  {
    AssertIndexRange(at.operation, operations.size());
    const Operation<Number> &operation = operations[at.operation];
    return operation.path_scale * operation.motion.path(at.stroke, at.step) / speed(at.operation);
  }

  template <typename Number>
  StrokeStep Process<Number>::end() const
  {
    Assert(!operations.empty(), dealii::ExcMessage("a process has an operation"));
    return {value_of(operations.back().stroke), 0., static_cast<unsigned int>(operations.size() - 1)};
  }

  template <typename Number>
  Number Process<Number>::whole_stroke(const double stroke, const unsigned int operation) const
  {
    Number sum(stroke);
    for (unsigned int o = 0; o < operation; ++o)
      sum += operations[o].stroke;
    return sum;
  }

  template <typename Number>
  Number Process<Number>::whole_time(const double stroke, const unsigned int operation) const
  {
    Number sum = time(stroke, operation);
    for (unsigned int o = 0; o < operation; ++o)
      sum += time(value_of(operations[o].stroke), o) + operations[o + 1].waiting.transfer +
             operations[o + 1].waiting.dwell;
    return sum;
  }

  template <typename Number>
  Number Process<Number>::time_on_dies(const double stroke, const unsigned int operation) const
  {
    Number sum = whole_time(stroke, operation) + operations[0].waiting.dwell;
    for (unsigned int o = 1; o <= operation; ++o)
      sum -= operations[o].waiting.transfer;
    return sum;
  }

  namespace
  {
    /// Mean speed of a press over an increment, over that of its dies.
    template <typename Number>
    Number pace(const Operation<Number> &operation, const StrokeStep &at)
    {
      return at.step > 0. ? Number(at.step / operation.motion.path(at.stroke, at.step)) : Number(1.);
    }
  } // namespace

  template <typename Number>
  Physics<Number> Process<Number>::over(const StrokeStep &at) const
  {
    AssertIndexRange(at.operation, operations.size());
    const Operation<Number> &operation = operations[at.operation];
    Physics<Number>          physics{material, contact, dies, heat};
    const Number             passed = nominal_time(at.stroke, at.operation);
    const Number             faster = pace(operation, at);
    for (unsigned int d = 0; d < dies.size(); ++d)
    {
      DieState<Number> &die = physics.dies[d];
      die.in_press          = operation.has(d) ? 1 : 0;
      die.displacement += die.velocity * passed;
      die.velocity *= die.in_press == 1 ? faster : Number(0.);
    }
    return physics;
  }

  template <typename Number>
  Physics<Number> Process<Number>::at_stroke(const double stroke, const unsigned int operation) const
  {
    return over({stroke, 0., operation});
  }

  void check_waiting(const Process<double> &process)
  {
    for (unsigned int o = 0; o < process.operations.size(); ++o)
    {
      const Operation<double> &operation = process.operations[o];
      const Waiting<double>   &waiting   = operation.waiting;
      const std::string        of        = "operation " + std::to_string(o + 1) + ", ";
      for (const auto &[name, time] :
           {std::make_pair("transfer time", waiting.transfer), std::make_pair("dwell time", waiting.dwell)})
        if (!(time >= 0.) || !std::isfinite(time))
          throw Error(of + name,
                      "is " + as_text(time) + " s",
                      "a time is a number that is not negative",
                      "use 0 where the workpiece does not wait");
      if (!process.heat.conducts() || waiting.dwell == 0.)
        continue;
      if (!operation.has(waiting.resting_die))
        throw Error(of + "resting die",
                    "is number " + std::to_string(waiting.resting_die) +
                      ", which does not stand in the press in this operation",
                    "a workpiece waits on a die that is there, counted from 0",
                    "name one of the operation's dies, or leave the dwell time 0");
      if (process.heat.dwell_film == 0.)
        throw Error(of + "dwell time",
                    "is " + as_text(waiting.dwell) + " s, with dwell film = 0",
                    "a workpiece that waits on a die gives it heat",
                    "use a transfer time, or a dwell film of 1 to 2");
    }
  }

  template struct Process<double>;
  template struct Process<Dual>;

  namespace
  {
    /// Adds the derivatives of  time_bar * process.time(stroke, operation).
    void reverse_time(const Process<double> &process,
                      const double           stroke,
                      const unsigned int     operation,
                      const double           time_bar,
                      Process<double>       &bar)
    {
      const Operation<double> &of = process.operations[operation];
      const double speed = process.speed(operation), per_path_bar = time_bar * of.motion.path(0., stroke);
      bar.operations[operation].path_scale += per_path_bar / speed;
      bar.dies[of.leading_die].velocity -=
        per_path_bar * of.path_scale / std::pow(speed, 3) * process.leading_velocity(operation);
      reverse_path(of.motion, 0., stroke, time_bar * of.path_scale / speed, bar.operations[operation].motion);
    }

    /// The same of whole_time().
    void reverse_whole_time(const Process<double> &process,
                            const double           stroke,
                            const unsigned int     operation,
                            const double           time_bar,
                            Process<double>       &bar)
    {
      reverse_time(process, stroke, operation, time_bar, bar);
      for (unsigned int o = 0; o < operation; ++o)
      {
        reverse_time(process, process.operations[o].stroke, o, time_bar, bar);
        bar.operations[o + 1].waiting.transfer += time_bar;
        bar.operations[o + 1].waiting.dwell += time_bar;
      }
    }
  } // namespace

  void reverse_over(const Process<double> &process,
                    const StrokeStep      &at,
                    const double           approach,
                    const PhysicsBar      &bar,
                    Process<double>       &process_bar)
  {
    AssertDimension(bar.dies.size(), process.dies.size());
    AssertDimension(process_bar.dies.size(), process.dies.size());
    AssertDimension(process_bar.operations.size(), process.operations.size());
    const Operation<double> &operation     = process.operations[at.operation];
    Operation<double>       &operation_bar = process_bar.operations[at.operation];
    process_bar.material.numbers.resize(process.material.numbers.size(), 0.);
    add_numbers(bar.material, process_bar.material);
    add_numbers(bar.contact, process_bar.contact);
    add_numbers(bar.heat, process_bar.heat);
    const double speed = process.speed(at.operation), dt_bar = bar.dt + approach * bar.tau;
    const double path = operation.motion.path(at.stroke, at.step), faster = pace(operation, at);
    // In scale/speed, by which all times are made of paths, and in the pace.
    double per_path_bar = dt_bar * path, pace_bar = 0.;
    auto   dies_bar = bar.dies;
    for (std::size_t d = 0; d < dies_bar.size(); ++d)
    {
      const Vec3 &v = process.dies[d].velocity;
      if (!operation.has(d))
        dies_bar[d].velocity = Vec3();
      pace_bar += dies_bar[d].velocity * v;
      per_path_bar += dies_bar[d].displacement * v * at.stroke;
      dies_bar[d].velocity = faster * dies_bar[d].velocity +
                             process.nominal_time(at.stroke, at.operation) * dies_bar[d].displacement;
    }
    add_numbers(dies_bar, process_bar.dies);
    operation_bar.path_scale += per_path_bar / speed;
    process_bar.dies[operation.leading_die].velocity -=
      per_path_bar * operation.path_scale / std::pow(speed, 3) * process.leading_velocity(at.operation);
    const double per_speed = operation.path_scale / speed;
    const double path_bar  = dt_bar * per_speed - (at.step > 0. ? pace_bar * at.step / (path * path) : 0.);
    reverse_path(operation.motion, at.stroke, at.step, path_bar, operation_bar.motion);
    if (bar.time != 0.)
      reverse_whole_time(process, at.stroke, at.operation, bar.time, process_bar);
  }

  Process<double> no_process_derivatives(const Process<double> &process, const std::vector<Die> &dies)
  {
    Process<double> bar = process;
    bar.dies            = no_derivatives(dies);
    for_each_number([](double &x) { x = 0.; }, bar);
    return bar;
  }
} // namespace retroforge
