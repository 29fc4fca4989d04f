// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/rows.h>
#include <retroforge/mesh/tet_mesh.h>

#include <algorithm>

namespace retroforge
{
  /// Appends the part of `normal` across the directions from `first` on, scaled to length one, unless they
  /// hold it already.
  template <int dim>
  void orthonormalise_into(std::vector<dealii::Tensor<1, dim>> &directions,
                           const std::size_t                    first,
                           dealii::Tensor<1, dim>               normal)
  {
    for (unsigned int pass = 0; pass < 2; ++pass)
      for (std::size_t i = first; i < directions.size(); ++i)
        normal -= (normal * directions[i]) * directions[i];
    if (normal.norm() > 1e-6)
      directions.push_back(normal / normal.norm());
  }

  /// Orthonormal directions in which symmetry planes hold each of n places: the normals of the planes it lies
  /// on, in the order of the patches, each without the part that those before hold.
  /// @param places  of a boundary face: those on it
  template <int dim, typename Places>
  Rows<dealii::Tensor<1, dim>>
  symmetry_directions(const SimplexMesh<dim> &mesh, const unsigned int n, const Places &places)
  {
    std::vector<std::pair<unsigned int, unsigned int>> pairs;
    for (const SimplexFace<dim> &face : mesh.faces)
      if (!mesh.is_surface(face))
        for (const unsigned int place : places(face))
          pairs.emplace_back(place, face.patch);
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    Rows<dealii::Tensor<1, dim>> rows;
    auto                         pair = pairs.begin();
    for (unsigned int place = 0; place < n; ++place)
    {
      for (; pair != pairs.end() && pair->first == place; ++pair)
        orthonormalise_into(rows.entries, rows.begin.back(), mesh.patches[pair->second].symmetry->normal);
      rows.begin.push_back(rows.entries.size());
    }
    return rows;
  }
} // namespace retroforge
