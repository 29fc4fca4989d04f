// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 The Retroforge authors
#pragma once

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/lac/la_parallel_vector.h>
#include <deal.II/numerics/data_out.h>

#include <retroforge/discretization/spaces.h>
#include <retroforge/element/cell_stress.h>

#include <deque>
#include <map>
#include <string>

namespace retroforge
{
  /// A picture of a triangulation and fields on it, as deal.II's DataOut writes it: one VTK unstructured grid
  /// (.vtu, XML, compressed) with one piece for each rank that has cells.
  ///
  /// The picture is for the eye: places and values are in single precision; all fields are values at points,
  /// and every cell has points of its own, so that fields which are constant in cells jump between them. With
  /// a quadratic field the cells have ten points, VTK's quadratic tetrahedra.
  template <int dim>
  class FieldFile
  {
  public:
    /// @param triangulation  of tetrahedra (dim = 3) or triangles (2) that owns no fields yet; its vertices
    /// are the nodes of linear fields. It must live as long. On a distributed one every function is
    /// collective.
    explicit FieldFile(const dealii::Triangulation<dim, 3> &triangulation);

    /// Fields that are linear in each cell, by their values at the vertices: those of the cells of this rank
    /// and their neighbours are read.
    /// @param name  of letters, digits and underscores     @param unit  empty: none
    void add_linear(const std::string &name, const std::string &unit, const std::vector<double> &values);
    void add_linear(const std::string &name, const std::string &unit, const NodalVectors<double> &values);

    /// A velocity of these spaces, linear or quadratic as they are; bubbles are not shown.
    /// @param values  at the velocity nodes
    void add_velocity(const std::string          &name,
                      const std::string          &unit,
                      const NodalVectors<double> &values,
                      const Spaces               &spaces);

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
    using Values = dealii::LinearAlgebra::distributed::Vector<double>;

    /// DataOut, with names that hold units, which deal.II's own may not, and with tensors of cells.
    class NamedDataOut : public dealii::DataOut<dim, 3>
    {
    public:
      std::map<std::string, std::string> units;
      std::vector<std::string>           cell_tensors;

      /// The cells of this rank in VTK's format; empty where it has none.
      std::string piece(const dealii::DataOutBase::VtkFlags &flags) const;

    private:
      using Base = dealii::DataOut<dim, 3>;

      std::string              with_unit(const std::string &name) const;
      std::vector<std::string> get_dataset_names() const override;
      std::vector<std::tuple<unsigned int,
                             unsigned int,
                             std::string,
                             dealii::DataComponentInterpretation::DataComponentInterpretation>>
      get_nonscalar_data_ranges() const override;
    };

    /// The degrees of freedom of fields of a degree with one component or three.
    const dealii::DoFHandler<dim, 3> &dofs(unsigned int degree, unsigned int n_components);

    /// @param value_at  of a cell, one of its support points and a component
    template <typename ValueAt>
    void add_field(const std::string &name,
                   const std::string &unit,
                   unsigned int       degree,
                   unsigned int       n_components,
                   const ValueAt     &value_at);

    void add_cell_field(const std::string &name, dealii::Vector<double> values);

    const dealii::Triangulation<dim, 3>                              &triangulation_;
    std::map<std::array<unsigned int, 2>, dealii::DoFHandler<dim, 3>> dofs_; ///< by degree and components
    std::deque<Values>                                                values_;
    std::deque<dealii::Vector<double>>                                cell_values_;
    std::string                                                       planes_;
    unsigned int                                                      degree_ = 1;
    NamedDataOut                                                      data_out_;
  };
} // namespace retroforge
