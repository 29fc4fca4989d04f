// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/distributed/shared_tria.h>

#include <retroforge/geometry/triangle_surface.h>
#include <retroforge/mesh/tet_mesh.h>

#include <memory>

namespace retroforge
{
  /// The distribution of a mesh's cells over the ranks.
  enum class TriangulationKind
  {
    shared,            ///< every rank has the whole triangulation
    fully_distributed, ///< every rank has its own cells and those around them
    by_ranks           ///< shared on one rank, fully distributed on several
  };

  /// A triangulation that all ranks know; its cells belong to them in their order, as many to each.
  class SharedTriangulation : public dealii::parallel::shared::Triangulation<3>
  {
  public:
    explicit SharedTriangulation(MPI_Comm comm);
  };

  /// Fills an empty triangulation, serial or shared, with a mesh: cells in their order with their corners,
  /// vertices with the numbers of the nodes, the index of its patch as the boundary id of each face.
  /// deal.II accepts cells that are turned inside out and surfaces that are none: check the mesh before.
  /// @param X  positions of the nodes [mm]
  template <int dim>
  void make_triangulation(const SimplexMesh<dim>                    &mesh,
                          const std::vector<dealii::Tensor<1, dim>> &X,
                          dealii::Triangulation<dim>                &triangulation);

  /// Makes a triangulation of a surface: triangles in their order, vertices with their numbers.
  void make_triangulation(const TriangleSurface &surface, dealii::Triangulation<2, 3> &triangulation);

  /// A mesh on all ranks of `comm`, whose cells METIS gives to them. The index of a cell in the mesh is its
  /// coarse cell's. Collective.
  template <int dim>
  std::unique_ptr<dealii::Triangulation<dim>>
  distributed_triangulation(const SimplexMesh<dim> &mesh, TriangulationKind kind, MPI_Comm comm);
} // namespace retroforge
