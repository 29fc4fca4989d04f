// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/base/parameter_handler.h>

#include <retroforge/geometry/closest_feature.h>
#include <retroforge/remeshing/size_field.h>

#include <vector>

namespace retroforge
{
  /// A step out of a die.
  struct PushStep
  {
    unsigned int die;
    DieFeature   feature; ///< that the point is put on
    Vec3         x;       ///< where it is then [mm]
  };

  /// Moves a point of the surface out of the dies it would be inside of; returns other points as they are.
  class PushOut
  {
  public:
    PushOut() = default;

    /// @param how  a function of the point: the steps on the way out of the dies it is inside of, none outside; or where
    /// it is then, which has no derivative
    template <typename F, typename = std::enable_if_t<!std::is_base_of_v<PushOut, std::decay_t<F>>>>
    PushOut(F how)
    {
      if constexpr (std::is_same_v<std::invoke_result_t<F, const Vec3 &>, Vec3>)
        move_ = std::move(how);
      else
        steps_ = std::move(how);
    }

    explicit operator bool() const { return steps_ || move_; }

    Vec3 operator()(const Vec3 &x) const
    {
      if (move_)
        return move_(x);
      const auto steps = steps_(x);
      return steps.empty() ? x : steps.back().x;
    }

    /// Returns the steps, where they are known.
    std::vector<PushStep> steps(const Vec3 &x) const { return steps_ ? steps_(x) : std::vector<PushStep>(); }

  private:
    std::function<std::vector<PushStep>(const Vec3 &)> steps_;
    std::function<Vec3(const Vec3 &)>                  move_;
  };

  /// Says whether a point of the surface touches a die, off which the volume correction must not move it.
  using TouchesDie = std::function<bool(const Vec3 &)>;

  /// When to remesh and how far to go. Angles in degrees, lengths relative to the wanted edge length h.
  struct RemeshingParameters
  {
    double trigger_angle = 15; ///< remesh when a dihedral angle is smaller
    double goal_angle    = 20; ///< move and insert nodes until no dihedral angle is smaller
    double swap_angle    = 30; ///< exchange edges and faces up to here: that costs no diffusion

    double ridge_angle  = 40; ///< faces of one patch that turn by more form a ridge
    double corner_angle = 45; ///< a ridge that turns by more has a corner there

    double shortest_edge = 0.6; ///< shorter edges are collapsed
    double longest_edge  = 1.6; ///< longer edges are split

    double surface_deviation = 0.1;  ///< how far a collapse may move the surface
    double ridge_deviation   = 0.05; ///< how far a collapse may move a ridge, or a flip the surface
    double kept_move         = 0.01; ///< nodes the volume correction moves by less keep their values

    unsigned int max_sweeps = 6;

    void add_parameters(dealii::ParameterHandler &prm);
    void check() const;
  };
} // namespace retroforge
