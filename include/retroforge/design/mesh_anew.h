// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/design/first_mesh.h>
#include <retroforge/time/remesher.h>

#include <map>

namespace retroforge
{
  /// Values of some parameters of a billet's shape by name, `billet/...`.
  using ShapeValues = std::multimap<std::string, double>;

  /// Returns whether the billet has measures for every shape it can take, so that the mesher can make it at
  /// any of them. One from a file, or with a free form, is known by the surface of its mesh only.
  bool has_measures(const BilletParameters &billet);

  /// Returns the values of all parameters of the shape, in the order of FirstMesh: the given ones, and
  /// nominal ones; the parameter that holds the volume follows from the others where it is not given.
  /// @throws Error  for names that are not of the billet's shape, or values that no shape has
  std::vector<double>
  shape_values(const BilletParameters &billet, const FirstMesh &first, const ShapeValues &given);

  /// A mesh of the mesher at other values, for billets that have measures. Parameters keep their meaning: a
  /// contour follows its measures, whatever the mesh.
  /// @param make  makes the mesh of a billet; collective
  /// @param values  of all parameters of the shape
  /// @throws Error  where the mesher fails, or patches have come or gone
  FirstMesh meshed_anew(const FirstMesh                                        &first,
                        const std::vector<double>                              &values,
                        const std::function<TetMesh(const BilletParameters &)> &make);

  /// The first mesh remeshed where its nodes stand at other values, with edges as long as they were in the
  /// mesh as made. A new node moves as the point of the old mesh that it stands at,
  ///   dX_0/dmu_j = J (dX_0/dmu_j of the old mesh),
  /// J linear interpolation in the old cells, and on the surface in the old faces. Modes of free forms, too,
  /// are thus carried over, not made anew: equal values are equal shapes, but for the chords of the mesh.
  /// @throws Error  where a cell is inverted at these values, or no sound mesh is found
  FirstMesh remeshed(const FirstMesh           &first,
                     const std::vector<double> &values,
                     const RemesherParameters  &parameters,
                     Timings                   &timings,
                     MPI_Comm                   comm);
} // namespace retroforge
