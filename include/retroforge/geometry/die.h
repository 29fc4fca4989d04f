// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/types.h>

#include <deal.II/base/parameter_handler.h>

#include <string>

namespace retroforge
{
  /// What of a die can change with time or design. Everything else about it is geometry.
  template <typename Number>
  struct DieState
  {
    Vector3<Number> velocity;     ///< [mm/s]
    Vector3<Number> displacement; ///< from the position at the start of the run [mm]
    Number          friction;     ///< alpha of tau = -alpha K |dv|^(m-1) dv [mm^(-m)]
  };

  /// Signed distance to a die, > 0 outside of it, and the closest feature's normal pointing into the die.
  template <typename Number>
  struct Projection
  {
    Number          delta;
    Vector3<Number> n;
  };

  /// A rigid plane die.
  class Die
  {
  public:
    /// @param facing  unit normal of the working face, from the die towards the workpiece
    Die(std::string name, const Vec3 &point, const Vec3 &facing)
        : name(std::move(name)), point_(point), into_(-facing)
    {
    }

    /// Closest feature seen from X:  delta = n·(point + displacement - X).
    template <typename Number>
    Projection<Number> project(const Vector3<Number> &X, const Vector3<Number> &displacement) const
    {
      Projection<Number> projection;
      projection.delta = Number(0.);
      for (unsigned int i = 0; i < 3; ++i)
      {
        projection.n[i] = Number(into_[i]);
        projection.delta += into_[i] * (point_[i] + displacement[i] - X[i]);
      }
      return projection;
    }

    /// Adds the pull-back of project to X_bar and displacement_bar. The normal of a plane depends on neither,
    /// so that its derivative n_bar goes nowhere.
    void
    reverse_project(const double delta_bar, const Vec3 & /*n_bar*/, Vec3 &X_bar, Vec3 &displacement_bar) const
    {
      X_bar -= delta_bar * into_;
      displacement_bar += delta_bar * into_;
    }

    std::string name;

  private:
    Vec3 point_;
    Vec3 into_; ///< unit normal into the die
  };

  struct DieParameters
  {
    std::string name;
    Vec3        point;
    Vec3        facing;
    Vec3        velocity;
    double      friction = 0.;

    explicit DieParameters(std::string name) : name(std::move(name)) {}

    void add_parameters(dealii::ParameterHandler &prm);
    /// Normalises `facing`.
    void check();

    Die              die() const { return Die(name, point, facing); }
    DieState<double> initial_state() const { return {velocity, Vec3(), friction}; }
  };
} // namespace retroforge
