// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/types.h>
#include <retroforge/element/cell_stress.h>
#include <retroforge/geometry/triangle_surface.h>
#include <retroforge/mesh/tet_mesh.h>

#include <string>
#include <vector>

namespace retroforge
{
  /// One number per node or per cell.
  struct ScalarField
  {
    std::string         name;
    std::vector<double> values;
  };

  /// One vector per node.
  struct VectorField
  {
    std::string          name;
    NodalVectors<double> values;
  };

  /// One symmetric tensor per cell.
  struct TensorField
  {
    std::string                  name;
    std::vector<SymmetricTensor> values;
  };

  /// Write the mesh in the configuration X with its fields as one VTK unstructured grid (.vtu, XML,
  /// compressed).
  ///
  /// Its symmetry planes come along as field data: `symmetry_planes`, six numbers each, point and outward
  /// normal. Tensors get VTK's order of components, xx, yy, zz, xy, yz, xz. Nodes are shared by their cells,
  /// cell fields are constant on each cell. Positions keep double precision; fields are for the eye and kept
  /// in single precision, numbers beyond its range become infinite.
  ///
  /// The state is the same on every rank: call it on one of them.
  /// @throws Error when the file cannot be written
  void write_vtu(const std::string              &file,
                 const TetMesh                  &mesh,
                 const NodalVectors<double>     &X,
                 const std::vector<ScalarField> &nodal_scalars,
                 const std::vector<VectorField> &nodal_vectors,
                 const std::vector<ScalarField> &cell_scalars,
                 const std::vector<TensorField> &cell_tensors = {});

  /// The same of a surface, with fields on its vertices.
  void write_vtu(const std::string              &file,
                 const TriangleSurface          &surface,
                 const std::vector<VectorField> &vertex_vectors = {});
} // namespace retroforge
