// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/steps/moved_ends.h>

#include <algorithm>
#include <cmath>

namespace retroforge
{
  template <typename Number>
  Process<Number>
  with_moved_ends(const Process<Number> &process, const StrokeStep &at, const MovedEnds<Number> &moved)
  {
    Process<Number>    to        = process;
    Operation<Number> &operation = to.operations[at.operation];
    const Number       scale     = operation.path_scale;
    if (at.step > 0.)
      operation.path_scale *= 1. + (moved.end - moved.start) / at.step;
    // Dies at a stroke are where this scale takes them: at the start they must be where the given one does.
    const Number time =
      (scale * (at.stroke + moved.start) - operation.path_scale * at.stroke) / process.speed(at.operation);
    for (DieState<Number> &die : to.dies)
      die.displacement += die.velocity * time;
    return to;
  }

  template Process<double>
  with_moved_ends(const Process<double> &, const StrokeStep &, const MovedEnds<double> &);
  template Process<Dual> with_moved_ends(const Process<Dual> &, const StrokeStep &, const MovedEnds<Dual> &);

  MovedEnds<double>
  reverse_moved_ends(const Process<double> &process, const StrokeStep &at, const Process<double> &bar)
  {
    const double per_stroke = process.operations[at.operation].path_scale / process.speed(at.operation);
    double       time_bar   = 0.;
    for (std::size_t d = 0; d < process.dies.size(); ++d)
      time_bar += bar.dies[d].displacement * process.dies[d].velocity;
    MovedEnds<double> moved_bar{per_stroke * time_bar, 0.};
    if (at.step > 0.)
    {
      const double scale_bar =
        bar.operations[at.operation].path_scale - time_bar * at.stroke / process.speed(at.operation);
      moved_bar.end = scale_bar * process.operations[at.operation].path_scale / at.step;
      moved_bar.start -= moved_bar.end;
    }
    return moved_bar;
  }

  namespace
  {
    using Gradients = std::array<Vec3, 4>;

    /// Those of the linear shape functions of a cell, and its volume.
    Gradients shape_gradients(const std::array<Vec3, 4> &X, double &volume)
    {
      dealii::Tensor<2, 3> edges; // a row per corner but the first
      for (unsigned int a = 0; a < 3; ++a)
        edges[a] = X[a + 1] - X[0];
      volume                        = determinant(edges) / 6.;
      const dealii::Tensor<2, 3> to = invert(edges); // a column per corner but the first
      Gradients                  g;
      for (unsigned int a = 0; a < 3; ++a)
      {
        for (unsigned int i = 0; i < 3; ++i)
          g[a + 1][i] = to[i][a];
        g[0] -= g[a + 1];
      }
      return g;
    }

    dealii::SymmetricTensor<2, 3> shear_rate(const std::array<Vec3, 4> &V, const Gradients &g)
    {
      dealii::Tensor<2, 3> L;
      for (unsigned int a = 0; a < 4; ++a)
        L += outer_product(V[a], g[a]);
      return deviator(symmetrize(L));
    }
  } // namespace

  std::vector<FollowingRule> following_rules(const std::vector<StrokeStep>   &increments,
                                             const std::vector<unsigned int> &remeshed,
                                             const double                     least_left)
  {
    std::vector<FollowingRule> rules(increments.size());
    bool                       any = false, leads = false; // a new mesh is ahead in the operation
    double                     end = 0.;                   // of that [mm]
    for (unsigned int i = increments.size(); i-- > 0;)
    {
      const StrokeStep &at = increments[i];
      const double      to = at.stroke + at.step;
      if (i + 1 == increments.size() || increments[i + 1].operation != at.operation)
      {
        end   = to;
        leads = false;
      }
      rules[i] = leads ? FollowingRule{1., 0.5 * std::min(at.step, increments[i + 1].step)}
                       : FollowingRule{(end - to) / (end - at.stroke), 0.};
      any      = any || leads;
      leads    = leads || (end - at.stroke >= least_left * end &&
                        std::binary_search(remeshed.begin(), remeshed.end(), i));
    }
    return any ? rules : std::vector<FollowingRule>();
  }

  FollowingEnd::FollowingEnd(const TetMesh              &mesh,
                             const NodalVectors<double> &X_made,
                             const NodalVectors<double> &X,
                             const NodalVectors<double> &V,
                             const Process<double>      &nominal,
                             const StrokeStep           &at,
                             const FollowingRule        &rule)
      : X_made_(X_made), X_(X), of_made_(X.size()), of_now_(X.size()), rule_(rule)
  {
    AssertDimension(X_made.size(), X.size());
    if (rule.most == 0.)
      return;
    const double dt   = nominal.duration(at);
    double       norm = 0.;
    for (const auto &cell : mesh.cells)
    {
      double                              volume, volume_made;
      const Gradients                     G = shape_gradients(corners(cell, X_made), volume_made);
      const Gradients                     g = shape_gradients(corners(cell, X), volume);
      const dealii::SymmetricTensor<2, 3> e = dt * shear_rate(corners(cell, V), g);
      dealii::Tensor<2, 3>                F; // from when the mesh was made
      for (unsigned int a = 0; a < 4; ++a)
        F += outer_product(X[cell[a]], G[a]);
      norm += volume * (e * e);
      for (unsigned int a = 0; a < 4; ++a)
      {
        of_now_[cell[a]] += volume * (e * g[a]);
        of_made_[cell[a]] -= volume * (transpose(F) * (e * g[a]));
      }
    }
    // Where nothing flows, nothing is ahead.
    for (auto *gradient : {&of_made_, &of_now_})
      for (Vec3 &g : *gradient)
        g *= norm > 0. ? -at.step / norm : 0.;
  }

  template <typename Number>
  Number FollowingEnd::moved(const Number               &start,
                             const NodalVectors<Number> &X_made,
                             const NodalVectors<Number> &X) const
  {
    using std::sqrt;
    AssertDimension(X_made.size(), X_.size());
    AssertDimension(X.size(), X_.size());
    Number t = rule_.of_start * start;
    if (rule_.most == 0.)
      return t;
    for (std::size_t k = 0; k < X.size(); ++k)
      t += (X[k] - X_[k]) * of_now_[k] + (X_made[k] - X_made_[k]) * of_made_[k];
    return rule_.most * t / sqrt(Number(rule_.most * rule_.most + t * t));
  }

  template double
  FollowingEnd::moved(const double &, const NodalVectors<double> &, const NodalVectors<double> &) const;
  template Dual
  FollowingEnd::moved(const Dual &, const NodalVectors<Dual> &, const NodalVectors<Dual> &) const;

  double FollowingEnd::reverse_moved(const double          bar,
                                     NodalVectors<double> &X_made_bar,
                                     NodalVectors<double> &X_bar) const
  {
    AssertDimension(X_made_bar.size(), of_made_.size());
    AssertDimension(X_bar.size(), of_now_.size());
    for (std::size_t k = 0; k < of_now_.size(); ++k)
    {
      X_made_bar[k] += bar * of_made_[k];
      X_bar[k] += bar * of_now_[k];
    }
    return rule_.of_start * bar;
  }
} // namespace retroforge
