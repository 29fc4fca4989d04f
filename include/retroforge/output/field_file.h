// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <retroforge/core/types.h>
#include <retroforge/discretization/middle_nodes.h>
#include <retroforge/element/cell_stress.h>
#include <retroforge/mesh/tet_mesh.h>

#include <array>
#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

namespace retroforge
{
  /// A picture of tetrahedra (dim = 3) or triangles (2) and fields on them: one VTK unstructured grid (.vtu,
  /// XML). Cells share their points, which are the nodes in their order, so that nodal fields have one value
  /// at each; fields of cells are data of cells. (deal.II's DataOut gives every cell points of its own, of
  /// which there are twenty times as many, with the fields of cells on them, too.)
  ///
  /// The picture is for the eye: places and values are in single precision. Nothing is compressed: of such
  /// numbers zlib takes 40 % off, in most of the time of writing. With a quadratic velocity
  /// the cells are VTK's quadratic tetrahedra, and the middles of the edges are points behind the nodes.
  template <int dim>
  class FieldFile
  {
  public:
    /// @param X      positions of the nodes [mm]
    /// @param cells  by their nodes
    FieldFile(const NodalVectors<double> &X, const std::vector<std::array<NodeIndex, dim + 1>> &cells);

    /// Fields that are linear in each cell, by their values at the nodes.
    /// @param name  of letters, digits and underscores     @param unit  empty: none
    void add_linear(const std::string &name, const std::string &unit, const std::vector<double> &values);
    void add_linear(const std::string &name, const std::string &unit, const NodalVectors<double> &values);

    /// A velocity that is linear, or quadratic with nodes in the middles of edges; bubbles are not shown.
    /// @param values   at the velocity nodes
    /// @param middles  null where it is linear
    void add_velocity(const std::string          &name,
                      const std::string          &unit,
                      const NodalVectors<double> &values,
                      const MiddleNodes          *middles);

    /// Fields that are constant in each cell. Tensors get nine components, row by row.
    void add_constant(const std::string &name, const std::string &unit, const std::vector<double> &values);
    void add_constant(const std::string                  &name,
                      const std::string                  &unit,
                      const std::vector<SymmetricTensor> &values);

    /// Planes of symmetry, as field data in double precision: `symmetry_planes`, six numbers each, point and
    /// outward normal. Nothing where there is none.
    void add_symmetry_planes(const std::vector<Plane> &planes);

    /// @throws Error  when the file cannot be written
    void write(const std::string &file) const;

  private:
    /// Values by point or cell, and component.
    struct Array
    {
      std::string        name;
      unsigned int       n_components;
      std::vector<float> values;
    };

    /// @param data      that the array becomes the last of
    /// @param value_at  of a point or cell, of n, and a component
    template <typename ValueAt>
    void add(std::vector<Array> &data,
             const std::string  &name,
             const std::string  &unit,
             std::size_t         n,
             unsigned int        n_components,
             const ValueAt      &value_at);

    /// The middles of the edges become points.
    void make_quadratic(const MiddleNodes &middles);

    /// Nodal values have their means in the middles of the edges where these are points.
    void write_at_points(std::ostream &out, const Array &array) const;
    void write_cells(std::ostream &out) const;

    std::size_t                           n_nodes_, n_cells_;
    unsigned int                          n_points_per_cell_;
    std::vector<std::int32_t>             connectivity_;
    std::vector<std::array<NodeIndex, 2>> edges_; ///< edges whose middles are points
    Array                                 X_;
    std::vector<Array>                    point_data_, cell_data_;
    std::string                           planes_;
  };
} // namespace retroforge
