// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/mesh_quality.h>
#include <retroforge/steps/process.h>

/// @file
/// Where increments end at other values of the design.
///
/// A mesh is made anew for what the metal did to it, so that a forging that is ahead of another by some stroke
/// has its new mesh by that stroke sooner. The force jumps there, from that of a mesh that is drawn out to that
/// of a better one, mostly down. Were the strokes of remeshings held while the design moves, all that forces
/// grow within a mesh would count in a derivative, and nothing of what they fall between two: that of
/// the energy by the offset of a die would be the force at the end and the sum of these jumps, up to 14 % of it.
/// So, where meshes are made anew by their quality, each increment up to the last new mesh of its operation ends sooner as the
/// state at its start is ahead,
///   s'_end = s_end + b t/(b^2 + t^2)^(1/2),
///   t = s'_start - s_start - step (e(U), e(X - X_nominal) - e_made) / (e(U), e(U)),   e(U) = dev sym grad U,
///   e_made = dev sym F grad(X_made - X_made_nominal) F^(-1),
/// U the motion of the nominal increment, F the deformation since its mesh was made, integrals over that: the last term is the
/// stroke by which the cells have since been strained farther than in the nominal run, along the strains of that increment,
/// whatever body the mesh was made of. b, half of the shorter one of the
/// increments that meet there, keeps steps positive. Were only those ends moved at which a mesh is made anew, the two increments
/// there would become longer and shorter by all of it, and what arrives at dies in these would make slopes rough.
/// On the last mesh ends come back to their places, by the same part of the stroke that is left,
///   s'_end - s_end = (S - s_end) / (S - s_start) (s'_start - s_start),   S the end of the operation.
/// The nominal run is as it was: all this is for replays and derivatives. A run that decides anew remeshes between its
/// own increments: its energies jump where that falls into another one, and this derivative is that of the trend across
/// these jumps, not that between two.
namespace retroforge
{
  /// By how much an increment begins and ends beside the strokes of its record [mm].
  template <typename Number>
  struct MovedEnds
  {
    Number start = Number(0.), end = Number(0.);
  };

  /// Returns the process in which a recorded increment, at its recorded place, is that with moved ends: its dies
  /// begin where the stroke has them that it begins at, and its time is in proportion to its length.
  /// With no length, that of the dies at the start of it.
  template <typename Number>
  Process<Number>
  with_moved_ends(const Process<Number> &process, const StrokeStep &at, const MovedEnds<Number> &moved);

  /// Returns the derivatives in the ends, where they have not moved, of a scalar whose derivatives in
  /// with_moved_ends() are `bar`. Those in the process itself are `bar`, too.
  MovedEnds<double>
  reverse_moved_ends(const Process<double> &process, const StrokeStep &at, const Process<double> &bar);

  /// What the end of an increment follows.
  struct FollowingRule
  {
    double of_start = 0.; ///< the part of how far the increment begins beside its record
    double most     = 0.; ///< b [mm]; 0 on the last mesh, where the state does not count

    bool operator==(const FollowingRule &other) const
    {
      return of_start == other.of_start && most == other.most;
    }
  };

  /// Returns those of the increments of a run; none where no mesh was made anew within an operation.
  /// @param remeshed    the increments, from 0, that began on a new mesh, in their order
  /// @param least_left  part of its operation's stroke that must be left at a new mesh, or what leads to that is held
  std::vector<FollowingRule> following_rules(const std::vector<StrokeStep>   &increments,
                                             const std::vector<unsigned int> &remeshed,
                                             double                           least_left = 0.);

  /// How the end of an increment follows the positions at its start.
  class FollowingEnd
  {
  public:
    /// @param mesh      of the increment
    /// @param X_made    nominal positions when that was made [mm]
    /// @param X         nominal positions at its start [mm]
    /// @param V         nominal mean velocity of nodes over it [mm/s]
    /// @param nominal   the process of the nominal run
    /// @param at        the increment
    /// @param rule      of it
    FollowingEnd(const TetMesh              &mesh,
                 const NodalVectors<double> &X_made,
                 const NodalVectors<double> &X,
                 const NodalVectors<double> &V,
                 const Process<double>      &nominal,
                 const StrokeStep           &at,
                 const FollowingRule        &rule);

    /// Returns by how much the increment ends beside its record [mm].
    /// @param start  by how much it begins there
    template <typename Number>
    Number
    moved(const Number &start, const NodalVectors<Number> &X_made, const NodalVectors<Number> &X) const;

    /// Adds the derivatives of  bar * moved()  in positions, at the nominal ones.
    /// @return that in the start
    double reverse_moved(double bar, NodalVectors<double> &X_made_bar, NodalVectors<double> &X_bar) const;

  private:
    const NodalVectors<double> X_made_, X_;
    NodalVectors<double>       of_made_, of_now_; ///< gradients of t [mm/mm]
    const FollowingRule        rule_;
  };
} // namespace retroforge
