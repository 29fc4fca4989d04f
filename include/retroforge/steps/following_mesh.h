// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/element/cell_geometry.h>
#include <retroforge/record/increment_record.h>
#include <retroforge/steps/shape_motion.h>

/// @file
/// A run that decides anew lays a new mesh into the shape that the metal has, wherever its metal came from. Operations of
/// remeshing that are repeated at other values of the design take its nodes along with the metal instead, along the dies
/// and past their edges, and the farther the longer ago the two forgings parted; but a mesh is best where it was made. So
/// in derivatives and replays that follow the trend its nodes go as the shape does, and what they carry is what is there:
///   X'' = X'_0 + P (X' - X'_0),    q'' = q' + grad q'·(X'' - X'),
/// X'_0 the recorded positions, X' those of the operations, P the motion of the shape (steps/shape_motion.h).
namespace retroforge
{
  /// A mesh whose nodes go as its shape does. Gradients are taken where it was recorded: at nodes the mean over the cells
  /// around, on the surface along it, over the faces around.
  class FollowingMesh
  {
  public:
    /// @param mesh  must live as long
    explicit FollowingMesh(const TetMesh &mesh);

    /// Returns X'' of X'.
    template <typename Number>
    NodalVectors<Number> positions(const NodalVectors<Number> &X) const;

    /// q'' of q', one number or vector per node, w = X'' - X' [mm]. A number that is 0 stays: what only contacts make begins
    /// there, with kinks.
    template <typename Number>
    void move_nodes(const NodalVectors<Number> &w, std::vector<Number> &q) const;
    template <typename Number>
    void move_nodes(const NodalVectors<Number> &w, NodalVectors<Number> &q) const;

    /// The same of one number per cell, by the mean of w over its nodes.
    template <typename Number>
    void move_cells(const NodalVectors<Number> &w, std::vector<Number> &q) const;

    /// Adds to w_bar the derivatives of  q_bar·q''  in w, where that is 0; those in q' are q_bar.
    void reverse_nodes(const std::vector<double> &q,
                       const std::vector<double> &q_bar,
                       NodalVectors<double>      &w_bar) const;
    void reverse_nodes(const NodalVectors<double> &q,
                       const NodalVectors<double> &q_bar,
                       NodalVectors<double>       &w_bar) const;
    void reverse_cells(const std::vector<double> &q,
                       const std::vector<double> &q_bar,
                       NodalVectors<double>      &w_bar) const;

    /// Returns the derivatives in X' of those in X'' and w.
    NodalVectors<double> reverse_positions(NodalVectors<double>        X_bar,
                                           const NodalVectors<double> &w_bar) const;

  private:
    template <typename Number>
    NodalVectors<Number> node_gradients(const std::vector<Number> &q) const;
    template <typename Number>
    NodalVectors<Number> cell_gradients(const std::vector<Number> &q) const;

    /// Returns for each node the one by which it moves what it carries: itself, or one around that has the same value. The
    /// transfer stops new values at those of nodes around, and heat that flows has a kink where two are equal: they stay so.
    template <typename Number>
    std::vector<NodeIndex> moved_like(const std::vector<Number> &q) const;

    /// A face of the surface: gradients along it of the linear functions of its corners [1/mm].
    struct Face
    {
      std::array<NodeIndex, 3> nodes;
      double                   area;
      std::array<Vec3, 3>      g;
    };

    const TetMesh                      &mesh_;
    const ShapeMotion                   motion_;
    std::vector<CellGeometry<double>>   cells_;
    std::vector<Face>                   faces_;
    std::vector<double>                 volume_, area_; ///< around the nodes; area 0 off the surface
    std::vector<std::vector<NodeIndex>> below_;         ///< nodes around each that come before it
  };

  /// Returns the mesh that an increment begins with, where it follows the shape, else null. That of the first increment
  /// does not: the billet has come by no way.
  std::unique_ptr<FollowingMesh>
  following_mesh(bool meshes_follow, unsigned int increment, const RemeshRecord &remesh);
} // namespace retroforge
