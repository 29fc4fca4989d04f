// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/base/data_out_base.h>
#include <deal.II/grid/tria.h>

#include <retroforge/core/types.h>
#include <retroforge/discretization/middle_nodes.h>
#include <retroforge/element/cell_stress.h>

#include <array>
#include <string>
#include <vector>

namespace retroforge
{
  /// A picture of tetrahedra (dim = 3) or triangles (2) and fields on them, as deal.II's DataOutBase writes
  /// it: one VTK unstructured grid (.vtu, XML, compressed) with one piece for each rank that has cells. Its
  /// patches are filled here: to make degrees of freedom for each picture takes five times as long as all
  /// else.
  ///
  /// The picture is for the eye: places and values are in single precision; all fields are values at points,
  /// and every cell has points of its own, so that fields which are constant in cells jump between them. With
  /// a quadratic field the cells have ten points, VTK's quadratic tetrahedra.
  template <int dim>
  class FieldFile
  {
  public:
    /// @param X      positions of the nodes [mm]
    /// @param cells  by their nodes, which all ranks know; those that a rank writes are an equal share
    /// @param comm   of the ranks that call every function, with all nodes' values
    FieldFile(const NodalVectors<double>                        &X,
              const std::vector<std::array<NodeIndex, dim + 1>> &cells,
              MPI_Comm                                           comm = MPI_COMM_SELF);

    /// The same of a triangulation, shared or serial.
    explicit FieldFile(const dealii::Triangulation<dim, 3> &triangulation);

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

    /// Each rank makes the piece of its cells, the first writes them all in one step.
    /// @throws Error  when the file cannot be written, on the first rank
    void write(const std::string &file);

  private:
    using Cells = std::vector<std::array<NodeIndex, dim + 1>>;

    /// What is written as one array. Values by cell of this rank, point and component; the points of a cell
    /// are one, its corners, or these and the middles of its edges.
    struct Array
    {
      std::string                                                      name;
      dealii::DataComponentInterpretation::DataComponentInterpretation kind;
      unsigned int                                                     n_points, n_components;
      std::vector<double>                                              values;
    };

    /// @param value_at  of a cell, one of its points and a component
    template <typename ValueAt>
    void add(const std::string &name,
             const std::string &unit,
             unsigned int       n_points,
             unsigned int       n_components,
             const ValueAt     &value_at);

    /// At a point of the picture, which may have more points than the array.
    double value(const Array &array, CellIndex c, unsigned int point, unsigned int component) const;

    dealii::DataOutBase::Patch<dim, 3> patch(CellIndex c) const;
    /// The cells of this rank in VTK's format; empty where it has none.
    std::string piece() const;

    NodalVectors<double> X_;
    Cells                cells_;
    MPI_Comm             comm_;
    CellIndex            first_ = 0, last_ = 0; ///< cells of this rank, without the last
    std::string          planes_;
    unsigned int         n_points_ = dim + 1; ///< of a cell
    std::vector<Array>   arrays_;
  };
} // namespace retroforge
