// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/mesh/cell_faces.h>
#include <retroforge/remeshing/rebuild.h>

#include <map>
#include <set>
#include <vector>

namespace retroforge
{
  /// A mesh from which metal too thin for it was removed.
  struct RepairedMesh
  {
    RebuiltMesh mesh;
    double      removed = 0.; ///< volume [mm^3]
  };

  /// A mesh whose cells at the boundary can be taken away one by one, as long as the boundary stays a
  /// surface. Cells after the one that goes move up by one.
  class PeeledMesh
  {
  public:
    /// @param X  current positions
    PeeledMesh(const TetMesh &mesh, const NodalVectors<double> &X);

    const TetMesh &mesh() const { return mesh_; }

    /// Returns the volume removed so far [mm^3].
    double removed() const { return removed_; }

    double volume(CellIndex cell) const;

    /// The cell behind a face of the boundary.
    CellIndex cell_behind(const std::array<NodeIndex, 3> &face) const
    {
      return cell_behind_.at(face_key(face));
    }

    /// Cells behind the faces that are off the planes of symmetry and share one with a cell, the smallest
    /// first.
    std::vector<CellIndex> surface_cells_beside(CellIndex cell) const;

    /// Takes away the first of the cells without which the boundary is still a surface.
    /// @param most  what may be removed in all [mm^3]
    /// @return false, and nothing changed, when none may go or it would be too much
    bool remove_first(const std::vector<CellIndex> &cells, double most);

    /// Returns the remaining mesh, without the nodes that no cell has any more.
    RepairedMesh result() const;

  private:
    FaceKey face_of(CellIndex cell, unsigned int opposite) const;
    bool    may_go(CellIndex cell) const;
    void    remove(CellIndex cell);
    void    find_boundary();

    TetMesh                            mesh_;
    double                             removed_ = 0.;
    std::map<FaceKey, CellIndex>       cell_behind_; ///< cell of each face of the boundary
    std::set<NodeIndex>                boundary_nodes_;
    std::set<std::array<NodeIndex, 2>> boundary_edges_;
  };
} // namespace retroforge
