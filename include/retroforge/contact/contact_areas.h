// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/contact/contact_kinematics.h>

/// @file
/// The areas that points of contact stand for.
///
/// S is a third of the areas of the surface faces at the point; S^f, of nodes only, a third of those whose
/// three nodes touch the die, each face weighted by the product of its nodes' ramps w(delta). Where
/// velocities are quadratic, faces are the four equal triangles that the middles cut each into: of a face, a
/// corner has a twelfth of the area, a middle a quarter.
namespace retroforge
{
  /// For each pair S, for edges times their stiffness, and S^f [mm^2].
  template <typename Number>
  struct ContactAreas
  {
    std::vector<Number> S, Sf;
  };

  template <typename Number>
  ContactAreas<Number> contact_areas(const TetMesh              &mesh,
                                     const Topology             &topology,
                                     const ContactSet<Number>   &contact,
                                     const NodalVectors<Number> &X);

  /// Returns a third of the surface area at a node over the S of its pair: for quadratic velocities a vertex
  /// has only a twelfth of each face.
  template <typename Number>
  double surface_over_S(const ContactSet<Number> &contact)
  {
    return contact.quadratic ? 4. : 1.;
  }

  /// Pull-back of contact_areas: S_bar, Sf_bar -> X_bar and the ramps of the increment.
  void reverse_contact_areas(const TetMesh              &mesh,
                             const Topology             &topology,
                             const ContactSet<double>   &contact,
                             const NodalVectors<double> &X,
                             const ContactAreas<double> &areas_bar,
                             NodalVectors<double>       &X_bar,
                             ContactSetBar              &bar);
} // namespace retroforge
