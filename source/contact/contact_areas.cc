// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#include <retroforge/contact/contact_areas.h>
#include <retroforge/element/mini_element.templates.h>
#include <retroforge/mesh/surface_areas.h>

namespace retroforge
{
  namespace
  {
    /// Returns the share of a face's area that belongs to a point of it.
    template <typename Number>
    double part_of_face(const ContactSet<Number> &contact, const unsigned int p)
    {
      const ContactPoint &point = contact.pairs[p].point;
      if (contact.quadratic)
        return point.is_node() ? 1. / 12. : 1. / 4.;
      return (point.is_node() ? 1. : contact.edge_stiffness) / 3.;
    }

    /// And what of it each corner of a friction face has.
    template <typename Number>
    double corner_part(const ContactSet<Number> &contact)
    {
      return contact.quadratic ? 1. / 12. : 1. / 3.;
    }
  } // namespace

  template <typename Number>
  ContactAreas<Number> contact_areas(const TetMesh              &mesh,
                                     const Topology             &topology,
                                     const ContactSet<Number>   &contact,
                                     const NodalVectors<Number> &X)
  {
    AssertDimension(X.size(), mesh.n_nodes());
    ContactAreas<Number> areas;
    areas.S.assign(contact.pairs.size(), Number(0.));
    areas.Sf.assign(contact.pairs.size(), Number(0.));
    for (unsigned int p = 0; p < contact.pairs.size(); ++p)
      contact.pairs[p].point.for_each_face(mesh, topology, [&](const unsigned int f) {
        areas.S[p] += part_of_face(contact, p) * triangle_area(mesh.faces[f].nodes, X);
      });
    for (const auto &face : contact.friction_faces)
    {
      const Number part = corner_part(contact) * face.weight * triangle_area(mesh.faces[face.face].nodes, X);
      for (const unsigned int p : face.points)
        areas.Sf[p] += part;
    }
    return areas;
  }

  void reverse_contact_areas(const TetMesh              &mesh,
                             const Topology             &topology,
                             const ContactSet<double>   &contact,
                             const NodalVectors<double> &X,
                             const ContactAreas<double> &areas_bar,
                             NodalVectors<double>       &X_bar,
                             ContactSetBar              &bar)
  {
    AssertDimension(X.size(), mesh.n_nodes());
    AssertDimension(X_bar.size(), X.size());
    AssertDimension(areas_bar.S.size(), contact.pairs.size());
    AssertDimension(areas_bar.Sf.size(), contact.pairs.size());
    AssertDimension(bar.ramp.size(), contact.pairs.size());
    for (unsigned int p = 0; p < contact.pairs.size(); ++p)
      if (areas_bar.S[p] != 0.)
        contact.pairs[p].point.for_each_face(mesh, topology, [&](const unsigned int f) {
          reverse_triangle_area(mesh.faces[f].nodes, X, areas_bar.S[p] * part_of_face(contact, p), X_bar);
        });
    for (const auto &face : contact.friction_faces)
    {
      const double part_bar =
        (areas_bar.Sf[face.points[0]] + areas_bar.Sf[face.points[1]] + areas_bar.Sf[face.points[2]]) *
        corner_part(contact);
      reverse_triangle_area(mesh.faces[face.face].nodes, X, part_bar * face.weight, X_bar);
      const double weight_bar = part_bar * triangle_area(mesh.faces[face.face].nodes, X);
      for (unsigned int c = 0; c < 3; ++c)
        bar.ramp[face.points[c]] +=
          weight_bar * contact.ramps[face.points[(c + 1) % 3]] * contact.ramps[face.points[(c + 2) % 3]];
    }
  }

  template ContactAreas<double>
  contact_areas(const TetMesh &, const Topology &, const ContactSet<double> &, const NodalVectors<double> &);
  template ContactAreas<Dual>
  contact_areas(const TetMesh &, const Topology &, const ContactSet<Dual> &, const NodalVectors<Dual> &);
} // namespace retroforge
