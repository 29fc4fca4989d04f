// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/difference_oracle.h>
#include <retroforge/trial.h>

#include <utility>

namespace retroforge
{
  namespace
  {
    NodalVectors<double> sum(NodalVectors<double> a, const NodalVectors<double> &b)
    {
      for (std::size_t k = 0; k < a.size(); ++k)
        a[k] += b[k];
      return a;
    }

    /// Moves the vertices of the dies from where a process has them.
    template <typename Number, typename Shift>
    void move_dies(const std::vector<Die> &dies,
                   const FreeForm         &shift,
                   const Shift            &moved,
                   Process<Number>        &process)
    {
      for (std::size_t d = 0; d < shift.dies.size(); ++d)
      {
        if (shift.dies[d].empty())
          continue;
        NodalVectors<Number> vertices;
        for (std::size_t k = 0; k < shift.dies[d].size(); ++k)
        {
          Vector3<Number> x;
          for (unsigned int i = 0; i < 3; ++i)
            x[i] = moved(process.dies[d].vertices.empty() ? Number(dies[d].surface()->vertices()[k][i])
                                                          : process.dies[d].vertices[k][i],
                         shift.dies[d][k][i]);
          vertices.push_back(x);
        }
        process.dies[d].vertices = std::move(vertices);
      }
    }

    double sum_of(const double x, const double shift)
    {
      return x + shift;
    }

    Dual dual_of(Dual x, const double direction)
    {
      x.fastAccessDx(0) += direction;
      return x;
    }
  } // namespace

  ObjectiveOracle make_oracle(const Case &at, const Forging &forging, const RecordedForging &recorded)
  {
    ObjectiveOracle oracle;
    const auto      process_at = [&at](const std::vector<double> &mu, const FreeForm &shift) {
      Process<double> process = at.design.process(mu);
      move_dies(at.model.dies, shift, sum_of, process);
      return process;
    };
    oracle.free = [&at, process_at](const std::vector<double> &mu, const FreeForm &shift) {
      Trial trial(at, process_at(mu, shift), sum(at.design.positions(mu), shift.X_0), Trial::Keep::nothing);
      trial.forge();
      return at.combine(trial.values());
    };
    oracle.replayed = [&at, &forging, recorded, process_at](const std::vector<double> &mu,
                                                            const FreeForm            &shift) {
      const Process<double> process = process_at(mu, shift);
      ObjectiveTrace        trace(at.objectives, at.model, process);
      ForgingState          state = forging.start(recorded.first, sum(at.design.positions(mu), shift.X_0));
      forging.replay(
        process, recorded.n, recorded.source, state, [&](const IncrementEvent &event) { trace.add(event); });
      return at.combine(trace.values(state, false));
    };
    oracle.tangent = [&at, recorded](const std::vector<double> &mu_dot, const FreeForm &shift_dot) {
      std::vector<Dual> mu;
      for (std::size_t j = 0; j < at.mu.size(); ++j)
        mu.push_back(dual_of(Dual(at.mu[j]), mu_dot[j]));
      NodalVectors<Dual> X = at.design.positions(mu);
      for (std::size_t k = 0; k < X.size(); ++k)
        for (unsigned int i = 0; i < 3; ++i)
          X[k][i].fastAccessDx(0) += shift_dot.X_0[k][i];
      Process<Dual> process = at.design.process(mu);
      move_dies(at.model.dies, shift_dot, dual_of, process);
      std::vector<double> derivatives;
      for (const Dual &value : at.combine(tangent_sweep(recorded, process, X)))
        derivatives.push_back(value.dx(0));
      return derivatives;
    };
    return oracle;
  }
} // namespace retroforge
