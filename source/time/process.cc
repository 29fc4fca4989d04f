// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <deal.II/base/mpi.h>

#include <retroforge/time/process.h>

namespace retroforge
{
  template <typename Number>
  Number Process<Number>::speed() const
  {
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
    Physics<Number> physics{law, contact, dies};
    const Number    passed = time(stroke);
    for (auto &die : physics.dies)
      die.displacement += die.velocity * passed;
    return physics;
  }

  template struct Process<double>;
  template struct Process<Dual>;

  void ProcessBar::add(const PhysicsBar      &bar,
                       const Process<double> &process,
                       const StrokeStep      &step,
                       const double           approach)
  {
    K += bar.contact.K;
    m += bar.contact.m;
    e0 += bar.e0;
    rho += bar.contact.rho;
    v0 += bar.contact.v0;
    die_vertices.resize(dies.size());
    for (std::size_t d = 0; d < bar.contact.die_vertices.size(); ++d)
    {
      die_vertices[d].resize(bar.contact.die_vertices[d].size());
      for (std::size_t k = 0; k < die_vertices[d].size(); ++k)
        die_vertices[d][k] += bar.contact.die_vertices[d][k];
    }
    const double speed = process.speed();
    // In stretch/speed, by which all times are made of strokes.
    double pace_bar = (bar.dt + approach * bar.contact.tau) * step.step;
    for (unsigned int d = 0; d < dies.size(); ++d)
    {
      const DieState<double> &die = bar.contact.dies[d];
      dies[d].velocity += die.velocity + process.time(step.stroke) * die.displacement;
      dies[d].displacement += die.displacement;
      dies[d].friction += die.friction;
      pace_bar += die.displacement * process.dies[d].velocity * step.stroke;
    }
    stretch += pace_bar / speed;
    dies[process.leading_die].velocity -=
      pace_bar * process.stretch / std::pow(speed, 3) * process.dies[process.leading_die].velocity;
  }

  void ProcessBar::sum(MPI_Comm comm)
  {
    std::vector<double> all = {K, m, e0, rho, v0, stretch};
    for (const auto &die : dies)
    {
      for (unsigned int i = 0; i < 3; ++i)
        all.insert(all.end(), {die.velocity[i], die.displacement[i]});
      all.push_back(die.friction);
    }
    for (NodalVectors<double> &vertices : die_vertices)
      if (!vertices.empty())
        MPI_Allreduce(
          MPI_IN_PLACE, vertices.data()->begin_raw(), 3 * vertices.size(), MPI_DOUBLE, MPI_SUM, comm);
    dealii::Utilities::MPI::sum(all, comm, all);
    auto next = all.begin();
    for (double *x : {&K, &m, &e0, &rho, &v0, &stretch})
      *x = *next++;
    for (auto &die : dies)
    {
      for (unsigned int i = 0; i < 3; ++i)
      {
        die.velocity[i]     = *next++;
        die.displacement[i] = *next++;
      }
      die.friction = *next++;
    }
  }
} // namespace retroforge
