// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/discretization/middle_nodes.h>
#include <retroforge/mesh/topology.h>

/// @file
/// The velocity with which the vertices of a straight-sided mesh move under a velocity that is quadratic in
/// each cell, so that the mesh's volume changes as the flow says.
///
/// The flux of such a velocity through a face with area vector s_f is s_f times the mean over the *middles*
/// of its edges; vertices that move with their own velocities v_k sweep s_f times the mean over the
/// *vertices*. The difference,
///   D_f = s_f·(mean of the three middles - mean of the three vertices)   [mm^3/s],
/// is given to the vertices of each face of the surface (faces on planes of symmetry move within them):
///   w_k = v_k + r_k sum over the faces f at k of D_f [ c_k g(u_i, u_j) + h/3 ],   i, j the other two,
///   g = 1 - (u_i + u_j)/2 + u_i u_j/3,     h = (1 - u_i) (1 - u_j) (1 - u_k),     u_k = c_k a_k.
///
/// *How much of D_f a vertex takes.* c_k is 1 where the vertex is free and 0 where a die holds it: given the
/// flux, the rim of a die would creep outwards. The part u_k g is what vertex k gets on average when D_f is
/// shared equally by those of the three vertices that are at large, each of them being so with probability
/// u_k and independently; together they take 1 - h. With probability h none is, and each takes a third: where
/// a die holds all three, the middles sink into it under their penalty and the vertices, which quadratic
/// velocities hardly load, do not, and the metal between would be lost. So all of D_f is taken whoever is
/// held, and by a polynomial: the motion is smooth in c where vertices, or all three of a face, come to be
/// held.
///
/// *How a vertex takes it.* Along t_k, which is the vector of volume swept per motion, N_k = 1/3 sum s_f,
/// without the directions that planes of symmetry hold. Moved by t_k/|t_k|^2 it sweeps one unit of volume.
/// Where the surface around k points into all directions, or only into held ones, t_k vanishes. So with A_k =
/// 1/3 sum |s_f| and e_k = |t_k|^2/A_k^2, which is 1 on a plane, 1/2 on a right-angled edge and 1/3 in the
/// corner of a cube,
///   r_k = a_k t_k/|t_k|^2 = b(e_k) t_k/A_k^2,    a_k = e_k b(e_k),
///   b(e) = 1/e  for e >= e_min,    b(e) = x (3 - 2x)/e_min,  x = e/e_min,  below.
/// b has a continuous derivative, a_k is 1 but on blades sharper than 2 arcsin(sqrt(e_min)), 37 degrees, and
/// falls to zero with t_k; there u_k leaves the flux to the other vertices. Nowhere does a vertex move faster
/// than some 3.3 z_k/A_k.
///
/// All is linear in v, local, and the same on a part that planes of symmetry cut as on the whole.
namespace retroforge
{
  /// e_min
  inline constexpr double least_effective_normal = 0.1;

  /// Arguments of the motion of the vertices.
  template <typename Number>
  struct VertexMotionInput
  {
    const TetMesh              &mesh;
    const Topology             &topology;
    const MiddleNodes          &middles;
    const NodalVectors<Number> &X;       ///< positions of the vertices [mm]
    const NodalVectors<Number> &V;       ///< at the vertices, then in the middles of the edges [mm/s]
    const std::vector<Number>  &freedom; ///< c_k in [0, 1] of each vertex; counts on the surface only
  };

  /// w_k [mm/s] of each vertex.
  template <typename Number>
  NodalVectors<Number> vertex_velocities(const VertexMotionInput<Number> &input);

  /// Derivatives in VertexMotionInput's numbers.
  struct VertexMotionBar
  {
    NodalVectors<double> X, V;
    std::vector<double>  freedom;
  };

  /// Pull-back of vertex_velocities: adds to `bar`, whose arrays have the sizes of the input's.
  void reverse_vertex_velocities(const VertexMotionInput<double> &input,
                                 const NodalVectors<double>      &w_bar,
                                 VertexMotionBar                 &bar);
} // namespace retroforge
